/* Division of several words, by reciprocals. The compiler writes out what one word divides; these reciprocals come from
   multiplications alone and do not depend on the FPDIV unit's precision. */
#ifndef TRAX_RUNTIME_DIVIDE_H
#define TRAX_RUNTIME_DIVIDE_H

#include "bits.h"

/* 1/d * (1 - u) with 0 < u < 2^-11, for d >= 1. The subtraction from a constant turns the exponent round and the
   significand into a line through which y = d*r stays in [1.414, 1.458]; y * (c - y), c the sum of these limits, is
   then flat to 2^-12. The last factor is 4/c^2 and 2^-20 less, so that no rounding lifts the result above 1/d. */
INLINE float reciprocal_seed(uint32_t d) {
  float x = (float)d;
  float r = bits_float(0x7F350500u - float_bits(x));
  return r * (2.871324f - x * r) * 0.4851714f;
}

/* 2^32/d - 2 < result <= 2^32/d, for d >= 1 (tests/numerics checks every d). Each step of Newton's iteration z +=
   z*(2^32 - d*z)/2^32 squares the relative error and stays below. */
INLINE uint32_t reciprocal(uint32_t d) {
  uint32_t z = (uint32_t)(reciprocal_seed(d) * 0x1p32f);
  z += mul_high(z, 0 - d * z);
  z += mul_high(z, 0 - d * z);
  return z;
}

struct divided {
  uint32_t quotient, remainder;
};

/* Division of several words, after Moeller and Granlund, "Improved division by invariant integers", IEEE Transactions
   on Computers 60 (2011). Divisors are normalised: the top bit is set. */

/* 2^63/d - 6 < result <= 2^63/d, for d > 2^31; what is 2^32 for d = 2^31 may become 0. */
INLINE uint32_t reciprocal_q63(uint32_t d) {
  uint32_t x = (uint32_t)(reciprocal_seed(d) * 0x1p63f);
  x += mul_high(x, 0x7FFFFFFFu - mul_high(d, x)) << 1;
  x += mul_high(x, 0x7FFFFFFFu - mul_high(d, x)) << 1;
  return x;
}

/* floor((2^64 - 1) / d) - 2^32. */
INLINE uint32_t reciprocal_2by1(uint32_t d) {
  uint32_t x = reciprocal_q63(d);
  uint32_t v = x < 0x80000000u ? 0 : x << 1; /* without the leading 2^32, which 2^64/d exceeds for every d */
  uint64_t rest = ~(mul_wide(v, d) + ((uint64_t)d << 32));
  v += high_word(rest);
  rest -= mul_wide(high_word(rest), d);
  while (rest >= d) {
    rest -= d;
    v++;
  }
  return v;
}

/* (n1, n0) / d with n1 < d; v = reciprocal_2by1(d). */
INLINE struct divided divide_2by1(uint32_t n1, uint32_t n0, uint32_t d, uint32_t v) {
  uint64_t q = mul_wide(v, n1) + words(n1, n0);
  uint32_t q1 = high_word(q) + 1;
  uint32_t r = n0 - q1 * d;
  if (r > low_word(q)) {
    q1--;
    r += d;
  }
  if (r >= d) {
    r -= d;
    q1++;
  }
  return (struct divided){q1, r};
}

/* x / 10^9 for x < 10^9 * 2^32, through 4 * 10^9, whose top bit is set, and its reciprocal. */
INLINE struct divided divide_by_billion(uint64_t x) {
  x <<= 2;
  struct divided r = divide_2by1(high_word(x), low_word(x), 4000000000u, 0x12E0BE82);
  return (struct divided){r.quotient, r.remainder >> 2};
}

/* floor((2^96 - 1) / d) - 2^32. */
INLINE uint32_t reciprocal_3by2(uint64_t d) {
  uint32_t d1 = high_word(d), d0 = low_word(d);
  uint32_t v = reciprocal_2by1(d1);
  uint32_t p = d1 * v + d0;
  if (p < d0) {
    v--;
    if (p >= d1) {
      v--;
      p -= d1;
    }
    p -= d1;
  }
  uint64_t t = mul_wide(v, d0);
  p += high_word(t);
  if (p < high_word(t)) {
    v--;
    if (words(p, low_word(t)) >= d)
      v--;
  }
  return v;
}

struct divided_3by2 {
  uint64_t remainder;
  uint32_t quotient;
};

/* (n2, n1, n0) / d with (n2, n1) = high < d; v = reciprocal_3by2(d). */
INLINE struct divided_3by2 divide_3by2(uint64_t high, uint32_t n0, uint64_t d, uint32_t v) {
  uint64_t q = mul_wide(v, high_word(high)) + high;
  uint32_t q1 = high_word(q);
  uint32_t r1 = low_word(high) - q1 * high_word(d);
  uint64_t r = words(r1, n0) - mul_wide(low_word(d), q1) - d;
  q1++;
  if (high_word(r) >= low_word(q)) {
    q1--;
    r += d;
  }
  if (r >= d) {
    r -= d;
    q1++;
  }
  return (struct divided_3by2){r, q1};
}

#endif
