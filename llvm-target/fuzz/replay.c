/* Runs the cases in files without libFuzzer. Usage: PROGRAM FILE... Each case runs unchanged, and then as the fuzzer's
   own mutator and cross-over change it, the same way each time. The program crashes if a case fails. */
#include "fuzz_case.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#pragma weak LLVMFuzzerCustomMutator
#pragma weak LLVMFuzzerCustomCrossOver

enum { MUTANTS = 24, MORE = 600 /* bytes that a mutant may have more */, GUARD = 64, GUARD_BYTE = 0xA5 };

static fuzz_random random_bytes;

/* Changes or appends a byte. */
size_t LLVMFuzzerMutate(uint8_t *bytes, size_t size, size_t capacity) {
  const bool longer = size < capacity && fuzz_below(&random_bytes, 4) == 0;
  if (size + longer)
    bytes[longer ? size : fuzz_below(&random_bytes, (uint32_t)size)] = (uint8_t)fuzz_below(&random_bytes, 256);
  return size + longer;
}

/* Runs a copy of exactly this size, so that a sanitizer sees reads beyond it. */
static void run(const uint8_t *bytes, size_t size) {
  uint8_t *copy = malloc(size ? size : 1);
  if (!copy)
    abort();
  if (size)
    memcpy(copy, bytes, size);
  LLVMFuzzerTestOneInput(copy, size);
  free(copy);
}

static size_t mutate(uint8_t *bytes, size_t size, size_t capacity, unsigned seed) {
  return LLVMFuzzerCustomMutator ? LLVMFuzzerCustomMutator(bytes, size, capacity, seed)
                                 : LLVMFuzzerMutate(bytes, size, capacity);
}

/* Runs mutants of the case. Every third is the one before it crossed with the case. */
static void run_mutants(const uint8_t *bytes, size_t size) {
  const size_t capacity = size + MORE;
  uint8_t *mutant = malloc(capacity + GUARD), *before = malloc(capacity);
  if (!mutant || !before)
    abort();
  memcpy(mutant, bytes, size);
  memset(mutant + size, GUARD_BYTE, MORE + GUARD);
  size_t now = size;
  for (unsigned seed = 1; seed <= MUTANTS; seed++) {
    random_bytes.state = seed;
    memcpy(before, mutant, now);
    memcpy(mutant, bytes, size);
    now = LLVMFuzzerCustomCrossOver && seed % 3 == 0
              ? LLVMFuzzerCustomCrossOver(bytes, size, before, now, mutant, capacity, seed)
              : mutate(mutant, size, capacity, seed);
    for (size_t i = 0; i < GUARD; i++)
      if (now > capacity || mutant[capacity + i] != GUARD_BYTE) {
        fprintf(stderr, "mutant %u has left its %zu bytes\n", seed, capacity);
        abort();
      }
    fprintf(stderr, "mutant %u\n", seed);
    run(mutant, now);
  }
  free(mutant);
  free(before);
}

int main(int argc, char **argv) {
  for (int i = 1; i < argc; i++) {
    FILE *file = fopen(argv[i], "rb");
    long size = -1;
    if (file && fseek(file, 0, SEEK_END) == 0)
      size = ftell(file);
    uint8_t *bytes = size < 0 ? NULL : malloc((size_t)size + 1);
    if (!bytes || fseek(file, 0, SEEK_SET) != 0 || fread(bytes, 1, (size_t)size, file) != (size_t)size) {
      fprintf(stderr, "%s: cannot read\n", argv[i]);
      return 1;
    }
    fclose(file);
    fprintf(stderr, "=== %s\n", argv[i]); /* the last one is the one that crashed */
    run(bytes, (size_t)size);
    run_mutants(bytes, (size_t)size);
    free(bytes);
  }
  fprintf(stderr, "=== %d cases ran\n", argc - 1);
  return argc > 1 ? 0 : 1;
}
