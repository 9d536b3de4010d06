// RUN: %run_c %s %t
// Loops and selections that depend on float comparisons.
#include <stdio.h>

__attribute__((noinline)) static int steps(float x) {
  int n = 0;
  while (x > 1.0f && n < 200) {
    x = x < 1e10f ? x * 0.5f : x * 0.25f;
    n++;
  }
  return n;
}

__attribute__((noinline)) static float clamp(float x, float low, float high) {
  return x < low ? low : x > high ? high : x;
}

__attribute__((noinline)) static int classify(float x) {
  if (x == 0)
    return 0;
  if (!(x < 0) && !(x > 0))
    return 3;
  return x < 0 ? 1 : 2;
}

int main(void) {
  volatile float x = 12345.678f, nan = 0.0f;
  nan = nan / nan;
  printf("%d %d %d\n", steps(x), steps(x * 1e20f), steps(nan));
  printf("%g %g %g\n", (double)clamp(x, 0, 1), (double)clamp(-x, 0, 1), (double)clamp(0.5f, 0, 1));
  printf("%d %d %d %d\n", classify(0), classify(-x), classify(x), classify(nan));
  return 0;
}
