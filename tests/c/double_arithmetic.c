// RUN: %run_c %s %t
// binary64 arithmetic in software, to the bit.
#include <stdio.h>
#include <string.h>

static volatile double values[] = {
    0.0, -0.0, 1.0, -1.5, 3.0, 0.1, 1e-308, 5e-324, 1e308, 9007199254740993.0, 1.0000000000000002};
enum { COUNT = sizeof values / sizeof values[0] };

__attribute__((noinline)) static unsigned long long bits(double x) {
  unsigned long long u;
  memcpy(&u, &x, 8);
  return x != x ? 0x7FF8000000000000ull : u;
}

__attribute__((noinline)) static void pair(double a, double b) {
  printf("%llx %llx ", bits(a + b), bits(a - b));
  printf("%llx %llx ", bits(a * b), bits(a / b));
  printf("%d%d%d%d%d%d\n", a<b, a <= b, a> b, a >= b, a == b, a != b);
}

int main(void) {
  for (int i = 0; i < COUNT; i++)
    for (int j = 0; j < COUNT; j++)
      pair(values[i], values[j]);
  double sum = 0;
  for (int i = 1; i <= 100; i++)
    sum += 1.0 / i;
  printf("%llx\n", bits(sum));
  return 0;
}
