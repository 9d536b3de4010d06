// RUN: %run_c %s %t
// Bits: reversal, Morton order, Gray code, permutations, roots and logarithms by shifts, floats by their words.
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static volatile uint32_t seeds[] = {0, 1, 0xFFFFFFFF, 0x80000001, 0x12345678, 0xDEADBEEF};

__attribute__((noinline)) static uint32_t reverse(uint32_t x) {
  x = (x >> 1 & 0x55555555) | (x & 0x55555555) << 1;
  x = (x >> 2 & 0x33333333) | (x & 0x33333333) << 2;
  x = (x >> 4 & 0x0F0F0F0F) | (x & 0x0F0F0F0F) << 4;
  return x >> 24 | (x >> 8 & 0xFF00) | (x & 0xFF00) << 8 | x << 24;
}
__attribute__((noinline)) static uint32_t spread(uint32_t x) { /* ten bits, two zeros between each */
  x &= 0x3FF;
  x = (x | x << 16) & 0x030000FF;
  x = (x | x << 8) & 0x0300F00F;
  x = (x | x << 4) & 0x030C30C3;
  return (x | x << 2) & 0x09249249;
}
__attribute__((noinline)) static uint32_t compact(uint32_t x) {
  x &= 0x09249249;
  x = (x | x >> 2) & 0x030C30C3;
  x = (x | x >> 4) & 0x0300F00F;
  x = (x | x >> 8) & 0x030000FF;
  return (x | x >> 16) & 0x3FF;
}
__attribute__((noinline)) static uint32_t from_gray(uint32_t g) {
  for (int s = 1; s < 32; s *= 2)
    g ^= g >> s;
  return g;
}
__attribute__((noinline)) static uint32_t next_subset(uint32_t x) { /* the next greater with as many ones */
  uint32_t low = x & -x, ripple = x + low;
  return ripple | ((x ^ ripple) / low) >> 2;
}
__attribute__((noinline)) static uint32_t root(uint32_t x) {
  uint32_t r = 0;
  for (uint32_t bit = 1u << 30; bit; bit >>= 2) {
    if (x >= r + bit) {
      x -= r + bit;
      r += bit << 1;
    }
    r >>= 1;
  }
  return r;
}
__attribute__((noinline)) static int logarithm(uint64_t x) {
  int n = -1;
  for (; x; x >>= 1)
    n++;
  return n;
}
__attribute__((noinline)) static int average(int a, int b) {
  return (a & b) + ((a ^ b) >> 1);
}
__attribute__((noinline)) static int absolute_difference(int a, int b) {
  unsigned d = (unsigned)a - (unsigned)b, mask = -(unsigned)(a < b);
  return (int)((d ^ mask) - mask);
}
__attribute__((noinline)) static uint32_t parallel_add(uint32_t a, uint32_t b) { /* four bytes, no carries between */
  return ((a & 0x7F7F7F7F) + (b & 0x7F7F7F7F)) ^ ((a ^ b) & 0x80808080);
}
__attribute__((noinline)) static int has_zero_byte(uint32_t x) {
  return ((x - 0x01010101) & ~x & 0x80808080) != 0;
}
__attribute__((noinline)) static float next_up(float x) {
  uint32_t u;
  memcpy(&u, &x, 4);
  u++;
  memcpy(&x, &u, 4);
  return x;
}

int main(void) {
  for (int i = 0; i < 6; i++) {
    uint32_t x = seeds[i], y = seeds[(i + 4) % 6];
    printf("%08x %08x %03x %08x\n", (unsigned)reverse(x), (unsigned)spread(x), (unsigned)compact(spread(x) << 1 >> 1),
           (unsigned)from_gray(x ^ x >> 1));
    printf("%u %d %d %08x %d\n", (unsigned)root(x), logarithm((uint64_t)x << 7), average((int)x, (int)y),
           (unsigned)parallel_add(x, y), has_zero_byte(x));
  }
  uint32_t subset = 7;
  for (int i = 0; i < 20; i++)
    subset = next_subset(subset);
  volatile float one = 1, tiny = 0;
  printf("%x %d %a %a\n", (unsigned)subset, absolute_difference(-2147483647, 100), (double)next_up(one),
         (double)next_up(tiny));
  return 0;
}
