// RUN: %run_c %s %t --turns -O0,-O2,-Os
// Fixed point: products and quotients by 64 bits, sine and cosine by shifts (CORDIC), saturation, half floats.
#include <stdint.h>
#include <stdio.h>
#include <string.h>

typedef int32_t fixed; /* 16 bits behind the point */

__attribute__((noinline)) static fixed multiply(fixed a, fixed b) {
  return (fixed)(((int64_t)a * b + 0x8000) >> 16);
}
__attribute__((noinline)) static fixed divide(fixed a, fixed b) {
  return (fixed)((int64_t)a * 65536 / b);
}
__attribute__((noinline)) static int16_t saturate(int32_t x) {
  return (int16_t)(x > 32767 ? 32767 : x < -32768 ? -32768 : x);
}

static const int32_t angles[16] = {51472, 30386, 16055, 8150, 4091, 2047, 1024, 512, 256, 128, 64, 32, 16, 8, 4, 2};

__attribute__((noinline)) static void rotate(fixed angle, fixed *cosine, fixed *sine) {
  int32_t x = 39797, y = 0;
  for (int i = 0; i < 16; i++) {
    int32_t dx = x >> i, dy = y >> i;
    if (angle >= 0)
      x -= dy, y += dx, angle -= angles[i];
    else
      x += dy, y -= dx, angle += angles[i];
  }
  *cosine = x;
  *sine = y;
}

__attribute__((noinline)) static uint16_t to_half(float f) { /* round to nearest even */
  uint32_t u;
  memcpy(&u, &f, 4);
  uint32_t sign = u >> 16 & 0x8000, a = u & 0x7FFFFFFF;
  if (a > 0x7F800000)
    return (uint16_t)(sign | 0x7E00);
  if (a >= 0x47800000)
    return (uint16_t)(sign | 0x7C00);
  if (a < 0x33000001)
    return (uint16_t)sign;
  uint32_t shift = 13, m = a & 0x7FFFFF;
  if (a < 0x38800000) {
    shift = 126 - (a >> 23);
    m |= 0x800000;
    a = 0;
  } else
    m += a - (112u << 23) - m;
  uint32_t h = m >> shift, rest = m & ((1u << shift) - 1), tie = 1u << (shift - 1);
  h += rest > tie || (rest == tie && h & 1);
  return (uint16_t)(sign | h);
}

int main(void) {
  static volatile float floats[] = {0, 1, -2.5f, 65504, 65520, 1e-7f, 6.1e-5f, 0.33333334f, 1e30f, 5.9604645e-8f};
  for (fixed a = -90000; a <= 90000; a += 45000) {
    fixed c, s;
    rotate(a, &c, &s);
    printf("%d %d %d ", c, s, multiply(c, c) + multiply(s, s));
    printf("%d %d %d\n", divide(a + 1, 3 << 16), divide(1 << 16, a + 7), saturate(a));
  }
  for (unsigned i = 0; i < sizeof floats / sizeof floats[0]; i++)
    printf("%04x ", to_half(floats[i]));
  puts("");
  return 0;
}
