#include "program/image.h"

#include <gelf.h>
#include <stdlib.h>
#include <string.h>

#include "machine/address_space.h"
#include "program/image_internal.h"
#include "trax/abi.h"
#include "trax/input.h"

/* libelf converts the headers. Every offset in them is checked here against the file's size before it is used. */

static bool inside_file(const trax_image *image, uint64_t offset, uint64_t bytes) {
  return offset <= image->size && bytes <= image->size - offset;
}

static trax_status check_identification(const trax_image *image, trax_error *error) {
  const uint8_t *ident = image->bytes;
  if (image->size == 0)
    return trax_fail(error, "%s: the file is empty", image->path);
  if (image->size < 4 || memcmp(ident, ELFMAG, SELFMAG) != 0)
    return trax_fail(error, "%s: not an ELF file%s", image->path,
                     image->size >= 8 && memcmp(ident, "!<arch>\n", 8) == 0 ? " but an archive; link it first" : "");
  if (image->size < sizeof(Elf32_Ehdr))
    return trax_fail(error, "%s: truncated: %zu bytes do not hold the ELF header", image->path, image->size);
  if (ident[EI_CLASS] != ELFCLASS32)
    return trax_fail(error, "%s: ELF class %u; a TRaX executable is ELF32 (class %u)%s", image->path, ident[EI_CLASS],
                     ELFCLASS32, ident[EI_CLASS] == ELFCLASS64 ? ": is it a program for the host?" : "");
  if (ident[EI_DATA] != ELFDATA2LSB)
    return trax_fail(error, "%s: ELF data encoding %u; a TRaX executable is little endian (%u)", image->path,
                     ident[EI_DATA], ELFDATA2LSB);
  if (ident[EI_VERSION] != EV_CURRENT)
    return trax_fail(error, "%s: ELF version %u; %u is known", image->path, ident[EI_VERSION], EV_CURRENT);
  return TRAX_OK;
}

static trax_status check_header(const trax_image *image, const Elf32_Ehdr *header, trax_error *error) {
  if (header->e_machine != TRAX_EM)
    return trax_fail(error, "%s: built for ELF machine 0x%x; TRaX is 0x%x", image->path, header->e_machine, TRAX_EM);
  if (header->e_type == ET_REL)
    return trax_fail(error, "%s: an object file, not an executable; link it first", image->path);
  if (header->e_type != ET_EXEC)
    return trax_fail(error, "%s: ELF type %u; an executable is %u", image->path, header->e_type, ET_EXEC);
  if (header->e_version != EV_CURRENT)
    return trax_fail(error, "%s: ELF header version %u; %u is known", image->path, header->e_version, EV_CURRENT);
  if (header->e_flags > TRAX_EF_STACK_GLOBAL)
    return trax_fail(error, "%s: e_flags is 0x%x; 0 to %d are defined", image->path, header->e_flags,
                     TRAX_EF_STACK_GLOBAL);
  if (header->e_ehsize != sizeof(Elf32_Ehdr))
    return trax_fail(error, "%s: ELF header of %u bytes; it has %zu", image->path, header->e_ehsize,
                     sizeof(Elf32_Ehdr));
  if (header->e_phnum == 0)
    return trax_fail(error, "%s: no program headers: nothing to load", image->path);
  if (header->e_phentsize != sizeof(Elf32_Phdr))
    return trax_fail(error, "%s: program headers of %u bytes; they have %zu", image->path, header->e_phentsize,
                     sizeof(Elf32_Phdr));
  if (header->e_phnum == PN_XNUM)
    return trax_fail(error, "%s: too many program headers", image->path);
  if (!inside_file(image, header->e_phoff, (uint64_t)header->e_phnum * sizeof(Elf32_Phdr)))
    return trax_fail(error, "%s: truncated or corrupt: %u program headers at offset 0x%x, but the file ends at 0x%zx",
                     image->path, header->e_phnum, header->e_phoff, image->size);
  if (header->e_phoff % 4 != 0 || header->e_shoff % 4 != 0)
    return trax_fail(error, "%s: corrupt: headers at offsets 0x%x and 0x%x, which are not multiples of 4", image->path,
                     header->e_phoff, header->e_shoff);
  if (header->e_shoff == 0) /* no sections: stripped to the segments */
    return TRAX_OK;
  if (header->e_shentsize != sizeof(Elf32_Shdr))
    return trax_fail(error, "%s: section headers of %u bytes; they have %zu", image->path, header->e_shentsize,
                     sizeof(Elf32_Shdr));
  if (header->e_shnum == 0)
    return trax_fail(error, "%s: more than 65279 sections, or none where the header announces a table", image->path);
  if (!inside_file(image, header->e_shoff, (uint64_t)header->e_shnum * sizeof(Elf32_Shdr)))
    return trax_fail(error, "%s: truncated or corrupt: %u section headers at offset 0x%x, but the file ends at 0x%zx",
                     image->path, header->e_shnum, header->e_shoff, image->size);
  if (header->e_shstrndx != SHN_UNDEF && header->e_shstrndx >= header->e_shnum)
    return trax_fail(error, "%s: corrupt: section names in section %u of %u", image->path, header->e_shstrndx,
                     header->e_shnum);
  return TRAX_OK;
}

static trax_status add_segment(trax_image *image, unsigned index, const Elf32_Phdr *header, trax_error *error) {
  const char *path = image->path;
  if (header->p_filesz > header->p_memsz)
    return trax_fail(error, "%s: program header %u: %u bytes in the file for %u in memory", path, index,
                     header->p_filesz, header->p_memsz);
  if (!inside_file(image, header->p_offset, header->p_filesz))
    return trax_fail(error,
                     "%s: truncated or corrupt: program header %u: %u bytes at offset 0x%x, but the file ends at 0x%zx",
                     path, index, header->p_filesz, header->p_offset, image->size);
  if (header->p_align > 1 && (header->p_align & (header->p_align - 1)) != 0)
    return trax_fail(error, "%s: program header %u: alignment %u is not a power of two", path, index, header->p_align);
  if (header->p_flags & ~(unsigned)(PF_R | PF_W | PF_X))
    return trax_fail(error, "%s: program header %u: unknown flags 0x%x", path, index, header->p_flags);
  if (header->p_memsz == 0)
    return TRAX_OK;
  if (header->p_vaddr < TRAX_NULL_END)
    return trax_fail(error, "%s: program header %u: address 0x%08x lies in the null page, which ends at 0x%08x", path,
                     index, header->p_vaddr, TRAX_NULL_END);
  if (header->p_vaddr % TRAX_GRANULE != 0)
    return trax_fail(error, "%s: program header %u: address 0x%08x is not a multiple of %u", path, index,
                     header->p_vaddr, TRAX_GRANULE);
  if ((uint64_t)header->p_vaddr + header->p_memsz > TRAX_LOCAL_BASE)
    return trax_fail(error, "%s: program header %u: 0x%08x and %u bytes reach into local memory at 0x%08x", path, index,
                     header->p_vaddr, header->p_memsz, TRAX_LOCAL_BASE);
  if ((header->p_flags & PF_W) && (header->p_flags & PF_X))
    return trax_fail(error, "%s: program header %u: a segment both writable and executable", path, index);
  image->segments[image->segment_count++] =
      (struct trax_load_segment){.address = header->p_vaddr,
                                 .memory_bytes = header->p_memsz,
                                 .file_bytes = header->p_filesz,
                                 .bytes = image->bytes + header->p_offset,
                                 .permissions = (header->p_flags & PF_R ? TRAX_PERMIT_READ : 0) |
                                                (header->p_flags & PF_W ? TRAX_PERMIT_WRITE : 0) |
                                                (header->p_flags & PF_X ? TRAX_PERMIT_EXECUTE : 0)};
  return TRAX_OK;
}

/* Thread-local objects are not loaded (docs/abi.md, "Program start"), but must fit into local memory. */
static trax_status check_thread_local(const trax_image *image, unsigned index, const Elf32_Phdr *header,
                                      trax_error *error) {
  if (header->p_filesz != 0)
    return trax_fail(error, "%s: program header %u: initialised thread-local data; only zeroed ones are supported",
                     image->path, index);
  if (header->p_memsz > TRAX_LOCAL_SIZE ||
      (header->p_memsz != 0 &&
       (header->p_vaddr < TRAX_LOCAL_BASE || header->p_vaddr - TRAX_LOCAL_BASE > TRAX_LOCAL_SIZE - header->p_memsz)))
    return trax_fail(error, "%s: program header %u: %u bytes of thread-local data at 0x%08x do not lie in local memory",
                     image->path, index, header->p_memsz, header->p_vaddr);
  return TRAX_OK;
}

static int by_address(const void *a, const void *b) {
  const struct trax_load_segment *left = a, *right = b;
  return (left->address > right->address) - (left->address < right->address);
}

static trax_status read_segments(trax_image *image, const Elf32_Ehdr *header, trax_error *error) {
  const Elf32_Phdr *programs = elf32_getphdr(image->elf);
  if (!programs)
    return trax_fail(error, "%s: corrupt program headers: %s", image->path, elf_errmsg(-1));
  image->segments = calloc(header->e_phnum, sizeof *image->segments);
  if (!image->segments)
    return trax_fail(error, "%s: out of memory", image->path);
  for (unsigned i = 0; i < header->e_phnum; ++i) {
    trax_status status = TRAX_OK;
    switch (programs[i].p_type) {
    case PT_LOAD:
      status = add_segment(image, i, &programs[i], error);
      break;
    case PT_TLS:
      status = check_thread_local(image, i, &programs[i], error);
      break;
    case PT_DYNAMIC:
    case PT_INTERP:
      status = trax_fail(error, "%s: program header %u: dynamic linking is not supported", image->path, i);
      break;
    default: /* notes and hints: not loaded */
      break;
    }
    if (status != TRAX_OK)
      return status;
  }
  if (image->segment_count == 0)
    return trax_fail(error, "%s: no loadable segment", image->path);
  qsort(image->segments, image->segment_count, sizeof *image->segments, by_address);
  for (size_t i = 1; i < image->segment_count; ++i) {
    const struct trax_load_segment *before = &image->segments[i - 1];
    uint64_t end = ((uint64_t)before->address + before->memory_bytes + TRAX_GRANULE - 1) / TRAX_GRANULE * TRAX_GRANULE;
    if (image->segments[i].address < end)
      return trax_fail(error, "%s: segments at 0x%08x and 0x%08x overlap or share %u bytes", image->path,
                       before->address, image->segments[i].address, TRAX_GRANULE);
  }
  return TRAX_OK;
}

static trax_status check_entry(const trax_image *image, trax_error *error) {
  for (size_t i = 0; i < image->segment_count; ++i) {
    const struct trax_load_segment *segment = &image->segments[i];
    if ((segment->permissions & TRAX_PERMIT_EXECUTE) && image->entry % 4 == 0 && image->entry >= segment->address &&
        image->entry - segment->address < segment->memory_bytes)
      return TRAX_OK;
  }
  return trax_fail(error, "%s: entry 0x%08x is not an instruction in an executable segment", image->path, image->entry);
}

/* Returns a section header whose range lies in the file; NULL with *error set otherwise. */
static const Elf32_Shdr *section_in_file(const trax_image *image, size_t index, const char *what, trax_error *error) {
  const Elf32_Shdr *section = elf32_getshdr(elf_getscn(image->elf, index));
  if (!section)
    trax_fail(error, "%s: corrupt section header %zu: %s", image->path, index, elf_errmsg(-1));
  else if (section->sh_type != SHT_NOBITS && !inside_file(image, section->sh_offset, section->sh_size)) {
    trax_fail(error,
              "%s: truncated or corrupt: %s (section %zu): 0x%x bytes at offset 0x%x, but the file ends at 0x%zx",
              image->path, what, index, section->sh_size, section->sh_offset, image->size);
    section = NULL;
  }
  return section;
}

static trax_status add_symbols(trax_image *image, size_t index, const Elf32_Shdr *table, size_t sections,
                               trax_error *error) {
  const char *path = image->path;
  if (table->sh_entsize != sizeof(Elf32_Sym) || table->sh_size % sizeof(Elf32_Sym) != 0 || table->sh_offset % 4 != 0)
    return trax_fail(error, "%s: corrupt symbol table: %u bytes at offset 0x%x, of entries of %u", path, table->sh_size,
                     table->sh_offset, table->sh_entsize);
  if (table->sh_link == SHN_UNDEF || table->sh_link >= sections)
    return trax_fail(error, "%s: corrupt symbol table: names in section %u of %zu", path, table->sh_link, sections);
  const Elf32_Shdr *strings = section_in_file(image, table->sh_link, "symbol names", error);
  if (!strings)
    return TRAX_ERROR;
  const char *names = (const char *)image->bytes + strings->sh_offset;
  if (strings->sh_type != SHT_STRTAB || strings->sh_size == 0 || names[strings->sh_size - 1] != 0)
    return trax_fail(error, "%s: corrupt symbol names (section %u): not a table of strings", path, table->sh_link);

  Elf_Data *data = elf_getdata(elf_getscn(image->elf, index), NULL);
  size_t count = table->sh_size / sizeof(Elf32_Sym);
  if (count == 0)
    return TRAX_OK;
  if (!data || data->d_size != table->sh_size)
    return trax_fail(error, "%s: corrupt symbol table: %s", path, elf_errmsg(-1));
  const Elf32_Sym *entries = data->d_buf;
  struct trax_symbol *symbols = realloc(image->symbols, (image->symbol_count + count) * sizeof *symbols);
  if (!symbols)
    return trax_fail(error, "%s: out of memory for %zu symbols", path, count);
  image->symbols = symbols;
  for (size_t i = 1; i < count; ++i) { /* 0 is the undefined symbol */
    const Elf32_Sym *entry = &entries[i];
    if (entry->st_name >= strings->sh_size)
      return trax_fail(error, "%s: corrupt symbol table: name of symbol %zu at 0x%x, but the names end at 0x%x", path,
                       i, entry->st_name, strings->sh_size);
    unsigned type = ELF32_ST_TYPE(entry->st_info);
    const char *name = names + entry->st_name;
    if (entry->st_shndx == SHN_UNDEF || type == STT_SECTION || type == STT_FILE || !*name)
      continue;
    symbols[image->symbol_count++] = (struct trax_symbol){.name = name,
                                                          .address = entry->st_value,
                                                          .bytes = entry->st_size,
                                                          .global = ELF32_ST_BIND(entry->st_info) != STB_LOCAL,
                                                          .absolute = entry->st_shndx == SHN_ABS,
                                                          .type = type == STT_FUNC     ? TRAX_SYMBOL_FUNCTION
                                                                  : type == STT_OBJECT ? TRAX_SYMBOL_OBJECT
                                                                  : type == STT_TLS    ? TRAX_SYMBOL_THREAD_LOCAL
                                                                                       : TRAX_SYMBOL_PLAIN};
  }
  return TRAX_OK;
}

static trax_status read_symbols(trax_image *image, const Elf32_Ehdr *header, trax_error *error) {
  if (header->e_shoff == 0)
    return TRAX_OK;
  for (size_t i = 1; i < header->e_shnum; ++i) {
    const Elf32_Shdr *section = section_in_file(image, i, "section", error);
    if (!section)
      return TRAX_ERROR;
    if (section->sh_type == SHT_SYMTAB && add_symbols(image, i, section, header->e_shnum, error) != TRAX_OK)
      return TRAX_ERROR;
  }
  return trax_image_order_symbols(image) ? TRAX_OK : trax_fail(error, "%s: out of memory", image->path);
}

/* The limit of an executable's size: initialised data for all of memory, and as much debug information. */
#define IMAGE_LIMIT ((size_t)8 << 30)

static void extend_to(size_t *end, uint64_t offset, uint64_t bytes) {
  const uint64_t range_end = offset + bytes;
  if (range_end > *end)
    *end = range_end < IMAGE_LIMIT ? (size_t)range_end : IMAGE_LIMIT;
}

/* Returns the offset at which the tables of headers end. */
static size_t end_of_tables(const trax_input *input) {
  Elf32_Ehdr header;
  memcpy(&header, input->bytes, sizeof header);
  size_t end = sizeof header;
  extend_to(&end, header.e_phoff, (uint64_t)header.e_phnum * sizeof(Elf32_Phdr));
  extend_to(&end, header.e_shoff, (uint64_t)header.e_shnum * sizeof(Elf32_Shdr));
  return end;
}

/* Returns the greatest end of the segments and sections, or `end` if that is greater. */
static size_t end_of_contents(const trax_input *input, size_t end) {
  Elf32_Ehdr header;
  memcpy(&header, input->bytes, sizeof header);
  for (size_t i = 0, at; i < header.e_phnum && (at = header.e_phoff + i * sizeof(Elf32_Phdr)) < input->size; i++) {
    Elf32_Phdr segment = {0};
    if (input->size - at >= sizeof segment)
      memcpy(&segment, input->bytes + at, sizeof segment);
    extend_to(&end, segment.p_offset, segment.p_filesz);
  }
  for (size_t i = 0, at; i < header.e_shnum && (at = header.e_shoff + i * sizeof(Elf32_Shdr)) < input->size; i++) {
    Elf32_Shdr section = {.sh_type = SHT_NOBITS};
    if (input->size - at >= sizeof section)
      memcpy(&section, input->bytes + at, sizeof section);
    if (section.sh_type != SHT_NOBITS)
      extend_to(&end, section.sh_offset, section.sh_size);
  }
  return end;
}

/* Reads an executable up to the end that its headers give, so that a device that never ends is not read for ever.
 *bytes is from malloc. */
static trax_status read_image(const char *path, uint8_t **bytes, size_t *size, trax_error *error) {
  trax_input input;
  trax_status status = trax_input_open(&input, path, error);
  if (status == TRAX_OK)
    status = trax_input_read(&input, sizeof(Elf32_Ehdr), error);
  const trax_image beginning = {.path = (char *)path, .bytes = input.bytes, .size = input.size};
  if (status == TRAX_OK && check_identification(&beginning, NULL) == TRAX_OK) {
    const size_t tables = end_of_tables(&input);
    status = trax_input_read(&input, tables, error);
    if (status == TRAX_OK)
      status = trax_input_read(&input, end_of_contents(&input, tables), error);
  }
  if (status == TRAX_OK) {
    *bytes = input.bytes;
    *size = input.size;
    input.bytes = NULL;
  }
  trax_input_close(&input);
  return status;
}

/* The flags say where the code expects the stack, the symbol where it is. */
static trax_status check_stack(const trax_image *image, uint32_t flags, trax_error *error) {
  const bool is_global = trax_image_symbol(image, "__trax_stack_size");
  if (flags != 0 && is_global != (flags == TRAX_EF_STACK_GLOBAL))
    return trax_fail(error, "%s: is for stacks in %s", image->path,
                     is_global ? "local memory, but has a symbol __trax_stack_size"
                               : "global memory, but has no symbol __trax_stack_size: was the symbol table removed?");
  return TRAX_OK;
}

static trax_status check_image(trax_image *image, trax_error *error) {
  if (check_identification(image, error) != TRAX_OK)
    return TRAX_ERROR;
  elf_version(EV_CURRENT);
  image->elf = elf_memory((char *)image->bytes, image->size);
  const Elf32_Ehdr *header = image->elf ? elf32_getehdr(image->elf) : NULL;
  if (!header)
    return trax_fail(error, "%s: corrupt ELF header: %s", image->path, elf_errmsg(-1));
  image->entry = header->e_entry;
  if (check_header(image, header, error) != TRAX_OK || read_segments(image, header, error) != TRAX_OK ||
      check_entry(image, error) != TRAX_OK)
    return TRAX_ERROR;
  return read_symbols(image, header, error) == TRAX_OK ? check_stack(image, header->e_flags, error) : TRAX_ERROR;
}

/* The image takes the bytes. */
static trax_image *image_of(const char *path, uint8_t *bytes, size_t size, trax_error *error) {
  trax_image *image = calloc(1, sizeof *image);
  if (image)
    *image = (trax_image){.path = strdup(path), .bytes = bytes, .size = size};
  else
    free(bytes);
  if (!image || !image->path || !bytes)
    trax_fail(error, "%s: out of memory", path);
  else if (check_image(image, error) == TRAX_OK)
    return image;
  trax_image_close(image);
  return NULL;
}

trax_image *trax_image_of(const char *path, const uint8_t *bytes, size_t size, trax_error *error) {
  uint8_t *copy = malloc(size + 1);
  if (copy)
    memcpy(copy, bytes, size);
  return image_of(path, copy, size, error);
}

trax_image *trax_image_open(const char *path, trax_error *error) {
  uint8_t *bytes;
  size_t size;
  return read_image(path, &bytes, &size, error) == TRAX_OK ? image_of(path, bytes, size, error) : NULL;
}

void trax_image_close(trax_image *image) {
  if (!image)
    return;
  trax_image_forget_lines(image);
  elf_end(image->elf);
  free(image->symbols);
  free(image->names);
  free(image->segments);
  free(image->bytes);
  free(image->path);
  free(image);
}

const char *trax_image_path(const trax_image *image) {
  return image->path;
}
const uint8_t *trax_image_bytes(const trax_image *image, size_t *size) {
  *size = image->size;
  return image->bytes;
}

uint32_t trax_image_entry(const trax_image *image) {
  return image->entry;
}

const struct trax_load_segment *trax_image_segments(const trax_image *image, size_t *count) {
  *count = image->segment_count;
  return image->segments;
}

const struct trax_symbol *trax_image_symbols(const trax_image *image, size_t *count) {
  *count = image->symbol_count;
  return image->symbols;
}

const struct trax_symbol *trax_image_symbol(const trax_image *image, const char *name) {
  const struct trax_symbol *found = NULL;
  for (size_t i = 0; i < image->symbol_count; ++i)
    if (strcmp(image->symbols[i].name, name) == 0) {
      if (image->symbols[i].global)
        return &image->symbols[i];
      if (!found)
        found = &image->symbols[i];
    }
  return found;
}
