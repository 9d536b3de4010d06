/* The gamma function, in 64-bit fixed point: 1/gamma on [1, 2] is a polynomial, and the recurrence gamma(x + 1) = x
   gamma(x) leads there from everywhere, by at most 200 factors. Each costs less than 2^-63 of the product, so that the
   result is within some hundredths of a unit in the last place of correctly rounded. */
#include "coefficients.h"
#include "scaled.h"

#include <math.h>

/* The product of a and n + f * 2^-64 for n from 0 to 255. */
static struct scaled times_mixed(struct scaled a, unsigned n, uint64_t f) {
  uint64_t fraction = trax_mul_high64(a.significand, f);
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
  return normalised((uint64_t)trax_signed_polynomial(gamma_inverse_coefficients, LENGTH(gamma_inverse_coefficients), t),
                    1);
}

static double quotient(uint32_t sign, struct scaled n, struct scaled d) {
  return scaled_to_double(sign, trax_quotient(n, d));
}

/* significand * 2^(exponent - 63) from 1 to 256: the polynomial, and the factors from x - 1 down. */
static double gamma_above_1(uint64_t significand, int exponent) {
  unsigned n = (unsigned)(significand >> (63 - exponent));
  uint64_t f = significand << (exponent + 1);
  struct scaled product = scaled_one;
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
    return quotient(0, scaled_one, trax_times(gamma_inverse(significand >> -(exponent + 1)), magnitude));
  /* x = f - n, f from 0 to 1: gamma(1 + f) / (x (x + 1) ... f). */
  if (exponent >= 52 || (exponent >= 0 && significand << (exponent + 1) == 0))
    return bits_double(DOUBLE_NAN); /* a negative integer */
  uint64_t below = exponent >= 0 ? significand << (exponent + 1) : significand >> -(exponent + 1); /* 1 - f */
  unsigned n = exponent >= 0 ? (unsigned)(significand >> (63 - exponent)) + 1 : 1;
  if (exponent >= 8)
    return bits_double((uint64_t)((significand >> (63 - exponent)) + 1) << 63);
  uint64_t f = 0 - below;
  struct scaled product = trax_times(gamma_inverse(f), normalised(f, -1));
  if (n == 1)
    product = trax_times(product, magnitude);
  else
    product = trax_times(product, normalised(below, -1));
  for (unsigned i = 1; i < n; i++)
    product = times_mixed(product, i, below);
  return quotient(n & 1, scaled_one, product);
}

float tgammaf(float x) {
  return (float)tgamma((double)x);
}
