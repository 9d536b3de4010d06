// RUN: %run_c %s %t --turns -O0,-O2,-Os
// The ChaCha20 block function (RFC 8439, 2.3.2) on its test vector: sixteen words that stay in registers.
#include <stdint.h>
#include <stdio.h>

static uint32_t input[16] = {0x61707865, 0x3320646e, 0x79622d32, 0x6b206574}, output[16];

#define ROTATE(x, n) ((x) << (n) | (x) >> (32 - (n)))
#define QUARTER(a, b, c, d)                                                                                            \
  a += b, d = ROTATE(d ^ a, 16), c += d, b = ROTATE(b ^ c, 12), a += b, d = ROTATE(d ^ a, 8), c += d,                  \
          b = ROTATE(b ^ c, 7)

__attribute__((noinline)) static void block(void) {
  uint32_t a = input[0], b = input[1], c = input[2], d = input[3], e = input[4], f = input[5], g = input[6];
  uint32_t h = input[7], i = input[8], j = input[9], k = input[10], l = input[11], m = input[12], n = input[13];
  uint32_t o = input[14], p = input[15];
  for (int round = 0; round < 10; round++) {
    QUARTER(a, e, i, m), QUARTER(b, f, j, n), QUARTER(c, g, k, o), QUARTER(d, h, l, p);
    QUARTER(a, f, k, p), QUARTER(b, g, l, m), QUARTER(c, h, i, n), QUARTER(d, e, j, o);
  }
  const uint32_t x[16] = {a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p};
  for (int w = 0; w < 16; w++)
    output[w] = x[w] + input[w];
}

int main(void) {
  for (uint32_t w = 0; w < 8; w++)
    input[4 + w] = w * 0x04040404 + 0x03020100;
  input[12] = 1;
  input[13] = 0x09000000;
  input[14] = 0x4a000000;
  block();
  for (int w = 0; w < 16; w++)
    printf("%08x%c", (unsigned)output[w], w % 4 == 3 ? '\n' : ' ');
  input[12] = 0xFFFFFFFF;
  block();
  printf("%08x %08x\n", (unsigned)output[0], (unsigned)output[15]);
  return 0;
}
