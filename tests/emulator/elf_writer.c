#include "elf_writer.h"

#undef NDEBUG /* tests check in every build */
#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_SECTIONS = 12 };

struct section {
  Elf32_Shdr header;
  const void *bytes;
};

struct writer {
  struct section sections[MAX_SECTIONS];
  unsigned count;
  char names[256];
  size_t name_bytes;
};

static unsigned add_section(struct writer *writer, const char *name, Elf32_Word type, const void *bytes, size_t size) {
  assert(writer->count < MAX_SECTIONS && writer->name_bytes + strlen(name) < sizeof writer->names);
  struct section *section = &writer->sections[writer->count];
  *section = (struct section){.header = {.sh_name = (Elf32_Word)writer->name_bytes,
                                         .sh_type = type,
                                         .sh_size = (Elf32_Word)size,
                                         .sh_addralign = 4},
                              .bytes = bytes};
  strcpy(writer->names + writer->name_bytes, name);
  writer->name_bytes += strlen(name) + 1;
  return writer->count++;
}

static uint8_t *add_symbols(struct writer *writer, const struct elf_program *program, char **strings) {
  size_t name_bytes = 1;
  for (size_t i = 0; i < program->symbol_count; ++i)
    name_bytes += strlen(program->symbols[i].name) + 1;
  *strings = calloc(1, name_bytes);
  Elf32_Sym *table = calloc(program->symbol_count + 1, sizeof *table);
  char *name = *strings + 1;
  for (size_t i = 0; i < program->symbol_count; ++i) {
    const struct elf_symbol *symbol = &program->symbols[i];
    table[i + 1] = (Elf32_Sym){.st_name = (Elf32_Word)(name - *strings),
                               .st_value = symbol->address,
                               .st_size = symbol->bytes,
                               .st_info = ELF32_ST_INFO(symbol->bind, symbol->type),
                               .st_shndx = symbol->address < DATA ? 1 : 2};
    name = stpcpy(name, symbol->name) + 1;
  }
  unsigned index = add_section(writer, ".symtab", SHT_SYMTAB, table, (program->symbol_count + 1) * sizeof(Elf32_Sym));
  writer->sections[index].header.sh_entsize = sizeof(Elf32_Sym);
  writer->sections[index].header.sh_link = add_section(writer, ".strtab", SHT_STRTAB, *strings, name_bytes);
  writer->sections[index].header.sh_info = 1;
  return (uint8_t *)table;
}

static size_t aligned(size_t size) {
  return (size + 63) / 64 * 64;
}

struct elf_file elf_write(const struct elf_program *program) {
  struct writer writer = {.count = 0};
  struct elf_debug debug;
  char *strings;
  add_section(&writer, "", SHT_NULL, NULL, 0);
  writer.sections[0].header.sh_addralign = 0;
  add_section(&writer, ".text", SHT_PROGBITS, program->text, program->words * 4);
  add_section(&writer, ".data", SHT_PROGBITS, program->data, program->data_bytes);
  uint8_t *symbols = add_symbols(&writer, program, &strings);
  if (program->debug) {
    elf_debug_make(&debug, TEXT, program->words);
    add_section(&writer, ".debug_abbrev", SHT_PROGBITS, debug.abbreviations, debug.abbreviation_bytes);
    add_section(&writer, ".debug_info", SHT_PROGBITS, debug.info, debug.info_bytes);
    add_section(&writer, ".debug_line", SHT_PROGBITS, debug.lines, debug.line_bytes);
  }
  unsigned names = add_section(&writer, ".shstrtab", SHT_STRTAB, writer.names, 0);
  writer.sections[names].header.sh_size = (Elf32_Word)writer.name_bytes;
  writer.sections[1].header.sh_addr = TEXT;
  writer.sections[2].header.sh_addr = DATA;

  size_t offset = aligned(sizeof(Elf32_Ehdr) + 2 * sizeof(Elf32_Phdr));
  for (unsigned i = 1; i < writer.count; ++i) {
    writer.sections[i].header.sh_offset = (Elf32_Word)offset;
    offset = aligned(offset + writer.sections[i].header.sh_size);
  }
  struct elf_file file = {.size = offset + writer.count * sizeof(Elf32_Shdr)};
  file.bytes = calloc(1, file.size);
  Elf32_Ehdr header = {.e_ident = {ELFMAG0, ELFMAG1, ELFMAG2, ELFMAG3, ELFCLASS32, ELFDATA2LSB, EV_CURRENT},
                       .e_type = ET_EXEC,
                       .e_machine = TRAX_EM,
                       .e_version = EV_CURRENT,
                       .e_entry = TEXT,
                       .e_phoff = sizeof(Elf32_Ehdr),
                       .e_shoff = (Elf32_Off)offset,
                       .e_ehsize = sizeof(Elf32_Ehdr),
                       .e_phentsize = sizeof(Elf32_Phdr),
                       .e_phnum = 2,
                       .e_shentsize = sizeof(Elf32_Shdr),
                       .e_shnum = (Elf32_Half)writer.count,
                       .e_shstrndx = (Elf32_Half)names};
  memcpy(file.bytes, &header, sizeof header);
  Elf32_Phdr programs[2] = {{.p_type = PT_LOAD, .p_vaddr = TEXT, .p_flags = PF_R | PF_X},
                            {.p_type = PT_LOAD, .p_vaddr = DATA, .p_flags = PF_R | PF_W}};
  for (unsigned i = 0; i < 2; ++i) {
    programs[i].p_offset = writer.sections[i + 1].header.sh_offset;
    programs[i].p_paddr = programs[i].p_vaddr;
    programs[i].p_filesz = programs[i].p_memsz = writer.sections[i + 1].header.sh_size;
    programs[i].p_align = 64;
  }
  programs[1].p_memsz += (Elf32_Word)program->zero_bytes;
  memcpy(file.bytes + sizeof header, programs, sizeof programs);
  for (unsigned i = 0; i < writer.count; ++i) {
    const struct section *section = &writer.sections[i];
    if (section->header.sh_size)
      memcpy(file.bytes + section->header.sh_offset, section->bytes, section->header.sh_size);
    memcpy(file.bytes + offset + i * sizeof section->header, &section->header, sizeof section->header);
  }
  free(symbols);
  free(strings);
  return file;
}

void elf_save(const char *path, const struct elf_file *file) {
  FILE *out = fopen(path, "wb");
  if (!out || fwrite(file->bytes, 1, file->size, out) != file->size || fclose(out) != 0) {
    perror(path);
    exit(1);
  }
}

Elf32_Ehdr *elf_header(struct elf_file *file) {
  return (Elf32_Ehdr *)file->bytes;
}

Elf32_Phdr *elf_program_header(struct elf_file *file, unsigned index) {
  return (Elf32_Phdr *)(file->bytes + elf_header(file)->e_phoff) + index;
}

Elf32_Shdr *elf_section(struct elf_file *file, const char *name) {
  Elf32_Shdr *sections = (Elf32_Shdr *)(file->bytes + elf_header(file)->e_shoff);
  const char *names = (const char *)file->bytes + sections[elf_header(file)->e_shstrndx].sh_offset;
  for (unsigned i = 0; i < elf_header(file)->e_shnum; ++i)
    if (strcmp(names + sections[i].sh_name, name) == 0)
      return &sections[i];
  return NULL;
}
