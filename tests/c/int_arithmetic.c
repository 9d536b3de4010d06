// RUN: %run_c %s %t
// Sums, products and logic, with the constants that need one instruction, two, or none.
#include <stdio.h>

static volatile int values[] = {0, 1, -1, 7, -13, 32767, -32768, 65536, 123456789, -2147483647 - 1, 2147483647};
enum { COUNT = sizeof values / sizeof values[0] };

__attribute__((noinline)) static void constants(unsigned x) {
  printf("%x %x %x %x %x\n", x + 1, x + 32767, x + 32768, x - 32768, x - 32769);
  printf("%x %x %x %x\n", x & 0xFF, x | 0x8000, x ^ 0xFFFF0000u, x & 0x80000000u);
  printf("%x %x %x %x %x\n", x * 3, x * 10, x * 255, x * 65537, x * 0x12345678u);
}

__attribute__((noinline)) static void operations(int a, int b) {
  unsigned x = (unsigned)a, y = (unsigned)b;
  printf("%x %x %x %x %x %x\n", x + y, x - y, x * y, x & y, x | y, x ^ y);
  printf("%x %x %d %d\n", -x, ~x, !a, a ? 1 : 0);
}

int main(void) {
  for (int i = 0; i < COUNT; i++) {
    constants((unsigned)values[i]);
    for (int j = 0; j < COUNT; j++)
      operations(values[i], values[j]);
  }
  return 0;
}
