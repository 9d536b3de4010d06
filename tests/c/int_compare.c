// RUN: %run_c %s %t
// Every comparison, as a value and as a condition, and selections.
#include <stdio.h>

static volatile int values[] = {0, 1, -1, 5, 2147483647, -2147483647 - 1};

__attribute__((noinline)) static unsigned as_values(int a, int b) {
  unsigned x = (unsigned)a, y = (unsigned)b;
  return (unsigned)(a < b) | (unsigned)(a <= b) << 1 | (unsigned)(a > b) << 2 | (unsigned)(a >= b) << 3 |
         (unsigned)(a == b) << 4 | (unsigned)(a != b) << 5 | (unsigned)(x < y) << 6 | (unsigned)(x <= y) << 7 |
         (unsigned)(x > y) << 8 | (unsigned)(x >= y) << 9 | (unsigned)(a < 100) << 10 | (unsigned)(x < 100) << 11 |
         (unsigned)(a > -7) << 12;
}

__attribute__((noinline)) static int as_branches(int a, int b) {
  int n = 0;
  if (a < b)
    n += 1;
  if (a <= b)
    n += 2;
  if ((unsigned)a < (unsigned)b)
    n += 4;
  if ((unsigned)a >= (unsigned)b)
    n += 8;
  if (a == b && a)
    n += 16;
  if (a || b > 3)
    n += 32;
  return n;
}

__attribute__((noinline)) static int median(int a, int b, int c) {
  int low = a < b ? a : b, high = a < b ? b : a;
  return c < low ? low : c > high ? high : c;
}

int main(void) {
  for (int i = 0; i < 6; i++)
    for (int j = 0; j < 6; j++)
      printf("%x %d %d\n", as_values(values[i], values[j]), as_branches(values[i], values[j]),
             median(values[i], values[j], 3));
  return 0;
}
