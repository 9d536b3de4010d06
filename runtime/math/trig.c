/* sin, cos and tan with 64 significant bits. Arguments are reduced as in trigf.c, by multiplying integers with as many
   bits of 2/pi as the exponent requires (after Payne and Hanek, "Radian reduction for trigonometric functions", SIGNUM
   18, 1983): one way for all arguments, in a few words of stack. */
#include "coefficients.h"
#include "coefficients64.h"
#include "scaled.h"

#include <math.h>

/* Six words, the most significant first. */
struct fraction {
  uint32_t word[6];
};

/* Two bits of m * 2/pi * 2^exponent before the point and 190 after it; m < 2^53. The omitted bits of 2/pi make it less
   than 2^-137 too small, and no product of a double comes closer than 2^-62 to an integer. */
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

/* |x| = quadrant * pi/2 +- r with r at most pi/4. */
struct reduced {
  struct scaled r;
  uint32_t negative;
  uint32_t quadrant; /* modulo 4 */
};

/* For a finite magnitude, at least 2^-1022. */
static struct reduced reduce(uint64_t magnitude) {
  if (magnitude <= 0x3FE921FB54442D18u) /* pi/4 */
    return (struct reduced){scaled_of(magnitude), 0, 0};
  struct fraction f = turns((magnitude & FRACTION_MASK) | HIDDEN_BIT, double_exponent(magnitude) - 1075);
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
  /* p has its leading bit at 95 or 94. */
  unsigned up = 1 - (p[0] >> 31);
  uint64_t significand = words(p[0], p[1]) << up | p[2] >> 1 >> (31 - up);
  return (struct reduced){{significand, exponent - 1 - (int)up}, sign & 1, quadrant & 3};
}

static uint64_t square(struct scaled r) {
  uint64_t fraction = scaled_fraction(r);
  return trax_mul_high64(fraction, fraction);
}

static struct scaled sine(struct scaled r) {
  uint64_t z = square(r),
           tail = trax_mul_high64(z, trax_alternating_polynomial(sin_coefficients64, LENGTH(sin_coefficients64), z));
  return normalised(r.significand - trax_mul_high64(r.significand, tail), r.exponent);
}

static struct scaled cosine(struct scaled r) {
  uint64_t z = square(r),
           below_one =
               trax_mul_high64(z, trax_alternating_polynomial(cos_coefficients64, LENGTH(cos_coefficients64), z));
  return below_one ? normalised(0 - below_one, -1) : scaled_one;
}

#define TINY 0x3E40000000000000u /* 2^-27: x^2 is lost in rounding */

/* The sine of a reduced angle plus `quadrant` quarter turns. */
static double quarter(struct reduced a, uint32_t quadrant, uint32_t sign) {
  sign ^= quadrant >> 1 & 1;
  if (quadrant & 1)
    return scaled_to_double(sign, cosine(a.r));
  return scaled_to_double(sign ^ a.negative, sine(a.r));
}

double sin(double x) {
  uint64_t bits = double_bits(x), m = double_magnitude(bits);
  if (m < TINY)
    return x;
  if (m >= DOUBLE_INFINITY)
    return bits_double(DOUBLE_NAN);
  struct reduced a = reduce(m);
  return quarter(a, a.quadrant, double_sign(bits));
}

double cos(double x) {
  uint64_t m = double_magnitude(double_bits(x));
  if (m < TINY)
    return 1;
  if (m >= DOUBLE_INFINITY)
    return bits_double(DOUBLE_NAN);
  struct reduced a = reduce(m);
  return quarter(a, a.quadrant + 1, 0);
}

double tan(double x) {
  uint64_t bits = double_bits(x), m = double_magnitude(bits);
  if (m < TINY)
    return x;
  if (m >= DOUBLE_INFINITY)
    return bits_double(DOUBLE_NAN);
  struct reduced a = reduce(m);
  struct scaled s = sine(a.r), c = cosine(a.r);
  uint32_t sign = double_sign(bits) ^ a.negative;
  if (a.quadrant & 1)
    return scaled_to_double(sign ^ 1, trax_quotient(c, s));
  return scaled_to_double(sign, trax_quotient(s, c));
}
