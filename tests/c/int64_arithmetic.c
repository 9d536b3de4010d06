// RUN: %run_c %s %t
// 64-bit sums, products, logic and comparisons from words.
#include <stdio.h>

static volatile long long values[] = {
    0, 1, -1, 0xFFFFFFFFll, 0x100000000ll, 0x123456789ABCDEFll, -0x7FFFFFFFFFFFFFFFll - 1};

__attribute__((noinline)) static void pair(long long a, long long b) {
  unsigned long long x = (unsigned long long)a, y = (unsigned long long)b;
  printf("%llx %llx %llx\n", x + y, x - y, x * y);
  printf("%llx %llx %llx %llx\n", x & y, x | ~y, x ^ y, -x);
  printf("%d%d%d%d%d%d%d%d\n", a<b, a <= b, a> b, a >= b, a == b, a != b, x < y, x >= y);
  printf("%llx %llx\n", x * (unsigned)b, (unsigned long long)((long long)(int)a * (int)b));
}

int main(void) {
  for (int i = 0; i < 7; i++)
    for (int j = 0; j < 7; j++)
      pair(values[i], values[j]);
  unsigned long long f = 0, g = 1;
  for (int i = 0; i < 90; i++) {
    unsigned long long t = f + g;
    f = g;
    g = t;
  }
  printf("%llu\n", f);
  return 0;
}
