// RUN: %run_c %s %t
// The mathematical functions on the machine. Exact ones to the bit; the others to the digits that any good library
// agrees in. tests/numerics measures their errors.
#include <math.h>
#include <stdio.h>
#include <string.h>

static volatile float values[] = {0.0f, 0.5f, 1.0f, -1.0f, 2.0f, 0.1f, -3.75f, 10.0f, 100.5f, 1e-3f, 12345.678f};

__attribute__((noinline)) static unsigned bits(float x) {
  unsigned u;
  memcpy(&u, &x, 4);
  return x != x ? 0x7FC00000 : u;
}

__attribute__((noinline)) static void show(const char *name, float x) {
  printf("%s %.5g\n", name, (double)x);
}

__attribute__((noinline)) static void exact(float x) {
  printf("%08x %08x %08x %08x\n", bits(sqrtf(x)), bits(floorf(x)), bits(ceilf(x)), bits(truncf(x)));
  printf("%08x %08x %08x %08x\n", bits(roundf(x)), bits(rintf(x)), bits(fabsf(x)), bits(fmodf(x, 0.3f)));
}

__attribute__((noinline)) static void inexact(float x) {
  show("sin", sinf(x));
  show("cos", cosf(x));
  show("tan", tanf(x));
  show("atan", atanf(x));
  show("atan2", atan2f(x, -2.0f));
  show("hypot", hypotf(x, 3.0f));
  if (x < 80) {
    show("exp", expf(x));
    show("exp2", exp2f(x));
  }
  if (x > 0) {
    show("log", logf(x));
    show("log2", log2f(x));
    show("log10", log10f(x));
    show("pow", powf(x, 1.7f));
  }
  if (x >= -1 && x <= 1) {
    show("asin", asinf(x));
    show("acos", acosf(x));
  }
}

int main(void) {
  for (int i = 0; i < 11; i++) {
    exact(values[i]);
    inexact(values[i]);
  }
  volatile double x = 2.0, y = -2.5;
  printf("%.17g %g %g %g\n", sqrt(x), floor(y), ceil(y), round(y));
  return 0;
}
