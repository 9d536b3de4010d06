// RUN: %run_c %s %t
// Division and remainder by variables and by constants, signed and unsigned.
#include <stdio.h>

static volatile int values[] = {0, 1, -1, 2, 3, -3, 7, 10, 100, -1000, 65535, 65536, 16777217, -2147483647, 2147483647};
enum { COUNT = sizeof values / sizeof values[0] };

__attribute__((noinline)) static void by_constants(int a) {
  unsigned u = (unsigned)a;
  printf("%d %d %d %d %d %d\n", a / 2, a / 3, a / 7, a / 10, a / -16, a / 1000);
  printf("%d %d %d %d %d %d\n", a % 2, a % 3, a % 7, a % 10, a % -16, a % 1000);
  printf("%u %u %u %u %u\n", u / 3, u / 10, u / 641, u % 10, u % 255);
}

__attribute__((noinline)) static void by_variable(int a, int b) {
  printf("%d %d %u %u\n", a / b, a % b, (unsigned)a / (unsigned)b, (unsigned)a % (unsigned)b);
}

int main(void) {
  for (int i = 0; i < COUNT; i++) {
    by_constants(values[i]);
    for (int j = 1; j < COUNT; j++)
      by_variable(values[i], values[j]);
  }
  unsigned sum = 0, n = 4000000000u;
  for (unsigned d = 1; d < 3000; d += 7)
    sum = sum * 31 + n / d + n % d;
  printf("%x\n", sum);
  return 0;
}
