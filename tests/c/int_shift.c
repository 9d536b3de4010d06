// RUN: %run_c %s %t
// Shifts by constants and variables, and rotations.
#include <stdio.h>

static volatile unsigned values[] = {0, 1, 0x80000000, 0xFFFFFFFF, 0x12345678, 0xF0F0F0F0};

__attribute__((noinline)) static unsigned rotate_left(unsigned x, unsigned n) {
  return x << (n & 31) | x >> (-n & 31);
}

int main(void) {
  for (int i = 0; i < 6; i++) {
    unsigned x = values[i];
    unsigned hash = 0;
    for (unsigned n = 0; n < 32; n++) {
      hash = hash * 33 + (x << n);
      hash = hash * 33 + (x >> n);
      hash = hash * 33 + (unsigned)((int)x >> n);
      hash = hash * 33 + rotate_left(x, n);
    }
    printf("%08x %08x %08x %08x %08x\n", hash, x << 5, x >> 31, (unsigned)((int)x >> 31), rotate_left(x, 13));
  }
  return 0;
}
