/* Relocatable ELF objects. libelf reads them; everything in them that is used as an index or a length is checked here.
 */
#include "ld.h"

#include <gelf.h>
#include <string.h>

#ifndef SHT_LLVM_ADDRSIG
#define SHT_LLVM_ADDRSIG 0x6fff4c03
#endif

/* --- header and symbol table --- */

static bool check_header(ld_context *ctx, const char *name, const uint8_t *bytes, size_t size) {
  const char *problem = NULL;
  if (size < sizeof(Elf32_Ehdr))
    problem = "is truncated: shorter than an ELF header";
  else if (bytes[EI_CLASS] != ELFCLASS32)
    problem =
        bytes[EI_CLASS] == ELFCLASS64 ? "is a 64-bit object, the machine has 32 bits" : "has an invalid ELF class";
  else if (bytes[EI_DATA] != ELFDATA2LSB)
    problem =
        bytes[EI_DATA] == ELFDATA2MSB ? "is big endian, the machine is little endian" : "has an invalid byte order";
  else if (bytes[EI_VERSION] != EV_CURRENT)
    problem = "has an unknown ELF version";
  if (problem) {
    ld_error(ctx, "%s: %s", name, problem);
    return false;
  }
  const Elf32_Ehdr *header = (const Elf32_Ehdr *)bytes;
  if (header->e_machine != TRAX_EM) {
    ld_error(ctx, "%s: is for another machine (e_machine 0x%x, not 0x%x)", name, header->e_machine, TRAX_EM);
  } else if (header->e_type != ET_REL) {
    ld_error(ctx, "%s: is %s, not a relocatable object", name,
             header->e_type == ET_EXEC  ? "an executable"
             : header->e_type == ET_DYN ? "a shared object"
                                        : "an ELF file of another type");
  } else if (header->e_flags > TRAX_EF_STACK_GLOBAL) {
    ld_error(ctx, "%s: has unknown e_flags 0x%x", name, header->e_flags);
  } else if (header->e_shoff != 0 && header->e_shentsize != sizeof(Elf32_Shdr)) {
    ld_error(ctx, "%s: section headers of %u bytes, expected %zu", name, header->e_shentsize, sizeof(Elf32_Shdr));
  } else if (header->e_shoff > size ||
             (uint64_t)header->e_shnum * sizeof(Elf32_Shdr) > (uint64_t)size - header->e_shoff) {
    ld_error(ctx, "%s: is truncated: section headers lie outside the file", name);
  } else {
    return true;
  }
  return false;
}

/* The section's contents, converted and aligned for their type; NULL if it has none. */
static bool section_contents(ld_context *ctx, const ld_object *object, size_t index, const void **contents,
                             size_t *size) {
  Elf_Scn *scn = elf_getscn(object->elf, index);
  Elf_Data *data = scn ? elf_getdata(scn, NULL) : NULL;
  if (!data) {
    ld_error(ctx, "%s: section %zu: %s", object->name, index, elf_errmsg(-1));
    return false;
  }
  *contents = data->d_buf;
  *size = data->d_buf ? data->d_size : 0;
  return true;
}

static bool section_header(ld_context *ctx, const ld_object *object, size_t index, GElf_Shdr *header) {
  Elf_Scn *scn = elf_getscn(object->elf, index);
  if (scn && gelf_getshdr(scn, header))
    return true;
  ld_error(ctx, "%s: section %zu: %s", object->name, index, elf_errmsg(-1));
  return false;
}

static bool read_symbol_table(ld_context *ctx, ld_object *object, size_t index, const GElf_Shdr *header) {
  GElf_Shdr strings;
  size_t size;
  if (object->raw_symbols) {
    ld_error(ctx, "%s: more than one symbol table", object->name);
    return false;
  }
  if (header->sh_entsize != sizeof(Elf32_Sym) || header->sh_size % sizeof(Elf32_Sym) != 0) {
    ld_error(ctx, "%s: symbol table entries of %llu bytes, expected %zu", object->name,
             (unsigned long long)header->sh_entsize, sizeof(Elf32_Sym));
    return false;
  }
  if (header->sh_link == 0 || header->sh_link >= object->section_count ||
      !section_header(ctx, object, header->sh_link, &strings) || strings.sh_type != SHT_STRTAB) {
    ld_error(ctx, "%s: the symbol table has no string table (section %u)", object->name, header->sh_link);
    return false;
  }
  const void *symbol_bytes, *string_bytes;
  if (!section_contents(ctx, object, index, &symbol_bytes, &size) ||
      !section_contents(ctx, object, header->sh_link, &string_bytes, &object->strings_size))
    return false;
  object->raw_symbols = symbol_bytes;
  object->symbol_count = size / sizeof(Elf32_Sym);
  object->first_global = object->symbol_count ? header->sh_info : 0;
  object->strings = string_bytes;
  if (object->symbol_count > 0 && (object->first_global == 0 || object->first_global > object->symbol_count)) {
    ld_error(ctx, "%s: first global symbol %zu of %zu", object->name, object->first_global, object->symbol_count);
    return false;
  }
  if (object->symbol_count > 0 && (object->strings_size == 0 || object->strings[object->strings_size - 1] != '\0')) {
    ld_error(ctx, "%s: the symbols' string table does not end with NUL", object->name);
    return false;
  }
  return true;
}

/* Reads the section headers once for what concerns the whole object. */
static bool scan_sections(ld_context *ctx, ld_object *object, size_t file_size) {
  size_t symbol_table = 0, extended = 0, extended_link = 0;
  for (size_t i = 1; i < object->section_count; i++) {
    GElf_Shdr header;
    if (!section_header(ctx, object, i, &header))
      return false;
    if (header.sh_type != SHT_NOBITS && header.sh_type != SHT_NULL &&
        (header.sh_offset > file_size || header.sh_size > file_size - header.sh_offset)) {
      ld_error(ctx, "%s: is truncated: section %zu lies outside the file", object->name, i);
      return false;
    }
    if (header.sh_type == SHT_SYMTAB) {
      if (!read_symbol_table(ctx, object, i, &header))
        return false;
      symbol_table = i;
    } else if (header.sh_type == SHT_SYMTAB_SHNDX) {
      extended = i;
      extended_link = header.sh_link;
    }
  }
  if (extended && extended_link == symbol_table) {
    const void *indices;
    size_t size;
    if (!section_contents(ctx, object, extended, &indices, &size))
      return false;
    object->raw_shndx = indices;
    if (size / sizeof(Elf32_Word) < object->symbol_count) {
      ld_error(ctx, "%s: the table of extended section indices is shorter than the symbol table", object->name);
      return false;
    }
  }
  return true;
}

ld_object *ld_object_open(ld_context *ctx, const char *name, const uint8_t *bytes, size_t size) {
  if (!check_header(ctx, name, bytes, size))
    return NULL;
  ld_object *object = ld_alloc(ctx, sizeof *object);
  object->name = name;
  object->stack = ((const Elf32_Ehdr *)bytes)->e_flags;
  object->elf = elf_memory((char *)bytes, size);
  if (!object->elf || elf_getshdrnum(object->elf, &object->section_count) != 0) {
    ld_error(ctx, "%s: %s", name, elf_errmsg(-1));
    elf_end(object->elf);
    return NULL;
  }
  ld_push(ctx, &ctx->elves, object->elf);
  return scan_sections(ctx, object, size) ? object : NULL;
}

const char *ld_object_symbol_name(ld_context *ctx, const ld_object *object, size_t index) {
  uint32_t offset = object->raw_symbols[index].st_name;
  if (offset < object->strings_size)
    return object->strings + offset;
  ld_error(ctx, "%s: the name of symbol %zu lies outside the string table", object->name, index);
  return NULL;
}

uint32_t ld_object_symbol_section(const ld_object *object, size_t index, bool *reserved) {
  uint32_t section = object->raw_symbols[index].st_shndx;
  *reserved = section >= SHN_LORESERVE;
  if (section == SHN_XINDEX && object->raw_shndx) {
    *reserved = false;
    section = object->raw_shndx[index];
  }
  return section;
}

/* --- sections --- */

/* Sections for the linker, and sections without a use in an executable for this machine. */
static bool is_dropped(const ld_context *ctx, const char *name, uint32_t type, uint32_t flags) {
  switch (type) {
  case SHT_NULL:
  case SHT_SYMTAB:
  case SHT_STRTAB:
  case SHT_RELA:
  case SHT_REL:
  case SHT_GROUP:
  case SHT_SYMTAB_SHNDX:
  case SHT_LLVM_ADDRSIG:
    return true;
  }
  if (flags & SHF_EXCLUDE)
    return true;
  if (strcmp(name, ".note.GNU-stack") == 0 || strcmp(name, ".eh_frame") == 0)
    return true;
  return ctx->options.strip_debug && !(flags & SHF_ALLOC) && ld_starts_with(name, ".debug");
}

static bool decompress(ld_context *ctx, const ld_object *object, size_t index, const char *name, GElf_Shdr *header) {
  Elf_Scn *scn = elf_getscn(object->elf, index);
  if (elf_compress(scn, 0, 0) < 0) {
    ld_error(ctx, "%s:(%s): cannot decompress: %s", object->name, name, elf_errmsg(-1));
    return false;
  }
  return section_header(ctx, object, index, header);
}

static ld_section *read_section(ld_context *ctx, ld_object *object, size_t index, size_t name_table) {
  GElf_Shdr header;
  if (!section_header(ctx, object, index, &header))
    return NULL;
  const char *name = elf_strptr(object->elf, name_table, header.sh_name);
  if (!name) {
    ld_error(ctx, "%s: section %zu: bad name", object->name, index);
    return NULL;
  }
  ld_section *section = ld_alloc(ctx, sizeof *section);
  section->object = object;
  section->name = name;
  section->type = header.sh_type;
  section->flags = (uint32_t)header.sh_flags;
  section->discarded = is_dropped(ctx, name, section->type, section->flags);
  if (section->discarded)
    return section;

  if (section->flags & SHF_COMPRESSED) {
    if (!decompress(ctx, object, index, name, &header))
      return NULL;
    section->flags &= ~(uint32_t)SHF_COMPRESSED;
  }
  section->size = (uint32_t)header.sh_size;
  section->entry_size = (uint32_t)header.sh_entsize;
  section->alignment = header.sh_addralign ? (uint32_t)header.sh_addralign : 1;
  if (section->alignment & (section->alignment - 1)) {
    ld_error(ctx, "%s:(%s): alignment %u is not a power of two", object->name, name, section->alignment);
    return NULL;
  }
  if (section->alignment > LD_MAX_ALIGNMENT) {
    ld_error(ctx, "%s:(%s): alignment %u is more than the linker's limit, %u", object->name, name, section->alignment,
             LD_MAX_ALIGNMENT);
    return NULL;
  }
  if ((section->flags & (SHF_ALLOC | SHF_EXECINSTR | SHF_WRITE)) == (SHF_ALLOC | SHF_EXECINSTR | SHF_WRITE)) {
    ld_error(ctx, "%s:(%s): is both writable and executable", object->name, name);
    return NULL;
  }
  if ((section->flags & SHF_EXECINSTR) && section->alignment < 4)
    section->alignment = 4; /* assembly may omit it, but instructions need it */
  if (section->type != SHT_NOBITS) {
    const void *contents;
    size_t size;
    if (!section_contents(ctx, object, index, &contents, &size))
      return NULL;
    if (size != section->size) {
      ld_error(ctx, "%s:(%s): %zu bytes of contents, expected %u", object->name, name, size, section->size);
      return NULL;
    }
    section->data = contents ? contents : ""; /* empty, but not SHT_NOBITS */
  }
  ld_push(ctx, &ctx->sections, section);
  return section;
}

static bool read_sections(ld_context *ctx, ld_object *object) {
  size_t name_table;
  GElf_Shdr names;
  if (elf_getshdrstrndx(object->elf, &name_table) != 0 || name_table >= object->section_count ||
      !section_header(ctx, object, name_table, &names) || names.sh_type != SHT_STRTAB) {
    ld_error(ctx, "%s: has no table of section names", object->name);
    return false;
  }
  object->sections = ld_alloc_array(ctx, object->section_count + 1, sizeof(ld_section *));
  bool ok = true;
  for (size_t i = 1; i < object->section_count; i++) {
    object->sections[i] = read_section(ctx, object, i, name_table);
    ok = ok && object->sections[i];
  }
  return ok;
}

/* --- groups and linked sections --- */

static const char *group_signature(ld_context *ctx, const ld_object *object, size_t symbol) {
  if (symbol == 0 || symbol >= object->symbol_count) {
    ld_error(ctx, "%s: a section group has the signature symbol %zu of %zu", object->name, symbol,
             object->symbol_count);
    return NULL;
  }
  bool reserved;
  uint32_t section = ld_object_symbol_section(object, symbol, &reserved);
  if (ELF32_ST_TYPE(object->raw_symbols[symbol].st_info) == STT_SECTION && !reserved && section > 0 &&
      section < object->section_count)
    return object->sections[section]->name;
  return ld_object_symbol_name(ctx, object, symbol);
}

static void read_group(ld_context *ctx, ld_object *object, size_t index, const GElf_Shdr *header) {
  const void *contents;
  size_t size;
  const char *signature = group_signature(ctx, object, header->sh_info);
  if (!signature || !section_contents(ctx, object, index, &contents, &size))
    return;
  const Elf32_Word *words = contents;
  size_t count = size / sizeof *words;
  if (count == 0) {
    ld_error(ctx, "%s: the section group '%s' is empty", object->name, signature);
    return;
  }
  bool keep = true;
  if (words[0] & GRP_COMDAT) {
    uintptr_t *owner = ld_map_at(ctx, &ctx->groups, signature, strlen(signature));
    keep = *owner == 0;
    if (keep)
      *owner = (uintptr_t)object;
  }
  ld_section *first = NULL, *last = NULL;
  for (size_t i = 1; i < count; i++) {
    if (words[i] == 0 || words[i] >= object->section_count) {
      ld_error(ctx, "%s: the section group '%s' has a member %u of %zu sections", object->name, signature, words[i],
               object->section_count);
      return;
    }
    ld_section *member = object->sections[words[i]];
    if (!keep)
      member->discarded = true;
    if (member->discarded || member->group_next)
      continue;
    if (last)
      last->group_next = member;
    else
      first = member;
    last = member;
    last->group_next = first;
  }
}

static void read_groups_and_links(ld_context *ctx, ld_object *object) {
  for (size_t i = 1; i < object->section_count; i++) {
    GElf_Shdr header;
    if (object->sections[i]->type == SHT_GROUP && section_header(ctx, object, i, &header))
      read_group(ctx, object, i, &header);
  }
  for (size_t i = 1; i < object->section_count; i++) {
    ld_section *section = object->sections[i];
    GElf_Shdr header;
    if (section->discarded || !(section->flags & SHF_LINK_ORDER) || !section_header(ctx, object, i, &header))
      continue;
    if (header.sh_link >= object->section_count) {
      ld_error(ctx, "%s:(%s): linked to section %u of %zu", object->name, section->name, header.sh_link,
               object->section_count);
    } else if (header.sh_link != 0) { /* 0: to nothing, kept like others */
      ld_section *parent = object->sections[header.sh_link];
      section->next_dependent = parent->first_dependent;
      parent->first_dependent = section;
      section->discarded = parent->discarded;
    }
  }
}

/* --- relocations --- */

static void read_relocations(ld_context *ctx, ld_object *object, size_t index) {
  GElf_Shdr header;
  if (!section_header(ctx, object, index, &header))
    return;
  if (header.sh_info == 0 || header.sh_info >= object->section_count) {
    ld_error(ctx, "%s: section %zu has relocations for section %u of %zu", object->name, index, header.sh_info,
             object->section_count);
    return;
  }
  ld_section *target = object->sections[header.sh_info];
  if (target->discarded) /* before the error below: call-graph profiles have SHT_REL on every machine */
    return;
  if (header.sh_type == SHT_REL) {
    ld_error(ctx, "%s: section %zu: relocations without addends (SHT_REL) are not supported", object->name, index);
    return;
  }
  if (header.sh_entsize != sizeof(Elf32_Rela) || header.sh_size % sizeof(Elf32_Rela) != 0) {
    ld_error(ctx, "%s:(%s): relocations of %llu bytes, expected %zu", object->name, target->name,
             (unsigned long long)header.sh_entsize, sizeof(Elf32_Rela));
    return;
  }
  const void *contents;
  size_t size;
  if (!section_contents(ctx, object, index, &contents, &size))
    return;
  const Elf32_Rela *raw = contents;
  size_t count = size / sizeof *raw;
  if (count == 0)
    return;
  if (target->relocs || !target->data) {
    ld_error(ctx, "%s:(%s): %s", object->name, target->name,
             target->data ? "has more than one table of relocations" : "has relocations but no contents");
    return;
  }
  target->relocs = ld_alloc_array(ctx, count, sizeof(ld_reloc));
  for (size_t i = 0; i < count; i++) {
    size_t symbol = ELF32_R_SYM(raw[i].r_info);
    if (symbol >= object->symbol_count && symbol != 0) {
      ld_error(ctx, "%s:(%s+0x%x): relocation refers to symbol %zu of %zu", object->name, target->name, raw[i].r_offset,
               symbol, object->symbol_count);
      return;
    }
    target->relocs[target->reloc_count++] = (ld_reloc){.offset = raw[i].r_offset,
                                                       .type = ELF32_R_TYPE(raw[i].r_info),
                                                       .symbol = object->symbols[symbol],
                                                       .addend = raw[i].r_addend};
  }
}

void ld_object_load(ld_context *ctx, ld_object *object) {
  unsigned errors = ctx->error_count;
  if (object->section_count == 0 || !read_sections(ctx, object))
    return;
  read_groups_and_links(ctx, object);
  if (ctx->error_count != errors)
    return;
  if (!ld_symbols_add(ctx, object))
    return;
  for (size_t i = 1; i < object->section_count; i++)
    if (object->sections[i]->type == SHT_RELA || object->sections[i]->type == SHT_REL)
      read_relocations(ctx, object, i);
}
