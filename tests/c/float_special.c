// RUN: %run_c %s %t
// NaN, infinities and signed zeros: classification, comparison, minimum and maximum.
#include <math.h>
#include <stdio.h>

static volatile float values[] = {0.0f, -0.0f, 1.0f, -2.5f, 1e-40f, INFINITY, -INFINITY, NAN};

__attribute__((noinline)) static void pair(float a, float b) {
  printf("%d%d%d%d%d%d ", a<b, a <= b, a> b, a >= b, a == b, a != b);
  printf("%d%d%d%d ", isless(a, b), islessgreater(a, b), isunordered(a, b), !(a < b));
  if (a != b || a != 0) /* which zero the lesser is, C leaves open */
    printf("%g %g", (double)fminf(a, b), (double)fmaxf(a, b));
  puts("");
}

int main(void) {
  for (int i = 0; i < 8; i++) {
    float x = values[i];
    printf("%d%d%d%d %d\n", !!isnan(x), !!isinf(x), !!isfinite(x), !!isnormal(x), !!signbit(x) && x == x);
    for (int j = 0; j < 8; j++)
      pair(x, values[j]);
  }
  volatile float huge = 3e38f, tiny = 1e-45f;
  printf("%g %g %g\n", (double)(huge * 10), (double)(tiny / 4), (double)(tiny * 3));
  return 0;
}
