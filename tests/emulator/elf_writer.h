/* Executables made in memory, so that the loader's tests need neither compiler nor linker. */
#ifndef TRAX_TESTS_ELF_WRITER_H
#define TRAX_TESTS_ELF_WRITER_H

#include <elf.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "trax/abi.h"
#include "trax/isa.h"

#define TEXT 0x1000u
#define DATA 0x10000u /* what `lui rd, 1` gives */

struct elf_symbol {
  const char *name;
  uint32_t address, bytes;
  unsigned char type; /* STT_FUNC, ... */
  unsigned char bind; /* STB_GLOBAL, ... */
};

struct elf_program {
  const uint32_t *text; /* at TEXT, where it starts */
  size_t words;
  const void *data; /* at DATA, writable */
  size_t data_bytes, zero_bytes;
  const struct elf_symbol *symbols;
  size_t symbol_count;
  bool debug; /* with the lines of elf_debug.c */
};

struct elf_file {
  uint8_t *bytes; /* malloc */
  size_t size;
};

/* Program headers 0 (text) and 1 (data); sections .text .data .symtab .strtab .shstrtab and, if asked for, .debug_*.
   The section headers are the end of the file. */
struct elf_file elf_write(const struct elf_program *program);
void elf_save(const char *path, const struct elf_file *file);

/* Headers and sections of a file, for tests that damage them. */
Elf32_Ehdr *elf_header(struct elf_file *file);
Elf32_Phdr *elf_program_header(struct elf_file *file, unsigned index);
/* By name; NULL if there is none. */
Elf32_Shdr *elf_section(struct elf_file *file, const char *name);

/* DWARF 4 for a text of four instructions or more, compiled from dir/source.c: instruction i comes from line 10 + i,
   column 3, but instruction 2, in line 5, is `inner`, inlined into `outer` at line 12. */
struct elf_debug {
  uint8_t abbreviations[128], info[256], lines[256];
  size_t abbreviation_bytes, info_bytes, line_bytes;
};
void elf_debug_make(struct elf_debug *debug, uint32_t text, size_t words);

/* Instructions by format. */
#define R(OP, RD, RA, RB) trax_encode((trax_inst){TRAX_OP_##OP, RD, RA, RB, 0})
#define I(OP, RD, RA, IMM) trax_encode((trax_inst){TRAX_OP_##OP, RD, RA, 0, IMM})
#define U(OP, RD, IMM) trax_encode((trax_inst){TRAX_OP_##OP, RD, 0, 0, IMM})
#define S(OP, RB, RA, IMM) trax_encode((trax_inst){TRAX_OP_##OP, 0, RA, RB, IMM})
#define B(OP, RA, RB, OFFSET) trax_encode((trax_inst){TRAX_OP_##OP, 0, RA, RB, OFFSET})
#define T(RA, CODE) trax_encode((trax_inst){TRAX_OP_TRAP, 0, RA, 0, CODE})
#define HALT trax_encode((trax_inst){.op = TRAX_OP_HALT})

#endif
