/* -r: one relocatable object of several. Sections of the same name, kind and flags are joined, those of groups and
   those linked to different sections stay apart; nothing is dropped but the copies of COMDAT groups. Symbols keep their
   names, relocations follow what they refer to. */
#include "ld.h"

#include <string.h>

/* --- output sections --- */

static ld_output *add_output(ld_context *ctx, const ld_section *section) {
  ld_output *output = ld_alloc(ctx, sizeof *output);
  *output = (ld_output){.name = section->name,
                        .type = section->type,
                        .flags = section->flags & ~(uint32_t)SHF_INFO_LINK,
                        .entry_size = section->entry_size,
                        .alignment = 1};
  ld_push(ctx, &ctx->outputs, output);
  return output;
}

/* The properties that sections must share to be joined. */
typedef struct join_key {
  const ld_output *linked_to;
  uint32_t type, flags, entry_size;
  char name[];
} join_key;

static ld_output *find_output(ld_context *ctx, ld_map *joined, const ld_section *section) {
  bool is_linked = section->flags & SHF_LINK_ORDER && section->linked_to;
  if (section->group_next || (is_linked && !section->linked_to->output))
    return add_output(ctx, section);
  size_t length = sizeof(join_key) + strlen(section->name);
  join_key *key = ld_alloc(ctx, length + 1);
  key->linked_to = is_linked ? section->linked_to->output : NULL;
  key->type = section->type;
  key->flags = section->flags;
  key->entry_size = section->entry_size;
  strcpy(key->name, section->name);
  uintptr_t *slot = ld_map_at(ctx, joined, key, length);
  if (!*slot)
    *slot = (uintptr_t)add_output(ctx, section);
  return (ld_output *)*slot;
}

static void join(ld_context *ctx, ld_map *joined, ld_section *section) {
  ld_output *output = find_output(ctx, joined, section);
  uint64_t offset = ld_align(output->size, section->alignment);
  if (offset + section->size > INT32_MAX) {
    ld_error(ctx, "section %s is larger than 2 GB", output->name);
    return;
  }
  section->output = output;
  section->output_offset = (uint32_t)offset;
  output->size = (uint32_t)(offset + section->size);
  if (section->alignment > output->alignment)
    output->alignment = section->alignment;
  output->reloc_count += section->reloc_count;
  ld_push(ctx, &output->sections, section);
}

static void join_sections(ld_context *ctx) {
  ld_map joined = {0};
  for (int linked = 0; linked < 2; linked++) /* what others are linked to comes first */
    for (size_t i = 0; i < ctx->sections.count; i++) {
      ld_section *section = ctx->sections.items[i];
      if (section->live && !(section->flags & SHF_LINK_ORDER) == !linked)
        join(ctx, &joined, section);
    }
  for (size_t i = 0; i < ctx->outputs.count; i++)
    ctx->outputs.items[i]->header_index = (uint32_t)(1 + ctx->kept_groups.count + i);
}

/* --- symbols --- */

static Elf32_Sym symbol_entry(ld_context *ctx, const ld_symbol *symbol, uint32_t name) {
  Elf32_Sym entry = {.st_name = name,
                     .st_size = symbol->size,
                     .st_info = ELF32_ST_INFO(symbol->binding, symbol->type),
                     .st_other = symbol->visibility};
  uint32_t offset = 0;
  const ld_symbol *base = symbol;
  while (base->kind == LD_DEFSYM) { /* no circle, and with an end: checked */
    const ld_defsym *defsym = &ctx->options.defsyms.items[base->value];
    offset += defsym->offset;
    base = defsym->base ? ld_symbol_find(ctx, defsym->base) : NULL;
    if (!base)
      break;
  }
  if (base && base->kind == LD_DEFINED) {
    entry.st_shndx = (Elf32_Half)base->section->output->header_index;
    entry.st_value = base->section->output_offset + base->value + offset;
  } else if (base && base->kind == LD_COMMON) {
    entry.st_shndx = SHN_COMMON;
    entry.st_value = base->value;
  } else if (!base || base->kind == LD_ABSOLUTE) {
    entry.st_shndx = SHN_ABS;
    entry.st_value = (base ? base->value : 0) + offset;
  }
  return entry;
}

static void add_symbol(ld_context *ctx, ld_symbol_table *table, ld_symbol *symbol) {
  symbol->output_index = (uint32_t)table->entries.count;
  Elf32_Sym entry = symbol_entry(ctx, symbol, ld_add_string(ctx, &table->names, symbol->name));
  ld_push(ctx, &table->entries, entry);
}

/* The null symbol, local ones, those of sections, then the global ones that were mentioned. */
static void collect_symbols(ld_context *ctx, ld_symbol_table *table) {
  Elf32_Sym null = {0};
  ld_add_string(ctx, &table->names, "");
  ld_push(ctx, &table->entries, null);
  for (size_t o = 0; o < ctx->objects.count; o++) {
    const ld_object *object = ctx->objects.items[o];
    for (size_t i = 1; i < object->symbol_count && i < object->first_global; i++)
      if (object->symbols[i]->type != STT_SECTION && !ld_symbol_is_dropped(object->symbols[i], 0) &&
          !(ctx->options.strip_debug && object->symbols[i]->type == STT_FILE))
        add_symbol(ctx, table, object->symbols[i]);
  }
  for (size_t i = 0; i < ctx->outputs.count; i++) {
    ld_output *output = ctx->outputs.items[i];
    Elf32_Sym entry = {.st_info = ELF32_ST_INFO(STB_LOCAL, STT_SECTION), .st_shndx = (Elf32_Half)output->header_index};
    output->symbol_index = (uint32_t)table->entries.count;
    ld_push(ctx, &table->entries, entry);
  }
  table->local_count = table->entries.count;
  for (size_t i = 0; i < ctx->symbols.count; i++) {
    ld_symbol *symbol = ctx->symbols.items[i];
    if (symbol->kind != LD_UNDEFINED || symbol->referenced)
      add_symbol(ctx, table, symbol);
  }
}

/* --- relocations --- */

static bool convert_reloc(ld_context *ctx, const ld_section *section, const ld_reloc *reloc, Elf32_Rela *raw) {
  const ld_symbol *symbol = reloc->symbol;
  uint32_t index = symbol->output_index, addend = (uint32_t)reloc->addend;
  if (reloc->offset > section->size) {
    ld_error(ctx, "%s: relocation lies outside the section, which has 0x%x bytes",
             ld_place(ctx, section, reloc->offset), section->size);
    return false;
  }
  if (ld_symbol_is_dropped(symbol, reloc->addend)) {
    if (section->flags & SHF_ALLOC) {
      ld_error(ctx, "%s: relocation refers to '%s' in %s, which is not linked", ld_place(ctx, section, reloc->offset),
               symbol->type == STT_SECTION ? symbol->section->name : symbol->name,
               ld_place(ctx, symbol->section, symbol->value));
      return false;
    }
    addend = ld_tombstone(section);
  } else if (symbol->type == STT_SECTION && symbol->kind == LD_DEFINED) {
    index = symbol->section->output->symbol_index;
    addend += symbol->section->output_offset + symbol->value;
  }
  raw->r_offset = section->output_offset + reloc->offset;
  raw->r_info = ELF32_R_INFO(index, reloc->type);
  raw->r_addend = (Elf32_Sword)addend;
  return true;
}

static Elf32_Rela *convert_relocs(ld_context *ctx, const ld_output *output) {
  Elf32_Rela *relocs = ld_alloc_array(ctx, output->reloc_count, sizeof *relocs), *next = relocs;
  for (size_t s = 0; s < output->sections.count; s++) {
    const ld_section *section = output->sections.items[s];
    for (uint32_t r = 0; r < section->reloc_count; r++)
      if (convert_reloc(ctx, section, &section->relocs[r], next))
        next++;
  }
  return relocs;
}

/* --- the file --- */

typedef struct part { /* of the file, one for each section header */
  Elf32_Shdr header;
  void *bytes; /* NULL: an output section's, which are gathered */
  Elf_Type type;
} part;

typedef struct writer {
  ld_context *ctx;
  LD_VECTOR(part) parts;
  ld_string_table names;
  size_t size;
} writer;

static uint32_t add_part(writer *writer, const char *name, Elf32_Shdr header, void *bytes, Elf_Type type) {
  header.sh_name = ld_add_string(writer->ctx, &writer->names, name);
  if (header.sh_type != SHT_NULL) {
    writer->size = (size_t)ld_align(writer->size, header.sh_addralign ? header.sh_addralign : 1);
    header.sh_offset = (Elf32_Off)writer->size;
    writer->size += header.sh_type == SHT_NOBITS ? 0 : header.sh_size;
  }
  part fresh = {header, bytes, type};
  ld_push(writer->ctx, &writer->parts, fresh);
  return (uint32_t)writer->parts.count - 1;
}

static void add_outputs(writer *writer) {
  ld_context *ctx = writer->ctx;
  for (size_t i = 0; i < ctx->outputs.count; i++) {
    const ld_output *output = ctx->outputs.items[i];
    const ld_section *first = output->sections.items[0];
    Elf32_Shdr header = {.sh_type = output->type,
                         .sh_flags = output->flags,
                         .sh_size = output->size,
                         .sh_addralign = output->alignment,
                         .sh_entsize = output->entry_size};
    if (output->flags & SHF_LINK_ORDER && first->linked_to && first->linked_to->output)
      header.sh_link = first->linked_to->output->header_index;
    add_part(writer, output->name, header, NULL, ELF_T_BYTE);
  }
}

static void add_relocs(writer *writer, uint32_t symbol_table) {
  ld_context *ctx = writer->ctx;
  for (size_t i = 0; i < ctx->outputs.count; i++) {
    ld_output *output = ctx->outputs.items[i];
    if (output->reloc_count == 0)
      continue;
    Elf32_Shdr header = {.sh_type = SHT_RELA,
                         .sh_flags = SHF_INFO_LINK | (output->flags & SHF_GROUP),
                         .sh_size = output->reloc_count * (Elf32_Word)sizeof(Elf32_Rela),
                         .sh_link = symbol_table,
                         .sh_info = output->header_index,
                         .sh_addralign = sizeof(Elf32_Word),
                         .sh_entsize = sizeof(Elf32_Rela)};
    output->reloc_index =
        add_part(writer, ld_format(ctx, ".rela%s", output->name), header, convert_relocs(ctx, output), ELF_T_RELA);
  }
}

/* Groups stand before their members. What is in them is known when the relocations have their places. */
static void add_groups(writer *writer, uint32_t symbol_table) {
  ld_context *ctx = writer->ctx;
  for (size_t i = 0; i < ctx->kept_groups.count; i++) {
    const ld_group *group = &ctx->kept_groups.items[i];
    size_t count = 1;
    for (size_t m = 0; m < group->members.count; m++)
      if (group->members.items[m]->output)
        count += group->members.items[m]->reloc_count ? 2 : 1;
    const ld_symbol *signature = group->object->symbols[group->signature];
    bool is_section = signature->type == STT_SECTION && signature->kind == LD_DEFINED && signature->section->live;
    Elf32_Shdr header = {.sh_type = SHT_GROUP,
                         .sh_size = (Elf32_Word)(count * sizeof(Elf32_Word)),
                         .sh_link = symbol_table,
                         .sh_info = is_section ? signature->section->output->symbol_index : signature->output_index,
                         .sh_addralign = sizeof(Elf32_Word),
                         .sh_entsize = sizeof(Elf32_Word)};
    add_part(writer, ".group", header, ld_alloc_array(ctx, count, sizeof(Elf32_Word)), ELF_T_WORD);
  }
}

static void fill_groups(writer *writer) {
  ld_context *ctx = writer->ctx;
  for (size_t i = 0; i < ctx->kept_groups.count; i++) {
    const ld_group *group = &ctx->kept_groups.items[i];
    Elf32_Word *words = writer->parts.items[1 + i].bytes, count = 0;
    words[count++] = group->flags;
    for (size_t m = 0; m < group->members.count; m++) {
      const ld_output *output = group->members.items[m]->output;
      if (!output) /* gone with what it was linked to */
        continue;
      words[count++] = output->header_index;
      if (output->reloc_count)
        words[count++] = output->reloc_index;
    }
  }
}

static void put_parts(writer *writer) {
  ld_context *ctx = writer->ctx;
  size_t headers = (size_t)ld_align(writer->size, sizeof(Elf32_Word));
  ctx->image_size = headers + writer->parts.count * sizeof(Elf32_Shdr);
  ctx->image = ld_alloc(ctx, ctx->image_size);
  Elf32_Ehdr header = {.e_ident = {ELFMAG0, ELFMAG1, ELFMAG2, ELFMAG3, ELFCLASS32, ELFDATA2LSB, EV_CURRENT},
                       .e_type = ET_REL,
                       .e_machine = TRAX_EM,
                       .e_version = EV_CURRENT,
                       .e_shoff = (uint32_t)headers,
                       .e_flags = ctx->stack,
                       .e_ehsize = sizeof(Elf32_Ehdr),
                       .e_shentsize = sizeof(Elf32_Shdr),
                       .e_shnum = (Elf32_Half)writer->parts.count,
                       .e_shstrndx = (Elf32_Half)(writer->parts.count - 1)};
  ld_put(ctx, 0, &header, sizeof header, ELF_T_EHDR);
  for (size_t i = 0; i < writer->parts.count; i++) {
    const part *part = &writer->parts.items[i];
    if (part->bytes)
      ld_put(ctx, part->header.sh_offset, part->bytes, part->header.sh_size, part->type);
    ld_put(ctx, headers + i * sizeof part->header, &part->header, sizeof part->header, ELF_T_SHDR);
  }
  for (size_t i = 0; i < ctx->outputs.count; i++) {
    const ld_output *output = ctx->outputs.items[i];
    for (size_t s = 0; s < output->sections.count; s++) {
      const ld_section *section = output->sections.items[s];
      if (section->type != SHT_NOBITS && section->size)
        memcpy(ctx->image + writer->parts.items[output->header_index].header.sh_offset + section->output_offset,
               section->data, section->size);
    }
  }
}

bool ld_build_relocatable(ld_context *ctx) {
  join_sections(ctx);
  writer writer = {.ctx = ctx, .size = sizeof(Elf32_Ehdr)};
  ld_symbol_table symbols = {0};
  if (ctx->error_count)
    return false;
  if (2 * ctx->outputs.count + ctx->kept_groups.count + 4 >= SHN_LORESERVE) {
    ld_error(ctx, "more than %d output sections", (SHN_LORESERVE - 4) / 2);
    return false;
  }
  collect_symbols(ctx, &symbols);
  add_part(&writer, "", (Elf32_Shdr){0}, NULL, ELF_T_BYTE);
  uint32_t symbol_table = (uint32_t)(1 + ctx->kept_groups.count + ctx->outputs.count);
  add_groups(&writer, symbol_table);
  add_outputs(&writer);
  Elf32_Shdr header = {.sh_type = SHT_SYMTAB,
                       .sh_size = (Elf32_Word)(symbols.entries.count * sizeof(Elf32_Sym)),
                       .sh_link = symbol_table + 1,
                       .sh_info = (Elf32_Word)symbols.local_count,
                       .sh_addralign = sizeof(Elf32_Word),
                       .sh_entsize = sizeof(Elf32_Sym)};
  add_part(&writer, ".symtab", header, symbols.entries.items, ELF_T_SYM);
  header = (Elf32_Shdr){.sh_type = SHT_STRTAB, .sh_size = (Elf32_Word)symbols.names.size, .sh_addralign = 1};
  add_part(&writer, ".strtab", header, symbols.names.bytes, ELF_T_BYTE);
  add_relocs(&writer, symbol_table);
  fill_groups(&writer);
  ld_add_string(ctx, &writer.names, ".shstrtab"); /* before the size is taken */
  header = (Elf32_Shdr){.sh_type = SHT_STRTAB, .sh_size = (Elf32_Word)writer.names.size, .sh_addralign = 1};
  add_part(&writer, ".shstrtab", header, writer.names.bytes, ELF_T_BYTE);
  if (writer.size > LD_MAX_FILE)
    ld_error(ctx, "the object would have %zu bytes, more than the linker's limit, %u", writer.size, LD_MAX_FILE);
  if (ctx->error_count)
    return false;
  put_parts(&writer);
  return true;
}
