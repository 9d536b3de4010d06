// RUN: %run_c %s %t --levels -O0,-O1,-O3,-Oz
// The Mandelbrot set in characters: in binary32, and in fixed point with 64-bit products.
#include <stdint.h>
#include <stdio.h>

__attribute__((noinline)) static int floating(float cx, float cy) {
  float x = 0, y = 0;
  int n = 0;
  for (; n < 30 && x * x + y * y < 4; n++) {
    float t = x * x - y * y + cx;
    y = 2 * x * y + cy;
    x = t;
  }
  return n;
}

static int32_t product(int32_t a, int32_t b) {
  return (int32_t)((int64_t)a * b >> 24);
}

__attribute__((noinline)) static int fixed(int32_t cx, int32_t cy) {
  int32_t x = 0, y = 0;
  int n = 0;
  for (; n < 30 && product(x, x) + product(y, y) < 4 << 24; n++) {
    int32_t t = product(x, x) - product(y, y) + cx;
    y = 2 * product(x, y) + cy;
    x = t;
  }
  return n;
}

int main(void) {
  int differing = 0;
  for (int j = 0; j < 9; j++) {
    for (int i = 0; i < 32; i++) {
      int n = floating(-2 + (float)i * 0.09375f, -1.125f + (float)j * 0.28125f);
      putchar(" .:-=+*#%@"[n / 3 > 9 ? 9 : n / 3]);
      differing += n != fixed((-64 + i * 3) * (1 << 19), (-36 + j * 9) * (1 << 19));
    }
    putchar('\n');
  }
  printf("%d\n", differing);
  return 0;
}
