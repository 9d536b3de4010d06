// DEFINE: %{run} = %trax_sim --set special.precision_bits
// RUN: %clang -O2 %s -o %t && %{run}=24 %t 24 > %t.24
// RUN: %{run}=23 %t 23 | cmp %t.24 -
// RUN: %{run}=21 %t 21 | cmp %t.24 -
// RUN: %{run}=16 %t 16 | cmp %t.24 -
// RUN: %{run}=8 %t 8 | cmp %t.24 -
// RUN: %{run}=3 %t 3 | cmp %t.24 -
// RUN: %{run}=1 %t 1 | cmp %t.24 -
// A less precise special unit: sqrtf and normalised vectors are as good as the unit, and functions that correct its
// results do not depend on it. The status is 1 if a root is wrong, 2 if a length is.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <trax.h>

enum { COUNT = 512 };

static float draw(float low, float high) {
  static unsigned state = 1;
  state = state * 1664525u + 1013904223u;
  return low + (high - low) * ((float)(state >> 8) * 0x1p-24f);
}

static unsigned hash = 2166136261u;

static void add(double value) {
  float head = (float)value, tail = (float)(value - (double)head); /* the tail shows the bits of a binary64 function */
  unsigned bits[2];
  memcpy(&bits[0], &head, sizeof head);
  memcpy(&bits[1], &tail, sizeof tail);
  hash = ((hash ^ bits[0]) * 16777619u ^ bits[1]) * 16777619u;
}

int main(int count, char **arguments) {
  const int b = count > 1 ? atoi(arguments[1]) : 24;
  for (int i = 0; i < COUNT; i++) {
    float x = draw(1, 4), y = draw(-1, 1), z = draw(-1, 1);
    const double exact = sqrt((double)x);
    /* A root is up to twice the reciprocal's last place. */
    if (fabs((double)sqrtf(x) - exact) > (b == 24 ? 0.5 : ldexp(1, 24 - b) + 1) * ldexp(1, ilogb(exact) - 23))
      return 1;
    const float inverse = trax_rsqrt(x * x + y * y + z * z);
    const float a = x * inverse, d = y * inverse, e = z * inverse;
    if (fabs(sqrt((double)(a * a + d * d + e * e)) - 1) > ldexp(1, -b) + 0x1p-22)
      return 2;
    if (i % 8)
      continue;
    add(hypotf(y, z)), add(asinf(y)), add(acosf(z)), add(asinhf(x)), add(acoshf(x)), add(expm1f(y)), add(log1pf(z));
    add(exact);
  }
  printf("%08x\n", hash);
}
