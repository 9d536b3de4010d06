// RUN: %run_c %s %t
// More arguments than registers: words, pairs of words split between the last register and the stack, small structures.
#include <stdio.h>

struct three {
  int a, b, c;
};

__attribute__((noinline)) static int words(int a, int b, int c, int d, int e, int f, int g, int h, int i, int j,
                                           int k) {
  return a + 2 * b + 3 * c + 4 * d + 5 * e + 6 * f + 7 * g + 8 * h + 9 * i + 10 * j + 11 * k;
}
__attribute__((noinline)) static long long split(int a, int b, int c, int d, int e, int f, int g, long long l,
                                                 double x) {
  return a + b + c + d + e + f + g + l + (long long)(x * 4);
}
__attribute__((noinline)) static int structures(int a, struct three s, struct three t, struct three u, float f) {
  return a + s.a + 10 * s.b + 100 * s.c + t.a + 10 * t.b + 100 * t.c + 1000 * u.a + 10000 * u.b + 100000 * u.c + (int)f;
}
__attribute__((noinline)) static float floats(float a, float b, int c, float d, double e, float f, float g, float h,
                                              float i) {
  return a + b * 2 + (float)c + d * 3 + (float)e + f + g + h + i * 100;
}

int main(void) {
  printf("%d\n", words(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11));
  printf("%lld\n", split(1, 2, 3, 4, 5, 6, 7, 0x123456789ABCDEFll, 2.75));
  printf("%d\n", structures(7, (struct three){1, 2, 3}, (struct three){4, 5, 6}, (struct three){7, 8, 9}, 0.5f));
  printf("%g\n", (double)floats(1, 2, 3, 4, 5, 6, 7, 8, 9));
  return 0;
}
