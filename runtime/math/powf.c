/* powf: 2^(y log2 x), the logarithm with 63 bits. */
#include "fixed.h"

#include <math.h>

/* 0: not an integer; 1: odd; 2: even. y is finite and not 0. */
static int parity(uint32_t y) {
  int exponent = (int)(y >> 23 & 0xFF) - 127;
  if (exponent < 0)
    return 0;
  if (exponent > 23)
    return 2;
  uint32_t significand = (y & 0x007FFFFF) | 0x00800000;
  if (significand << 8 << (exponent + 1)) /* digits after the point; the others are shifted out */
    return 0;
  return significand >> (23 - exponent) & 1 ? 1 : 2;
}

/* x or y is 0, infinite or a NaN, or x is 1. */
static float extreme(uint32_t x, uint32_t y) {
  uint32_t ax = x & ~FLOAT_SIGN, ay = y & ~FLOAT_SIGN;
  if (ay == 0 || x == 0x3F800000)
    return 1;
  if (ax > FLOAT_INFINITY || ay > FLOAT_INFINITY)
    return bits_float(FLOAT_NAN);
  if (ay == FLOAT_INFINITY) {
    if (ax == 0x3F800000)
      return 1;
    return bits_float((ax > 0x3F800000) == !(y >> 31) ? FLOAT_INFINITY : 0);
  }
  uint32_t sign_bit = parity(y) == 1 ? x & FLOAT_SIGN : 0;
  return bits_float(sign_bit | ((ax != 0) == !(y >> 31) ? FLOAT_INFINITY : 0));
}

float powf(float x, float y) {
  uint32_t bits = float_bits(x), y_bits = float_bits(y);
  uint32_t ax = bits & ~FLOAT_SIGN, ay = y_bits & ~FLOAT_SIGN;
  if (ax - 1 >= FLOAT_INFINITY - 1 || ay - 1 >= FLOAT_INFINITY - 1 || bits == 0x3F800000)
    return extreme(bits, y_bits);
  uint32_t sign_bit = 0;
  if (bits >> 31) {
    int y_parity = parity(y_bits);
    if (y_parity == 0)
      return bits_float(FLOAT_NAN);
    sign_bit = (uint32_t)y_parity << 31; /* 2 vanishes */
  }
  struct logarithm l = trax_log2_fixed(ax);
  if (l.value == 0)
    return bits_float(sign_bit | 0x3F800000);
  int negative = (l.value < 0) != (y_bits >> 31);
  uint64_t magnitude = (uint64_t)(l.value < 0 ? -l.value : l.value);
  int zeros = leading_zeros64(magnitude);
  struct normal factor = take_apart(y_bits);
  uint64_t product = mul_high_96(magnitude << zeros, factor.significand); /* at least 2^62 */
  int right = l.scale + zeros - 64 - factor.exponent;                     /* to Q32 */
  int64_t t;
  if (right < 20) /* at least 2^10 */
    t = (int64_t)1 << 42;
  else
    t = right > 63 ? 0 : (int64_t)(product >> right);
  return trax_exp2_fixed(sign_bit, negative ? -t : t);
}
