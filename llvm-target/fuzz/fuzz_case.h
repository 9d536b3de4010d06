/* One case of a fuzzer, as a file: a line of options, then named files, each headed by a line "NAME BYTES".

     a.o lib.a --gc-sections\n
     a.o 1234\n <1234 bytes>
     lib.a 567\n <567 bytes>

   Reading accepts every sequence of bytes; writing gives what reading took. */
#ifndef TRAX_FUZZ_CASE_H
#define TRAX_FUZZ_CASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FUZZ_MAX_FILES 8
#define FUZZ_MAX_OPTIONS 512 /* bytes of the first line */
#define FUZZ_MAX_NAME 16     /* bytes of a name */

typedef struct fuzz_file {
  char name[FUZZ_MAX_NAME + 1];
  uint8_t *bytes; /* owned */
  size_t size;
} fuzz_file;

typedef struct fuzz_case {
  char options[FUZZ_MAX_OPTIONS + 1];
  fuzz_file files[FUZZ_MAX_FILES];
  size_t file_count;
} fuzz_case;

/* result is freed with fuzz_case_free. */
void fuzz_case_read(fuzz_case *result, const uint8_t *bytes, size_t size);
/* The bytes written; files that do not fit into capacity are cut or left out. */
size_t fuzz_case_write(const fuzz_case *fuzz_case, uint8_t *bytes, size_t capacity);
void fuzz_case_free(fuzz_case *fuzz_case);
const fuzz_file *fuzz_case_find(const fuzz_case *fuzz_case, const char *name); /* NULL if absent */
/* Cuts options into words at spaces, in place; how many there are, at most limit. */
size_t fuzz_case_words(char *options, char **words, size_t limit);

/* The body of a program's custom mutator. words: options that it may add, with a space between two; "%" at the end of
   one becomes the name of a file. */
size_t fuzz_case_mutate(uint8_t *bytes, size_t size, size_t capacity, unsigned seed, const char *words);

/* --- fuzz_elf.c --- */

typedef struct fuzz_random {
  uint64_t state;
} fuzz_random;

/* A number below limit, which is not 0. */
uint32_t fuzz_below(fuzz_random *random, uint32_t limit);
/* libFuzzer's own mutation of plain bytes; in a replay, nothing. */
size_t LLVMFuzzerMutate(uint8_t *bytes, size_t size, size_t capacity);

/* Changes one thing in an ELF32 little-endian file: a field of a header, a symbol or a relocation, the order or the
   number of those, or the bytes of one section. A file that is none is mutated as plain bytes. Returns the new size. */
size_t fuzz_mutate_elf(uint8_t *bytes, size_t size, size_t capacity, fuzz_random *random);

/* --- in each fuzzer --- */

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);
/* Mutators for programs that have them; the second is that of cross.c. */
size_t LLVMFuzzerCustomMutator(uint8_t *bytes, size_t size, size_t capacity, unsigned seed);
size_t LLVMFuzzerCustomCrossOver(const uint8_t *first, size_t first_size, const uint8_t *second, size_t second_size,
                                 uint8_t *result, size_t capacity, unsigned seed);

#ifdef __cplusplus
}
#endif
#endif
