// RUN: %run_c %s %t
// Loads and stores of every width and sign at offsets, through pointers that may alias.
#include <stdint.h>
#include <stdio.h>

static _Alignas(8) unsigned char memory[64];

__attribute__((noinline)) static int64_t mix(unsigned char *base) {
  volatile int8_t *b = (volatile int8_t *)base + 3;
  volatile uint16_t *h = (volatile uint16_t *)(void *)(base + 6);
  volatile int32_t *w = (volatile int32_t *)(void *)(base + 12);
  volatile int64_t *d = (volatile int64_t *)(void *)(base + 24);
  b[-1] = -5;
  b[2] = (int8_t)(b[-1] * 3);
  h[0] = 0xFFFE;
  h[1] = (uint16_t)(h[0] + 5);
  w[0] = b[2] - h[1];
  w[1] = (int16_t)h[0];
  d[0] = (int64_t)((uint64_t)w[0] << 33 | (uint32_t)w[1]);
  d[1] = d[0] >> 7;
  return d[1] ^ b[2];
}

int main(void) {
  printf("%llx\n", (unsigned long long)mix(memory));
  unsigned hash = 0;
  for (int i = 0; i < 64; i++)
    hash = hash * 31 + memory[i];
  printf("%x\n", hash);
  return 0;
}
