/* libFuzzer's cross-over of two cases: files of both in one. */
#include "fuzz_case.h"

#include <string.h>

size_t LLVMFuzzerCustomCrossOver(const uint8_t *first, size_t first_size, const uint8_t *second, size_t second_size,
                                 uint8_t *result, size_t capacity, unsigned seed) {
  fuzz_random random = {seed};
  fuzz_case a, b, merged = {0};
  fuzz_case_read(&a, first, first_size);
  fuzz_case_read(&b, second, second_size);
  memcpy(merged.options, fuzz_below(&random, 2) ? a.options : b.options, sizeof merged.options);
  for (size_t i = 0; i < a.file_count && merged.file_count < FUZZ_MAX_FILES; i++)
    if (fuzz_below(&random, 4))
      merged.files[merged.file_count++] = a.files[i];
  for (size_t i = 0; i < b.file_count && merged.file_count < FUZZ_MAX_FILES; i++)
    if (fuzz_below(&random, 2))
      merged.files[merged.file_count++] = b.files[i];
  size_t size = fuzz_case_write(&merged, result, capacity);
  fuzz_case_free(&a);
  fuzz_case_free(&b);
  return size;
}
