// RUN: %run_c %s %t
// Conversions between float and integers of every size.
#include <stdio.h>
#include <string.h>

static volatile float floats[] = {0.0f,     0.9f, -0.9f,       1.5f,          -2.5f,         255.7f,
                                  32767.0f, 1e6f, 16777217.0f, 2147483520.0f, -2147483648.0f};
static volatile int ints[] = {0, 1, -1, 16777217, 16777219, -33554433, 2147483647, -2147483647 - 1};

static unsigned bits(float x) {
  unsigned u;
  memcpy(&u, &x, 4);
  return u;
}

int main(void) {
  for (int i = 0; i < 11; i++) {
    float x = floats[i];
    printf("%d %lld ", (int)x, (long long)x);
    if (x >= 0)
      printf("%u %llu ", (unsigned)x, (unsigned long long)x);
    if (x < 100 && x > -100)
      printf("%d", (signed char)x);
    puts("");
  }
  for (int i = 0; i < 8; i++) {
    int n = ints[i];
    printf("%08x %08x %08x %08x\n", bits((float)n), bits((float)(unsigned)n), bits((float)((long long)n * 1234567)),
           bits((float)((unsigned long long)(unsigned)n << 21 | 1)));
  }
  volatile float big = 1e18f, ubig = 1.8e19f;
  printf("%lld %llu\n", (long long)big, (unsigned long long)ubig);
  return 0;
}
