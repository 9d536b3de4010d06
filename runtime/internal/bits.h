/* Representations and word arithmetic that the runtime's files share. Everything here inlines to a few instructions. */
#ifndef TRAX_RUNTIME_BITS_H
#define TRAX_RUNTIME_BITS_H

#include <stdint.h>

#include "inline.h"

INLINE uint32_t float_bits(float x) {
  return ((union {
           float f;
           uint32_t u;
         }){.f = x})
      .u;
}
INLINE float bits_float(uint32_t u) {
  return ((union {
           uint32_t u;
           float f;
         }){.u = u})
      .f;
}
INLINE uint64_t double_bits(double x) {
  return ((union {
           double f;
           uint64_t u;
         }){.f = x})
      .u;
}
INLINE double bits_double(uint64_t u) {
  return ((union {
           uint64_t u;
           double f;
         }){.u = u})
      .f;
}

INLINE uint32_t high_word(uint64_t x) {
  return (uint32_t)(x >> 32);
}
INLINE uint32_t low_word(uint64_t x) {
  return (uint32_t)x;
}
INLINE uint64_t words(uint32_t high, uint32_t low) {
  return (uint64_t)high << 32 | low;
}
INLINE uint64_t mul_wide(uint32_t a, uint32_t b) {
  return (uint64_t)a * b;
}
INLINE uint32_t mul_high(uint32_t a, uint32_t b) {
  return (uint32_t)(((uint64_t)a * b) >> 32);
}
INLINE int32_t mul_high_signed(int32_t a, int32_t b) {
  return (int32_t)(((int64_t)a * b) >> 32);
}

/* Zeros above the top bit of v, which is not 0. The machine has no such instruction, but converting to float finds the
   exponent. Without the bit below the top one the conversion cannot round up to the next power of two. */
INLINE int leading_zeros(uint32_t v) {
  return 158 - (int)(float_bits((float)(v & ~(v >> 1))) >> 23);
}
INLINE int leading_zeros64(uint64_t v) {
  return high_word(v) ? leading_zeros(high_word(v)) : 32 + leading_zeros(low_word(v));
}

/* v / 2^n with the lowest bit set if anything but zeros was shifted out, so that rounding afterwards is still right. */
INLINE uint32_t shift_right_sticky(uint32_t v, unsigned n) {
  if (n == 0)
    return v;
  if (n > 31)
    return v != 0;
  return v >> n | (v << (32 - n) != 0);
}
INLINE uint64_t shift_right_sticky64(uint64_t v, unsigned n) {
  if (n == 0)
    return v;
  if (n > 63)
    return v != 0;
  return v >> n | (v << (64 - n) != 0);
}

#define FLOAT_SIGN 0x80000000u
#define FLOAT_INFINITY 0x7F800000u
#define FLOAT_NAN 0x7FC00000u
#define DOUBLE_SIGN 0x8000000000000000u
#define DOUBLE_INFINITY 0x7FF0000000000000u
#define DOUBLE_NAN 0x7FF8000000000000u

/* x, but the canonical NaN for any NaN: as arithmetic would give it. */
INLINE float canonical_float(float x) {
  return x == x ? x : bits_float(FLOAT_NAN);
}
INLINE double canonical_double(double x) {
  return (double_bits(x) & ~DOUBLE_SIGN) > DOUBLE_INFINITY ? bits_double(DOUBLE_NAN) : x;
}

/* The number significand * 2^(exponent - 127 - 31), rounded to nearest even, with the given sign bit; the significand
   has its top bit set. Underflow is gradual, overflow gives infinity. */
float trax_round_float(uint32_t sign, int exponent, uint32_t significand);

/* The number significand * 2^(exponent - 1023 - 62) in the same way; the significand has bit 62 set and bit 63 clear,
   or the exponent is at most 1 and it is less. */
double trax_round_double(uint32_t sign, int exponent, uint64_t significand);

#endif
