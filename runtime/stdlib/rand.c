/* Pseudo-random numbers: a 32-bit xorshift whose steps have the full period, Marsaglia, "Xorshift RNGs", Journal of
   Statistical Software 8 (2003). The state is thread-local. 0, the initial value of local memory, means the seed 1. */
#include <stdint.h>
#include <stdlib.h>

static _Thread_local uint32_t state;

void srand(unsigned seed) {
  state = seed * 2654435761u;
}

int rand_r(unsigned *seed) {
  uint32_t x = *seed ? *seed : 2654435761u;
  x ^= x << 13;
  x ^= x >> 17;
  x ^= x << 5;
  *seed = x;
  return (int)(x >> 1);
}

int rand(void) {
  return rand_r(&state);
}
