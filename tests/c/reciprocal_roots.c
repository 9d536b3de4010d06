// RUN: %run_c %s %t --turns -O0,-O2
// The iSQRT unit and division to the bit, on significands of both exponent parities and at the ends.
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <trax.h>

static unsigned hash;

__attribute__((noinline)) static unsigned bits(float x) {
  unsigned u;
  memcpy(&u, &x, 4);
  return x != x ? 0x7FC00000 : u;
}

__attribute__((noinline)) static void add(float x) {
  hash = (hash ^ bits(x)) * 16777619;
}

int main(void) {
  static volatile float ends[] = {0x1p-149f, 0x1.fffffcp-127f, 0x1p-126f, 0x1.fffffep127f, 0x1.fffffep-1f, 1, INFINITY};
  for (unsigned i = 0; i < 7; i++)
    printf("%08x %08x %08x\n", bits(trax_rsqrt(ends[i])), bits(sqrtf(ends[i])), bits(1 / ends[i]));
  unsigned u = 0x3F800000;
  for (int i = 0; i < 600; i++, u += 27961) {
    float x;
    memcpy(&x, &u, 4);
    add(trax_rsqrt(x));
    add(1 / x);
    add(sqrtf(x));
    add(1 / sqrtf(x));
  }
  printf("%08x\n", hash);
  return 0;
}
