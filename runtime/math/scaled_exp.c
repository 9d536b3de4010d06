/* e^x to 64 bits: 2^(n + i/16 + r/16), n and i integers, with 2^(i/16) from a table and 2^(r/16) from a polynomial. */
#include "coefficients64.h"
#include "scaled.h"

struct scaled trax_exp_fixed(uint32_t whole, uint64_t fraction, int negative) {
  /* t = x / ln 2 = x + x * (1/ln 2 - 1), exact to some units of 2^-64. */
  const uint32_t *c = log2_e_less_1;
  uint64_t middle = mul_wide(whole, c[1]) + mul_high(whole, c[2]);
  uint64_t high = mul_wide(whole, c[0]) + high_word(middle);
  uint64_t part = words(low_word(high), low_word(middle)), other = trax_mul_high64(fraction, words(c[0], c[1]));
  int n = (int)(whole + high_word(high));
  uint64_t t = fraction + part;
  n += t < part;
  t += other;
  n += t < other;
  if (negative) {
    t = 0 - t;
    n = -n - (t != 0);
  }
  uint64_t r = t << 4, root = exp_table[t >> 60];
  uint64_t above_one = trax_mul_high64(trax_polynomial(exp_coefficients, LENGTH(exp_coefficients), r), r);
  return (struct scaled){root + trax_mul_high64(root, above_one), n};
}

struct scaled trax_exp_scaled(struct scaled x, int negative) {
  if (x.exponent < 0)
    return trax_exp_fixed(0, scaled_fraction(x), negative);
  return trax_exp_fixed((uint32_t)(x.significand >> (63 - x.exponent)), x.significand << 1 << x.exponent, negative);
}
