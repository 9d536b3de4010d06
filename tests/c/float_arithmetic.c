// RUN: %run_c %s %t
// binary32 arithmetic to the bit, subnormals and rounding included.
#include <stdio.h>
#include <string.h>

static volatile float values[] = {0.0f,   -0.0f,  1.0f,  -1.5f,       3.0f,       0.1f,
                                  1e-38f, 1e-45f, 3e38f, 16777216.0f, 1.00000012f};
enum { COUNT = sizeof values / sizeof values[0] };

static unsigned bits(float x) {
  unsigned u;
  memcpy(&u, &x, 4);
  return x != x ? 0x7FC00000 : u;
}

__attribute__((noinline)) static void pair(float a, float b) {
  printf("%08x %08x %08x %08x %08x\n", bits(a + b), bits(a - b), bits(a * b), bits(a / b), bits(-a));
}

int main(void) {
  for (int i = 0; i < COUNT; i++)
    for (int j = 0; j < COUNT; j++)
      pair(values[i], values[j]);
  float sum = 0;
  for (int i = 1; i <= 1000; i++)
    sum += 1.0f / (float)i;
  printf("%08x\n", bits(sum));
  return 0;
}
