/* Fixed-point arithmetic of the binary32 functions.

   A float has 24 bits, a word 32, and the machine multiplies words as fast as floats. So the functions compute a
   significand of 31 or 32 bits with integers and round it once: errors stay within some hundredths of a unit in the
   last place beyond the half that rounding costs, without any double-length floating point. Numbers are written "Qn":
   the value is the integer times 2^-n. */
#ifndef TRAX_RUNTIME_FIXED_H
#define TRAX_RUNTIME_FIXED_H

#include "../internal/bits.h"
#include "../internal/divide.h"

#ifdef __trax__
INLINE float reciprocal_sqrt(float x) {
  return __builtin_trax_rsqrt(x);
}
#else
INLINE float reciprocal_sqrt(float x) {
  return (float)(1 / __builtin_sqrt((double)x));
}
#endif

/* A positive number: significand * 2^exponent, the significand's top bit set. */
struct normal {
  uint32_t significand;
  int exponent;
};

/* A finite float's magnitude, not 0. */
INLINE struct normal take_apart(uint32_t bits) {
  uint32_t magnitude = bits & ~FLOAT_SIGN;
  if (magnitude >= 0x00800000)
    return (struct normal){magnitude << 8 | FLOAT_SIGN, (int)(magnitude >> 23) - 127 - 31};
  int zeros = leading_zeros(magnitude);
  return (struct normal){magnitude << zeros, -149 - zeros};
}

/* significand * 2^exponent, rounded; sign in bit 31. The significand may have leading zeros, but not be 0. Converting
   it rounds; then the exponent needs only an addition, unless the result is subnormal or too great. */
INLINE float make_float(uint32_t sign_bit, uint32_t significand, int exponent) {
  uint32_t bits = float_bits((float)significand);
  if ((unsigned)((int)(bits >> 23) + exponent - 1) < 254)
    return bits_float((bits + ((uint32_t)exponent << 23)) | sign_bit);
  int zeros = leading_zeros(significand);
  return trax_round_float(sign_bit >> 31, exponent + 127 + 31 - zeros, significand << zeros);
}

/* The same from a longer significand, Q64 and not 0; the bits below the upper 32 leading ones are cut off. */
INLINE float make_float64(uint32_t sign_bit, uint64_t significand, int exponent) {
  int zeros = leading_zeros64(significand);
  return make_float(sign_bit, high_word(significand << zeros), exponent + 32 - zeros);
}

/* n / d of two significands with their top bits set, Q31; less than 2, more than 1/2. */
INLINE uint32_t quotient_q31(uint32_t n, uint32_t d) {
  return divide_2by1(n >> 1, n << 31, d, reciprocal_2by1(d)).quotient;
}

/* floor(a * b / 2^32). */
INLINE uint64_t mul_high_96(uint64_t a, uint32_t b) {
  return mul_wide(high_word(a), b) + mul_high(low_word(a), b);
}

/* x * 2^n cut off, for n from -95 to 31. */
INLINE uint32_t shifted(uint32_t x, int n) {
  return n >= 0 ? x << n : n > -32 ? x >> -n : 0;
}

/* The polynomial of count coefficients c[0] + c[1] x + ..., or with signs alternating from +; x is Q32. */
INLINE uint32_t polynomial(const uint32_t *c, int count, uint32_t x) {
  uint32_t p = c[count - 1];
  for (int i = count - 2; i >= 0; i--)
    p = c[i] + mul_high(p, x);
  return p;
}
INLINE uint32_t alternating_polynomial(const uint32_t *c, int count, uint32_t x) {
  uint32_t p = c[count - 1];
  for (int i = count - 2; i >= 0; i--)
    p = c[i] - mul_high(p, x);
  return p;
}

/* floor(sqrt(n)), n >= 2^62. */
uint32_t trax_sqrt64(uint64_t n);

/* 2^(t * 2^-32) with a sign. */
float trax_exp2_fixed(uint32_t sign_bit, int64_t t);

/* log2 of a positive finite float: value * 2^-scale. Near 1, where the logarithm is small, the scale is greater: the
   relative error stays below 2^-37. */
struct logarithm {
  int64_t value;
  int scale;
};
struct logarithm trax_log2_fixed(uint32_t bits);

#endif
