// RUN: %run_c %s %t
// Complex products and quotients.
#include <stdio.h>

__attribute__((noinline)) static float _Complex iterate(float _Complex c, int n) {
  float _Complex z = 0;
  while (n--)
    z = z * z + c;
  return z;
}

__attribute__((noinline)) static void show(double x) {
  printf("%.5f ", x);
}

__attribute__((noinline)) static void singles(float re, float im) {
  float _Complex c = __builtin_complex(re, im), z = iterate(c, 20), q = c / (z + 2.0f);
  show((double)__real__ z);
  show((double)__imag__ z);
  show((double)__real__ q);
  show((double)__imag__ q);
}

__attribute__((noinline)) static void doubles(double re) {
  double _Complex d = __builtin_complex(3.0 * re, 4.0), e = d * d, f = e / d;
  show(__real__ e);
  show(__imag__ e);
  show(__real__ f);
  show(__imag__ f);
}

int main(void) {
  volatile float re = 0.25f, im = 0.5f;
  singles(re, im);
  doubles((double)re);
  puts("");
  return 0;
}
