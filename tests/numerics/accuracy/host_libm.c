/* The host's binary64 functions that are not exact. With gcc and glibc on x86-64 this file alone is compiled with
   -ffast-math, which lets the loops call glibc's functions for several operands at once (libmvec): nothing here depends
   on what else the option permits, since the loops only convert and call. */
#include <math.h>
#include <string.h>

#include "reference.h"

static inline double operand(uint32_t bits) {
  float x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

#define HOST_1(name, host, exact, low, high)                                                                           \
  WIDEST void host_##name##_chunk(struct chunk *chunk) {                                                               \
    const uint32_t *restrict x = chunk->operand[0];                                                                    \
    double *restrict want = chunk->want;                                                                               \
    for (size_t i = 0; i <= CHUNK; i++)                                                                                \
      want[i] = host(operand(x[i]));                                                                                   \
  }
#define HOST_2(name, host, exact, low, high)                                                                           \
  WIDEST void host_##name##_chunk(struct chunk *chunk) {                                                               \
    const uint32_t *restrict x = chunk->operand[0], *restrict y = chunk->operand[1];                                   \
    double *restrict want = chunk->want;                                                                               \
    for (size_t i = 0; i <= CHUNK; i++)                                                                                \
      want[i] = host(operand(x[i]), operand(y[i]));                                                                    \
  }
TRANSCENDENTAL_FUNCTIONS(HOST_1)
TRANSCENDENTAL_PAIRS(HOST_2)
