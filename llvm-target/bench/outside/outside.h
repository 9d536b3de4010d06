/* Shared by the drivers of outside programs: input data, and memory for malloc where there is no loader. */
#ifndef TRAX_OUTSIDE_H
#define TRAX_OUTSIDE_H

#include "../bench.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#ifdef __riscv
extern uintptr_t __trax_heap, __trax_heap_end;
static inline void outside_begin(void) {
  static char memory[24 << 20];
  static _Alignas(64) char thread[4096]; /* for the library's variables of threads, which are zero at first */
  __asm__ volatile("mv tp, %0" : : "r"(thread));
  __trax_heap = (uintptr_t)memory;
  __trax_heap_end = (uintptr_t)(memory + sizeof memory);
}
#else
static inline void outside_begin(void) {}
#endif

/* Lines of words from a small vocabulary, for compressors and hashes. */
static inline void outside_text(char *text, uint32_t size) {
  uint32_t random = 7;
  for (uint32_t i = 0; i < size;) {
    uint32_t word = next_random(&random) >> 24, length = 2 + word % 7;
    for (uint32_t j = 0; j < length && i < size; j++, word = word * 41 + 3)
      text[i++] = (char)('a' + (word >> 3) % 26);
    if (i < size)
      text[i++] = next_random(&random) >> 28 ? ' ' : '\n';
  }
}

static inline uint32_t outside_sum(const void *bytes, uint32_t size) {
  uint32_t sum = size;
  for (uint32_t i = 0; i < size; i++)
    sum = mix(sum, ((const unsigned char *)bytes)[i]);
  return sum;
}

/* The checksum of packed data; 0 if the unpacked data differ from the original. */
static inline struct result outside_round_trip(const void *before, const void *after, uint32_t size, const void *packed,
                                               uint32_t packed_size) {
  return (struct result){memcmp(before, after, size) == 0 ? outside_sum(packed, packed_size) : 0, 0};
}

#endif
