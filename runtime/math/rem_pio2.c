/* Reduction of an argument of binary64 to the nearest multiple of pi/2, for newlib's sin, cos and tan. Like the one in
   trigf.c it multiplies integers, with as many bits of 2/pi as the exponent asks for (after Payne and Hanek, "Radian
   reduction for trigonometric functions", SIGNUM 18, 1983): one way for all arguments, in a few words of stack. */
#include "../builtins/double.h"
#include "coefficients.h"

/* x = n * pi/2 + rest[0] + rest[1] with |rest[0]| <= pi/4, rest[1] at most half a unit in its last place and with 42
   more bits; returns n modulo 4. |x| is finite and at least pi/4. The name is newlib's. */
int32_t __ieee754_rem_pio2(double x, double *rest);

/* Six words, the most significant first. */
struct fraction {
  uint32_t word[6];
};

/* Of m * 2/pi * 2^exponent, the two bits before the point and 190 behind; m < 2^53. What is left out of 2/pi makes it
   less than 2^-137 too small, and no product of a double comes closer than 2^-62 to an integer. */
static inline struct fraction turns(uint64_t m, int exponent) {
  unsigned first = (unsigned)(exponent + 62);
  const uint32_t *w = two_over_pi_long + first / 32;
  unsigned left = first % 32;
  struct fraction f;
  uint32_t carry = 0, above = 0;
  for (int i = 5; i >= 0; i--) {
    uint32_t digits = w[i] << left | w[i + 1] >> 1 >> (31 - left);
    uint64_t sum = mul_wide(low_word(m), digits) + carry;
    uint64_t other = mul_wide(high_word(m), digits) + above + high_word(sum);
    f.word[i] = low_word(sum);
    carry = low_word(other);
    above = high_word(other);
  }
  return f;
}

/* (a[0], a[1], a[2]) * pi/4, the upper 96 bits and at most 3 units less. */
static inline void times_pi_over_4(const uint32_t *a, uint32_t *product) {
  uint64_t low = (uint64_t)mul_high(a[0], pi_over_4[2]) + mul_high(a[1], pi_over_4[1]) + mul_high(a[2], pi_over_4[0]);
  uint64_t p = mul_wide(a[0], pi_over_4[1]), q = mul_wide(a[1], pi_over_4[0]);
  low += (uint64_t)low_word(p) + low_word(q);
  uint64_t high = mul_wide(a[0], pi_over_4[0]) + high_word(p);
  uint64_t carry = (uint64_t)high_word(q) + high_word(low);
  high += carry;
  product[0] = high_word(high);
  product[1] = low_word(high);
  product[2] = low_word(low);
}

int32_t __ieee754_rem_pio2(double x, double *rest) {
  uint64_t bits = double_bits(x);
  struct fraction f = turns((bits & FRACTION_MASK) | HIDDEN_BIT, double_exponent(bits) - 1075);
  uint32_t quadrant = (f.word[0] + 0x20000000) >> 30; /* the nearest */
  /* To Q192 with the sign as mask, and its magnitude (one unit less if negative); then the leading word to the front.
   */
  uint32_t sign = 0 - (f.word[0] >> 29 & 1);
  uint32_t a[4];
  unsigned skipped = 0;
  while (skipped < 2 && ((f.word[skipped] << 2 | f.word[skipped + 1] >> 30) ^ sign) == 0)
    skipped++;
  for (unsigned i = 0; i < 4; i++) {
    uint32_t next = skipped + i < 5 ? f.word[skipped + i + 1] : 0;
    a[i] = (f.word[skipped + i] << 2 | next >> 30) ^ sign;
  }
  unsigned zeros = (unsigned)leading_zeros(a[0]);
  for (unsigned i = 0; i < 3; i++)
    a[i] = a[i] << zeros | a[i + 1] >> 1 >> (31 - zeros);
  uint32_t p[3];
  times_pi_over_4(a, p);
  int exponent = 1 - (int)(32 * skipped + zeros); /* of p as a fraction */
  /* p has its leading bit at 95 or 94; the first 53 bits go to rest[0], rounded. */
  unsigned up = 1 - (p[0] >> 31);
  uint64_t high = words(p[0], p[1]) << up | p[2] >> 1 >> (31 - up);
  exponent -= (int)up;
  uint64_t significand = high >> 11;
  int64_t below = (int64_t)((high & 0x7FF) << 32 | p[2] << up); /* of 43 bits */
  if (below >> 42) {
    significand++;
    below -= (int64_t)1 << 43;
  }
  uint64_t sign_bit = (uint64_t)((sign ^ high_word(bits)) & 0x80000000u) << 32;
  rest[0] = bits_double(sign_bit | (((uint64_t)(exponent + 1021) << 52) + significand));
  rest[1] = 0;
  if (below) /* as an integer, then scaled from units of 2^-96 */
    rest[1] = bits_double((double_bits(__floatdidf(below)) ^ sign_bit) + ((uint64_t)(int64_t)(exponent - 96) << 52));
  return (int32_t)(bits >> 63 ? 0 - quadrant : quadrant) & 3;
}
