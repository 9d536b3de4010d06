/* asinhf, acoshf, atanhf and log1pf: small results by polynomials, others by logarithms of numbers of 32 bits. */
#include "coefficients.h"
#include "fixed.h"

#include <math.h>

/* (log2(1 + r) - r/ln 2) / -r^2, Q31, for r Q36 below 2^-5.9. */
static int32_t log2_tail(int32_t r) {
  int32_t p = (int32_t)log2_coefficients[5];
  for (int k = 4; k >= 0; k--)
    p = (int32_t)log2_coefficients[k] - (mul_high_signed(p, r) >> 4);
  return p;
}

/* log2 x, Q36, as in log2_fixed.c, but to 2^-35 only. */
static int64_t log2_of(struct normal x) {
  uint32_t i = ((x.significand >> 25 & 0x3F) + 1) >> 1;                    /* nearest 1 + i/32 */
  int32_t r = (int32_t)(mul_wide(x.significand, log2_reciprocal[i]) >> 4); /* m * c - 1, Q36: the 1 overflows */
  int32_t square = mul_high_signed(mul_high_signed(r, r), log2_tail(r)) >> 3;
  int32_t fraction = r + mul_high_signed(r, (int32_t)LOG2_E_LESS_1) - square;
  return (int64_t)(((uint64_t)(int64_t)(x.exponent + 31) << 36) + (log2_of_reciprocal[i] >> 19)) + fraction;
}

/* ln(x) / 2^halvings for x >= 3/2. */
static float logarithm(uint32_t sign_bit, struct normal x, int halvings) {
  uint64_t total = (uint64_t)log2_of(x);
  int zeros = leading_zeros(high_word(total)); /* at least log2(3/2) * 2^4, so 28 or less */
  uint32_t top = high_word(total) << zeros | low_word(total) >> (32 - zeros);
  return make_float(sign_bit, mul_high(top, LN_2 >> 32), 32 - zeros - 36 - halvings);
}

/* asinh s for s < 1/2. */
static float small_asinh(uint32_t sign_bit, struct normal s) {
  uint32_t fixed = shifted(s.significand, s.exponent + 32);
  uint32_t z = mul_high(fixed, fixed);
  uint32_t tail = mul_high(z, alternating_polynomial(asinh_coefficients, 7, z)); /* Q34 */
  return make_float(sign_bit, s.significand - (mul_high(s.significand, tail) >> 2), s.exponent);
}

/* The sum for 4 b > a >= b. */
static struct normal sum(struct normal a, struct normal b) {
  uint32_t significand = a.significand + (b.significand >> (a.exponent - b.exponent));
  if (significand >= a.significand)
    return (struct normal){significand, a.exponent};
  return (struct normal){significand >> 1 | FLOAT_SIGN, a.exponent + 1};
}

/* sqrt(square * 2^-60) * 2^exponent. */
static struct normal root(uint64_t square, int exponent) {
  int zeros = leading_zeros64(square) & ~1;
  return (struct normal){trax_sqrt64(square << zeros), exponent - 30 - zeros / 2};
}

/* (x / 2^exponent)^2, Q60, where exponent is that of x. */
static uint64_t square_of(struct normal x) {
  return mul_wide(x.significand >> 8, x.significand >> 8) << 14;
}

#define BEYOND 0x47800000u /* 2^16: x^2 + 1 and x^2 - 1 are x^2 to 32 bits */

float asinhf(float x) {
  uint32_t bits = float_bits(x), magnitude = bits & ~FLOAT_SIGN, sign_bit = bits & FLOAT_SIGN;
  if (magnitude < 0x39800000) /* 2^-12: x^3/6 is lost in rounding */
    return x;
  if (magnitude >= FLOAT_INFINITY)
    return x + x;
  struct normal n = take_apart(magnitude);
  if (magnitude < 0x3F000000)
    return small_asinh(sign_bit, n);
  if (magnitude >= BEYOND)
    return logarithm(sign_bit, (struct normal){n.significand, n.exponent + 1}, 0);
  int exponent = n.exponent + 31;
  return logarithm(sign_bit, sum(root(square_of(n) + ((uint64_t)1 << (60 - 2 * exponent)), exponent), n), 0);
}

float acoshf(float x) {
  uint32_t bits = float_bits(x);
  if (bits <= 0x3F800000 || bits >= FLOAT_INFINITY) /* up to 1, infinite, negative or a NaN */
    return bits == 0x3F800000 ? 0 : bits_float(bits == FLOAT_INFINITY ? FLOAT_INFINITY : FLOAT_NAN);
  struct normal n = take_apart(bits);
  if (bits >= BEYOND)
    return logarithm(0, (struct normal){n.significand, n.exponent + 1}, 0);
  int exponent = n.exponent + 31;
  struct normal s = root(square_of(n) - ((uint64_t)1 << (60 - 2 * exponent)), exponent); /* exact except for the root */
  if (s.exponent < -32)
    return small_asinh(0, s);
  return logarithm(0, sum(n, s), 0);
}

float atanhf(float x) {
  uint32_t bits = float_bits(x), magnitude = bits & ~FLOAT_SIGN, sign_bit = bits & FLOAT_SIGN;
  if (magnitude < 0x39800000)
    return x;
  if (magnitude >= 0x3F800000)
    return bits_float(magnitude == 0x3F800000 ? sign_bit | FLOAT_INFINITY : FLOAT_NAN);
  struct normal n = take_apart(magnitude);
  uint32_t fixed = shifted(n.significand, n.exponent + 32);
  if (magnitude < 0x3F000000) {
    uint32_t z = mul_high(fixed, fixed);
    uint32_t tail = mul_high(z, polynomial(atanh_coefficients, 8, z)); /* Q33 */
    return make_float(sign_bit, (n.significand >> 1) + (mul_high(n.significand, tail) >> 2), n.exponent + 1);
  }
  uint32_t below_one = 0 - fixed; /* 1 - x, exact */
  int zeros = leading_zeros(below_one);
  uint32_t q = quotient_q31(FLOAT_SIGN | fixed >> 1, below_one << zeros);
  int less = q >> 31 ? 0 : 1;
  return logarithm(sign_bit, (struct normal){q << less, zeros - 30 - less}, 1);
}

float log1pf(float x) {
  uint32_t bits = float_bits(x), magnitude = bits & ~FLOAT_SIGN, sign_bit = bits & FLOAT_SIGN;
  if (magnitude < 0x33000000) /* 2^-25: x^2/2 is lost in rounding */
    return x;
  if (bits >= 0xBF800000) /* -1 and less, and NaNs */
    return bits_float(bits == 0xBF800000 ? FLOAT_SIGN | FLOAT_INFINITY : FLOAT_NAN);
  if (bits - FLOAT_INFINITY < FLOAT_SIGN - FLOAT_INFINITY)
    return x + x;
  struct normal n = take_apart(magnitude), one = {FLOAT_SIGN, -31};
  if (magnitude < 0x3C800000) { /* 2^-6: x (1 - x P(x)) */
    uint32_t fixed = shifted(n.significand, n.exponent + 36);
    int32_t p = log2_tail((int32_t)(sign_bit ? 0 - fixed : fixed));
    uint32_t tail = mul_high(n.significand, mul_high(fixed, mul_high((uint32_t)p, LN_2 >> 32))); /* Q3 */
    if (sign_bit)
      return make_float(sign_bit, (n.significand >> 1) + (tail >> 4), n.exponent + 1);
    return make_float(sign_bit, n.significand - (tail >> 3), n.exponent);
  }
  struct normal w;
  if (sign_bit) {
    uint32_t below_one = 0 - shifted(n.significand, n.exponent + 32); /* exact */
    int zeros = leading_zeros(below_one);
    w = (struct normal){below_one << zeros, -32 - zeros};
  } else {
    struct normal a = magnitude < 0x3F800000 ? one : n, b = magnitude < 0x3F800000 ? n : one;
    uint32_t total = a.significand + shifted(b.significand, b.exponent - a.exponent);
    w = total >= a.significand ? (struct normal){total, a.exponent}
                               : (struct normal){total >> 1 | FLOAT_SIGN, a.exponent + 1};
  }
  int64_t log2 = log2_of(w);
  uint64_t total = (uint64_t)(sign_bit ? -log2 : log2);
  int zeros = leading_zeros64(total);
  return make_float(sign_bit, mul_high(high_word(total << zeros), LN_2 >> 32), 32 - zeros - 36);
}
