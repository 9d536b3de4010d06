/* Mutation of ELF files along their structure: plain bytes seldom get past the checks of a header. */
#include "fuzz_case.h"

#include <elf.h>
#include <string.h>

uint32_t fuzz_below(fuzz_random *random, uint32_t limit) { /* splitmix64 */
  uint64_t z = random->state += 0x9E3779B97F4A7C15u;
  z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
  z = (z ^ z >> 27) * 0x94D049BB133111EBu;
  return (uint32_t)((z ^ z >> 31) >> 32) % limit;
}

typedef struct elf_file {
  uint8_t *bytes;
  size_t size, capacity;
  Elf32_Ehdr header;
  fuzz_random *random;
} elf_file;

typedef struct field {
  uint8_t offset, width;
} field;

#define FIELD(type, member) {offsetof(type, member), sizeof(((type *)0)->member)}

static const field header_fields[] = {
    FIELD(Elf32_Ehdr, e_type),     FIELD(Elf32_Ehdr, e_entry),     FIELD(Elf32_Ehdr, e_phoff),
    FIELD(Elf32_Ehdr, e_shoff),    FIELD(Elf32_Ehdr, e_flags),     FIELD(Elf32_Ehdr, e_phentsize),
    FIELD(Elf32_Ehdr, e_phnum),    FIELD(Elf32_Ehdr, e_shentsize), FIELD(Elf32_Ehdr, e_shnum),
    FIELD(Elf32_Ehdr, e_shstrndx), FIELD(Elf32_Ehdr, e_machine)};
static const field section_fields[] = {
    FIELD(Elf32_Shdr, sh_name),      FIELD(Elf32_Shdr, sh_type),   FIELD(Elf32_Shdr, sh_flags),
    FIELD(Elf32_Shdr, sh_addr),      FIELD(Elf32_Shdr, sh_size),   FIELD(Elf32_Shdr, sh_offset),
    FIELD(Elf32_Shdr, sh_link),      FIELD(Elf32_Shdr, sh_info),   FIELD(Elf32_Shdr, sh_size),
    FIELD(Elf32_Shdr, sh_addralign), FIELD(Elf32_Shdr, sh_entsize)};
static const field segment_fields[] = {
    FIELD(Elf32_Phdr, p_type),  FIELD(Elf32_Phdr, p_offset), FIELD(Elf32_Phdr, p_vaddr), FIELD(Elf32_Phdr, p_filesz),
    FIELD(Elf32_Phdr, p_memsz), FIELD(Elf32_Phdr, p_flags),  FIELD(Elf32_Phdr, p_align)};
static const field symbol_fields[] = {FIELD(Elf32_Sym, st_name),  FIELD(Elf32_Sym, st_value),
                                      FIELD(Elf32_Sym, st_size),  FIELD(Elf32_Sym, st_info),
                                      FIELD(Elf32_Sym, st_other), FIELD(Elf32_Sym, st_shndx)};
static const field relocation_fields[] = {FIELD(Elf32_Rela, r_offset),
                                          {offsetof(Elf32_Rela, r_info), 1},
                                          {offsetof(Elf32_Rela, r_info) + 1, 1},
                                          FIELD(Elf32_Rela, r_info),
                                          FIELD(Elf32_Rela, r_addend)};
static const field word_fields[] = {{0, 4}};
#define CHOOSE(file, table) (table)[fuzz_below((file)->random, sizeof(table) / sizeof *(table))]

/* The section headers that are inside the file. */
static uint32_t section_count(const elf_file *file) {
  size_t start = file->header.e_shoff;
  if (start == 0 || start > file->size)
    return 0;
  size_t fits = (file->size - start) / sizeof(Elf32_Shdr);
  return (uint32_t)(file->header.e_shnum < fits ? file->header.e_shnum : fits);
}

static Elf32_Shdr get_section(const elf_file *file, uint32_t index) {
  Elf32_Shdr section;
  memcpy(&section, file->bytes + file->header.e_shoff + index * sizeof section, sizeof section);
  return section;
}

static void put_section(const elf_file *file, uint32_t index, const Elf32_Shdr *section) {
  memcpy(file->bytes + file->header.e_shoff + index * sizeof *section, section, sizeof *section);
}

/* Whether the section's contents are inside the file; large ones are cut. */
static bool has_contents(const elf_file *file, Elf32_Shdr *section) {
  if (section->sh_type == SHT_NOBITS || section->sh_offset >= file->size || section->sh_size == 0)
    return false;
  if (section->sh_size > file->size - section->sh_offset)
    section->sh_size = (Elf32_Word)(file->size - section->sh_offset);
  return true;
}

/* A value that is often a limit of something in this file. */
static uint32_t telling_value(elf_file *file, uint32_t old) {
  static const uint32_t values[] = {0,        1,          2,          3,          4,          8,          0xC,
                                    0x10,     0x3F,       0x40,       0xFF,       0x800,      0x900,      0x1000,
                                    0x7FFF,   0x8000,     0xFF00,     0xFFF1,     0xFFF2,     0xFFFF,     0x10000,
                                    0xFFFFFF, 0x6FFF4C03, 0x70000000, 0x7FFFFFFF, 0x80000000, 0xFFFFFE00, 0xFFFFFFFF};
  static const uint32_t types[] = {SHT_GROUP,  SHT_RELA,         SHT_REL,        SHT_NOBITS, SHT_SYMTAB,
                                   SHT_STRTAB, SHT_SYMTAB_SHNDX, SHT_INIT_ARRAY, SHT_NOTE};
  uint32_t count = section_count(file);
  switch (fuzz_below(file->random, 8)) {
  case 0:
    return fuzz_below(file->random, 4) ? CHOOSE(file, values) : CHOOSE(file, types);
  case 1:
    return old + fuzz_below(file->random, 9) - 4;
  case 2:
    return old ^ 1u << fuzz_below(file->random, 32);
  case 3:
    return (uint32_t)file->size + fuzz_below(file->random, 5) - 2;
  case 4:
    return count + fuzz_below(file->random, 3) - 1;
  case 5: /* an index or something small */
    return fuzz_below(file->random, count ? count : 16);
  default:
    if (count) { /* a field of another section */
      Elf32_Shdr other = get_section(file, fuzz_below(file->random, count));
      const field field = CHOOSE(file, section_fields);
      uint32_t value;
      memcpy(&value, (const uint8_t *)&other + field.offset, 4);
      return value;
    }
    return fuzz_below(file->random, 256);
  }
}

static void change_field(elf_file *file, size_t base, field field) {
  if (base > file->size || file->size - base < (size_t)field.offset + field.width)
    return;
  uint32_t value = 0;
  memcpy(&value, file->bytes + base + field.offset, field.width);
  value = telling_value(file, value);
  memcpy(file->bytes + base + field.offset, &value, field.width);
}

static void change_section_header(elf_file *file, uint32_t count) {
  uint32_t a = fuzz_below(file->random, count), b = fuzz_below(file->random, count);
  Elf32_Shdr first = get_section(file, a), second = get_section(file, b);
  switch (fuzz_below(file->random, 6)) {
  case 0:
    put_section(file, a, &second);
    put_section(file, b, &first);
    break;
  case 1:
    put_section(file, b, &first);
    break;
  default:
    change_field(file, file->header.e_shoff + a * sizeof first, CHOOSE(file, section_fields));
    break;
  }
}

/* A table's section with one entry more, a copy of another; the table moves to the end of the file. */
static void grow_table(elf_file *file, uint32_t index, Elf32_Shdr *section, size_t entry_size) {
  size_t start = (file->size + 3) & ~(size_t)3, size = section->sh_size + entry_size;
  if (start > file->capacity || file->capacity - start < size)
    return;
  memset(file->bytes + file->size, 0, start - file->size);
  memmove(file->bytes + start, file->bytes + section->sh_offset, section->sh_size);
  size_t copied = fuzz_below(file->random, (uint32_t)(section->sh_size / entry_size)) * entry_size;
  memmove(file->bytes + start + section->sh_size, file->bytes + start + copied, entry_size);
  section->sh_offset = (Elf32_Off)start;
  section->sh_size = (Elf32_Word)size;
  put_section(file, index, section);
  file->size = start + size;
}

static void change_entry(elf_file *file, uint32_t index, Elf32_Shdr *section, size_t entry_size, field field) {
  uint32_t entries = (uint32_t)(section->sh_size / entry_size);
  if (entries == 0)
    return;
  uint8_t *table = file->bytes + section->sh_offset;
  uint32_t a = fuzz_below(file->random, entries), b = fuzz_below(file->random, entries);
  switch (fuzz_below(file->random, 8)) {
  case 0:
    memmove(table + a * entry_size, table + b * entry_size, entry_size);
    break;
  case 1:
    grow_table(file, index, section, entry_size);
    break;
  case 2: /* one field of another entry */
    memmove(table + a * entry_size + field.offset, table + b * entry_size + field.offset, field.width);
    break;
  default:
    change_field(file, section->sh_offset + a * entry_size, field);
    break;
  }
}

static void change_contents(elf_file *file, uint32_t count) {
  uint32_t index = fuzz_below(file->random, count);
  Elf32_Shdr section = get_section(file, index);
  if (!has_contents(file, &section))
    return;
  switch (section.sh_type) {
  case SHT_SYMTAB:
    change_entry(file, index, &section, sizeof(Elf32_Sym), CHOOSE(file, symbol_fields));
    break;
  case SHT_RELA:
    change_entry(file, index, &section, sizeof(Elf32_Rela), CHOOSE(file, relocation_fields));
    break;
  case SHT_GROUP:
  case SHT_SYMTAB_SHNDX:
    change_entry(file, index, &section, 4, word_fields[0]);
    break;
  default:
    if (fuzz_below(file->random, 4) == 0)
      change_field(file, section.sh_offset + fuzz_below(file->random, section.sh_size), word_fields[0]);
    else
      LLVMFuzzerMutate(file->bytes + section.sh_offset, section.sh_size, section.sh_size);
    break;
  }
}

size_t fuzz_mutate_elf(uint8_t *bytes, size_t size, size_t capacity, fuzz_random *random) {
  elf_file file = {.bytes = bytes, .size = size, .capacity = capacity, .random = random};
  if (size < sizeof file.header || memcmp(bytes, ELFMAG, SELFMAG) != 0 || fuzz_below(random, 32) == 0)
    return LLVMFuzzerMutate(bytes, size, capacity);
  memcpy(&file.header, bytes, sizeof file.header);
  uint32_t count = section_count(&file), kind = fuzz_below(random, 16);
  if (kind == 0 || count == 0)
    change_field(&file, 0, CHOOSE(&file, header_fields));
  else if (kind == 1 && file.header.e_phnum)
    change_field(&file, file.header.e_phoff + fuzz_below(random, file.header.e_phnum) * sizeof(Elf32_Phdr),
                 CHOOSE(&file, segment_fields));
  else if (kind < 7)
    change_section_header(&file, count);
  else
    change_contents(&file, count);
  return file.size;
}
