/* The interface of a kernel of the code-quality benchmark: a function that does the same work at each call, and data
   that are prepared once. quality.py describes how instructions are counted. */
#ifndef TRAX_BENCH_H
#define TRAX_BENCH_H

#include <stdint.h>

struct result {
  uint32_t checksum; /* of all results: the same on every machine, except with contracted arithmetic */
  float measure;     /* a mean of floating-point results, which contraction hardly moves; 0 in integer kernels */
};

void kernel_setup(void);
struct result kernel_run(void);

/* The same numbers on every machine. */
static inline uint32_t next_random(uint32_t *state) {
  return *state = *state * 1664525u + 1013904223u;
}
/* In [0, 1). */
static inline float next_float(uint32_t *state) {
  return (float)(int32_t)(next_random(state) >> 8) * 0x1p-24f;
}

static inline uint32_t mix(uint32_t checksum, uint32_t word) {
  return (checksum << 5 | checksum >> 27) + word;
}
static inline uint32_t mix_float(uint32_t checksum, float value) {
  uint32_t word;
  __builtin_memcpy(&word, &value, sizeof word);
  return mix(checksum, word);
}

#endif
