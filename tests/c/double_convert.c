// RUN: %run_c %s %t
// Conversions from and to binary64.
#include <stdio.h>
#include <string.h>

static volatile double doubles[] = {0.0,           0.99, -0.99,          1.5,  -2.5, 1e9, 4294967295.0,
                                    -2147483648.0, 1e15, 1.17549435e-38, 1e-45};
static volatile int ints[] = {0, 1, -1, 123456789, 2147483647, -2147483647 - 1};

__attribute__((noinline)) static unsigned long long bits(double x) {
  unsigned long long u;
  memcpy(&u, &x, 8);
  return u;
}
__attribute__((noinline)) static unsigned float_bits(float x) {
  unsigned u;
  memcpy(&u, &x, 4);
  return u;
}

int main(void) {
  for (int i = 0; i < 11; i++) {
    double x = doubles[i];
    printf("%lld %08x %llx ", (long long)x, float_bits((float)x), bits((double)(float)x));
    if (x >= 0)
      printf("%llu ", (unsigned long long)x);
    if (x < 2e9 && x > -2.2e9)
      printf("%d", (int)x);
    puts("");
  }
  for (int i = 0; i < 6; i++) {
    int n = ints[i];
    printf("%llx %llx ", bits(n), bits((unsigned)n));
    printf("%llx %llx\n", bits((double)(long long)((unsigned long long)n * 9876543210ull)), bits((double)~(unsigned long long)(unsigned)n));
  }
  return 0;
}
