/* Runs the cases in files without libFuzzer. Usage: PROGRAM FILE... It crashes if a case fails. */
#include "fuzz_case.h"

#include <stdio.h>
#include <stdlib.h>

size_t LLVMFuzzerMutate(uint8_t *bytes, size_t size, size_t capacity) {
  (void)bytes, (void)capacity;
  return size;
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
    LLVMFuzzerTestOneInput(bytes, (size_t)size);
    free(bytes);
  }
  fprintf(stderr, "=== %d cases ran\n", argc - 1);
  return argc > 1 ? 0 : 1;
}
