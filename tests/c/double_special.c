// RUN: %run_c %s %t
// binary64 in software where it is delicate: ties, subnormals, overflow, cancellation, NaN, infinities, signed zeros.
#include <math.h>
#include <stdio.h>
#include <string.h>

static volatile double values[] = {
    0x1p-1074, 0x1.fffffffffffffp-1023, 0x1p-1022, 0x1.8p-1022, 1.0,       0x1.0000000000001p0,
    0x1p53,    0x1.fffffffffffffp1023,  -0.0,      INFINITY,    -INFINITY, NAN};
enum { COUNT = sizeof values / sizeof values[0] };

__attribute__((noinline)) static void show(double x) {
  unsigned long long u;
  memcpy(&u, &x, 8);
  printf("%llx ", x != x ? 0x7FF8000000000000ull : u);
}

__attribute__((noinline)) static void pair(double a, double b) {
  show(a + b);
  show(a - b);
  show(a * b);
  show(a / b);
  printf("%d%d%d%d%d\n", a < b, a <= b, a == b, isunordered(a, b), islessgreater(a, b));
}

__attribute__((noinline)) static void ties(void) {
  volatile double big = 0x1p53, one = 1, half = 0x1p-53;
  show(big + one);
  show(big + one + one + one);
  show(big + 3 * one);
  show(one + half);
  show(one + half * 1.0000001);
  show(one - half / 2);
  show(one - half / 2 * 1.5);
  puts("");
  show((float)(one + half));
  show((float)(one + 0x1p-24));
  show((float)(one + 0x1.8p-23));
  show((float)(0x1.fffffefp127 * one));
  show((float)(0x1.ffffffp127 * one));
  show((float)(0x1.4p-149 * one));
  show((float)(0x1p-150 * one));
  puts("");
}

__attribute__((noinline)) static void series(void) { /* long chains, in which one wrong rounding would show */
  double e = 1, term = 1, root = 2, chaos = 0.3;
  for (int i = 1; i < 20; i++)
    e += term /= i;
  for (int i = 0; i < 6; i++)
    root = (root + 2 / root) * 0.5;
  for (int i = 0; i < 50; i++)
    chaos = 3.75 * chaos * (1 - chaos);
  show(e);
  show(root);
  show(chaos);
  show(fmod(chaos * 1e10, 0.7));
  puts("");
}

int main(void) {
  for (int i = 0; i < COUNT; i++)
    for (int j = i; j < COUNT; j++) {
      pair(values[i], values[j]);
      if ((i + j) % 5 == 0)
        pair(-values[j], values[i]);
    }
  ties();
  series();
  return 0;
}
