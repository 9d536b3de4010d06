// RUN: %run_c %s %t --cflags "-Wno-unknown-pragmas"
// RUN: %run_c %s %t --levels -O1 --cflags "-ffp-model=strict -Xclang -fexperimental-strict-floating-point"
// __builtin_canonicalize keeps numbers and makes signalling NaNs quiet; comparisons also where flags are observed. (Expected output by hand.)
#include <stdio.h>
#include <string.h>

static unsigned bits(float x) {
  unsigned b;
  memcpy(&b, &x, 4);
  return b;
}

int main(void) {
  volatile unsigned long long doubles[] = {0x8000000000000000, 1, 0x3ff8000000000000, 0x7ff0000000000000};
  volatile unsigned floats[] = {0x80000000, 1, 0x3fc00000, 0x7f800000}, signalling = 0x7fa00000;
  for (int i = 0; i < 4; i++) {
    float f;
    double d;
    memcpy(&f, (void *)&floats[i], 4);
    memcpy(&d, (void *)&doubles[i], 8);
    d = __builtin_canonicalize(d);
    unsigned long long b;
    memcpy(&b, &d, 8);
    printf("%x %llx %d%d%d%d\n", bits(__builtin_canonicalizef(f)), b, f < 1, f >= 1, d < 1, d == 1.5);
  }
  float f;
  memcpy(&f, (void *)&signalling, 4);
  printf("%x\n", bits(__builtin_canonicalizef(f)) >> 22 & 0x1ff);
  return 0;
}
