/* The linker under libFuzzer: a case is a command line and the files that it names. Files are read from the case and
   written to nowhere: ld_read_file and ld_write_file, the linker's only doors, are replaced (--wrap). */
#include "fuzz_case.h"
#include "ld.h"

#include <stdlib.h>
#include <string.h>

bool __wrap_ld_read_file(ld_context *ctx, const char *path, const uint8_t **bytes, size_t *size);
bool __wrap_ld_write_file(ld_context *ctx, const char *path, const void *bytes, size_t size, bool executable);
int __wrap_access(const char *path, int mode);
int __real_access(const char *path, int mode);

static const fuzz_case *current;
static unsigned images; /* that the current link wrote */
static volatile uint8_t sum;

bool __wrap_ld_read_file(ld_context *ctx, const char *path, const uint8_t **bytes, size_t *size) {
  const fuzz_file *file = fuzz_case_find(current, path);
  if (!file) {
    ld_error(ctx, "%s: cannot open", path);
    return false;
  }
  uint8_t *copy = ld_alloc(ctx, file->size + 1);
  memcpy(copy, file->bytes, file->size);
  *bytes = copy;
  *size = file->size;
  return true;
}

bool __wrap_ld_write_file(ld_context *ctx, const char *path, const void *bytes, size_t size, bool executable) {
  (void)ctx, (void)path;
  for (size_t i = 0; i < size; i++) /* every byte is there */
    sum ^= ((const uint8_t *)bytes)[i];
  images += executable; /* the rest is maps */
  return true;
}

int __wrap_access(const char *path, int mode) { /* -l */
  if (!current)
    return __real_access(path, mode);
  const char *slash = strrchr(path, '/');
  return fuzz_case_find(current, slash ? slash + 1 : path) ? 0 : -1;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
  fuzz_case fuzz_case;
  fuzz_case_read(&fuzz_case, bytes, size);
  char options[FUZZ_MAX_OPTIONS + 1], *words[FUZZ_MAX_OPTIONS / 2 + 3] = {(char[]){"trax-ld"}};
  memcpy(options, fuzz_case.options, sizeof options);
  int argc = 1 + (int)fuzz_case_words(options, words + 1, FUZZ_MAX_OPTIONS / 2 + 1);
  current = &fuzz_case;
  images = 0;
  int status = ld_main(argc, words);
  current = NULL;
  if (status != 0 && (status != 1 || images != 0)) {
    fprintf(stderr, "status %d with %u images\n", status, images);
    abort();
  }
  fuzz_case_free(&fuzz_case);
  return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *bytes, size_t size, size_t capacity, unsigned seed) {
  static const char *const words[] = {"%",
                                      "-l:%",
                                      "-lc",
                                      "-la",
                                      "@%",
                                      "-L.",
                                      "-e",
                                      "-ef",
                                      "-emain",
                                      "-e0x1000",
                                      "-u",
                                      "-uf",
                                      "--defsym=f=g+4",
                                      "--defsym=g=f",
                                      "--defsym=_start=0x1000",
                                      "--wrap=f",
                                      "--wrap=main",
                                      "--whole-archive",
                                      "--no-whole-archive",
                                      "--gc-sections",
                                      "--no-gc-sections",
                                      "--print-gc-sections",
                                      "-s",
                                      "-S",
                                      "-Ttext=0x2000",
                                      "-Ttext=0xFFFFF000",
                                      "-Map=-",
                                      "-M",
                                      "--print-memory-usage",
                                      "-t",
                                      "--error-limit=0",
                                      "--fatal-warnings",
                                      "-w",
                                      "-v",
                                      "--help",
                                      "-Tdata=0x4000",
                                      "-Tbss=0x10000",
                                      "--section-start=.data=0x3000",
                                      "--section-start=.rodata=0xF0000000",
                                      "--section-start=extra=0x8000",
                                      "--symbol-ordering-file=%",
                                      "--print-stack",
                                      "--stack-check=none",
                                      "--stack-check=warn",
                                      "-zstack-size=64",
                                      "--allow-multiple-definition",
                                      "-o%",
                                      "-Tdata=0x2000",
                                      "-Tbss=0x1040",
                                      "--section-start=.rodata=0x4000",
                                      "--section-start=.text.f=0x8000",
                                      "-O2",
                                      "-znow",
                                      "--",
                                      NULL};
  return fuzz_case_mutate(bytes, size, capacity, seed, words);
}
