/* The gamma function, in 64-bit fixed point: 1/gamma on [1, 2] is a polynomial, and the recurrence gamma(x + 1) = x
   gamma(x) leads there from everywhere, by at most 200 factors. Each costs less than 2^-63 of the product, so that the
   result is within some hundredths of a unit in the last place of correctly rounded. And lgamma's sign, which newlib's
   reentrant function returns. */
#include "../builtins/double.h"
#include "../internal/divide.h"
#include "coefficients.h"

#include <math.h>

/* significand * 2^(exponent - 63), the significand's top bit set. */
struct scaled {
  uint64_t significand;
  int exponent;
};

static uint64_t mul_high64(uint64_t a, uint64_t b) {
  uint64_t middle = mul_wide(high_word(a), low_word(b)) + mul_high(low_word(a), low_word(b));
  uint64_t other = mul_wide(low_word(a), high_word(b)) + low_word(middle);
  return mul_wide(high_word(a), high_word(b)) + high_word(middle) + high_word(other);
}

static int64_t mul_high64_signed(int64_t a, int64_t b) {
  uint64_t product = mul_high64((uint64_t)a, (uint64_t)b);
  return (int64_t)(product - (a < 0 ? (uint64_t)b : 0) - (b < 0 ? (uint64_t)a : 0));
}

static struct scaled normalised(uint64_t significand, int exponent) {
  int zeros = leading_zeros64(significand);
  return (struct scaled){significand << zeros, exponent - zeros};
}

static struct scaled times(struct scaled a, struct scaled b) {
  return normalised(mul_high64(a.significand, b.significand), a.exponent + b.exponent + 1);
}

/* The product of a and n + f * 2^-64 for n from 0 to 255. */
static struct scaled times_mixed(struct scaled a, unsigned n, uint64_t f) {
  uint64_t fraction = mul_high64(a.significand, f);
  uint64_t low = mul_wide(low_word(a.significand), n) + low_word(fraction);
  uint64_t high = mul_wide(high_word(a.significand), n) + high_word(fraction) + high_word(low);
  uint32_t over = high_word(high);
  uint64_t rest = words(low_word(high), low_word(low));
  if (over == 0)
    return normalised(rest, a.exponent);
  int shift = 32 - leading_zeros(over);
  return (struct scaled){(uint64_t)over << (64 - shift) | rest >> shift, a.exponent + shift};
}

/* 1 / gamma(1 + f * 2^-64). */
static struct scaled gamma_inverse(uint64_t f) {
  int64_t t = (int64_t)(f ^ DOUBLE_SIGN); /* f - 1/2 */
  int64_t p = 0;
  for (int i = 17; i >= 0; i--)
    p = gamma_inverse_coefficients[i] + mul_high64_signed(p, t);
  return normalised((uint64_t)p, 1);
}

/* n / d, or 1 / d if n is not given, rounded to a double. */
static double quotient(uint32_t sign, struct scaled n, struct scaled d) {
  uint32_t v = reciprocal_3by2(d.significand);
  struct divided_3by2 first = divide_3by2(n.significand >> 1, (uint32_t)n.significand << 31, d.significand, v);
  struct divided_3by2 second = divide_3by2(first.remainder, 0, d.significand, v);
  uint64_t q = words(first.quotient, second.quotient); /* of n / 2d: bit 63 or 62 leads */
  int exponent = n.exponent - d.exponent + 1023;
  int carry = (int)(q >> 63);
  q = carry ? q >> 1 | (q & 1) : q;
  return trax_round_double(sign, exponent - 1 + carry, q | (second.remainder != 0));
}

static const struct scaled one = {DOUBLE_SIGN, 0};

/* significand * 2^(exponent - 63) from 1 to 256: the polynomial, and the factors from x - 1 down. */
static double gamma_above_1(uint64_t significand, int exponent) {
  unsigned n = (unsigned)(significand >> (63 - exponent));
  uint64_t f = significand << (exponent + 1);
  struct scaled product = one;
  for (unsigned i = 1; i < n; i++)
    product = times_mixed(product, i, f);
  return quotient(0, product, gamma_inverse(f));
}

double tgamma(double x) {
  uint64_t bits = double_bits(x), m = double_magnitude(bits);
  uint32_t sign = double_sign(bits);
  if (m >= DOUBLE_INFINITY)
    return sign || m > DOUBLE_INFINITY ? bits_double(DOUBLE_NAN) : x;
  int exponent = double_exponent(m) - 1023;
  if (exponent < -60) /* also 0 */
    return 1 / x;
  uint64_t significand = ((m & FRACTION_MASK) | HIDDEN_BIT) << 11; /* |x| = significand * 2^(exponent - 63) */
  struct scaled magnitude = {significand, exponent};
  if (!sign && exponent >= 8)
    return HUGE_VAL;
  if (!sign && exponent >= 0)
    return gamma_above_1(significand, exponent);
  if (!sign) /* gamma(1 + x) / x */
    return quotient(0, one, times(gamma_inverse(significand >> -(exponent + 1)), magnitude));
  /* x = f - n, f from 0 to 1: gamma(1 + f) / (x (x + 1) ... f). */
  if (exponent >= 52 || (exponent >= 0 && significand << (exponent + 1) == 0))
    return bits_double(DOUBLE_NAN); /* a negative integer */
  uint64_t below = exponent >= 0 ? significand << (exponent + 1) : significand >> -(exponent + 1); /* 1 - f */
  unsigned n = exponent >= 0 ? (unsigned)(significand >> (63 - exponent)) + 1 : 1;
  if (exponent >= 8)
    return bits_double((uint64_t)((significand >> (63 - exponent)) + 1) << 63);
  uint64_t f = 0 - below;
  struct scaled product = times(gamma_inverse(f), normalised(f, -1));
  if (n == 1)
    product = times(product, magnitude);
  else
    product = times(product, normalised(below, -1));
  for (unsigned i = 1; i < n; i++)
    product = times_mixed(product, i, below);
  return quotient(n & 1, one, product);
}

float tgammaf(float x) {
  return (float)tgamma((double)x);
}

_Thread_local int signgam;

double lgamma(double x) {
  return lgamma_r(x, &signgam);
}

/* In binary64: newlib's function of binary32 overflows on the way, and is far off near its zeros. */
float lgammaf_r(float x, int *sign) {
  return (float)lgamma_r((double)x, sign);
}

float lgammaf(float x) {
  return lgammaf_r(x, &signgam);
}
