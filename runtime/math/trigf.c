/* sinf, cosf and tanf. The argument is reduced by integer multiplication with as many bits of 2/pi as its exponent asks
   for (after Payne and Hanek, "Radian reduction for trigonometric functions", SIGNUM 18, 1983): one way for all
   arguments, however large. */
#include "coefficients.h"
#include "fixed.h"

#include <math.h>

/* The angle r = +-significand * 2^exponent with |r| <= pi/4, and the number of quarter turns before it. */
struct reduced {
  uint32_t significand;
  int exponent;
  uint32_t sign_bit;
  uint32_t quadrant;
};

/* bits: of a finite positive number, at least 2^-12. */
static struct reduced reduce(uint32_t bits) {
  uint32_t m = (bits & 0x007FFFFF) | 0x00800000;
  int exponent = (int)(bits >> 23) - 150; /* x = m * 2^exponent */
  if (bits <= 0x3F490FDA)                 /* below pi/4 */
    return (struct reduced){m << 8, exponent - 8, 0, 0};
  /* Bits of 2/pi that contribute multiples of four quarter turns are left out. The rest of the product is Q62. */
  unsigned first = (unsigned)(exponent + 30);
  const uint32_t *w = two_over_pi + first / 32;
  unsigned left = first % 32;
  uint32_t w0 = w[0] << left | w[1] >> 1 >> (31 - left);
  uint32_t w1 = w[1] << left | w[2] >> 1 >> (31 - left);
  uint32_t w2 = w[2] << left | w[3] >> 1 >> (31 - left);
  uint64_t turns = mul_wide(m, w1) + mul_high(m, w2) + ((uint64_t)(m * w0) << 32);
  uint32_t quadrant = (high_word(turns) + 0x20000000) >> 30; /* the nearest */
  int64_t rest = (int64_t)(turns << 2);                      /* Q64 */
  uint64_t magnitude = (uint64_t)(rest < 0 ? -rest : rest);
  int zeros = leading_zeros64(magnitude);
  uint32_t significand = mul_high(high_word(magnitude << zeros), PI_OVER_4);
  return (struct reduced){significand, -31 - zeros, rest < 0 ? FLOAT_SIGN : 0, quadrant};
}

/* r^2, Q32. */
static uint32_t square(struct reduced r) {
  uint32_t fixed = shifted(r.significand, r.exponent + 32);
  return mul_high(fixed, fixed);
}

/* sin |r| = significand * 2^exponent with r's exponent. */
static uint32_t sine(struct reduced r, uint32_t z) {
  uint32_t p = alternating_polynomial(sin_coefficients, 4, z); /* Q34 */
  return r.significand - (mul_high(r.significand, mul_high(z, p)) >> 2);
}

/* cos r, Q32, in [0.7, 1]; 1 is represented by the number below it. */
static uint32_t cosine(uint32_t z) {
  uint32_t below_one = mul_high(z, alternating_polynomial(cos_coefficients, 5, z));
  return below_one ? 0 - below_one : UINT32_MAX;
}

static float sine_of(struct reduced r, uint32_t z) {
  return make_float(r.sign_bit, sine(r, z), r.exponent);
}

static float quarter(struct reduced r, uint32_t quadrant, uint32_t sign_bit) {
  uint32_t z = square(r);
  sign_bit ^= quadrant << 30 & FLOAT_SIGN;
  if (quadrant & 1)
    return make_float(sign_bit, cosine(z), -32);
  r.sign_bit ^= sign_bit;
  return sine_of(r, z);
}

static inline int is_tiny(uint32_t magnitude) {
  return magnitude < 0x39800000;
} /* 2^-12: x^2 is lost in rounding */

float sinf(float x) {
  uint32_t bits = float_bits(x), magnitude = bits & ~FLOAT_SIGN;
  if (is_tiny(magnitude))
    return x;
  if (magnitude >= FLOAT_INFINITY)
    return bits_float(FLOAT_NAN);
  struct reduced r = reduce(magnitude);
  return quarter(r, r.quadrant, bits & FLOAT_SIGN);
}

float cosf(float x) {
  uint32_t magnitude = float_bits(x) & ~FLOAT_SIGN;
  if (is_tiny(magnitude))
    return 1;
  if (magnitude >= FLOAT_INFINITY)
    return bits_float(FLOAT_NAN);
  struct reduced r = reduce(magnitude);
  return quarter(r, r.quadrant + 1, 0);
}

void sincosf(float x, float *sine, float *cosine) {
  uint32_t bits = float_bits(x), magnitude = bits & ~FLOAT_SIGN;
  if (is_tiny(magnitude)) {
    *sine = x;
    *cosine = 1;
  } else if (magnitude >= FLOAT_INFINITY) {
    *sine = *cosine = bits_float(FLOAT_NAN);
  } else {
    struct reduced r = reduce(magnitude);
    *sine = quarter(r, r.quadrant, bits & FLOAT_SIGN);
    *cosine = quarter(r, r.quadrant + 1, 0);
  }
}

float tanf(float x) {
  uint32_t bits = float_bits(x), magnitude = bits & ~FLOAT_SIGN;
  if (is_tiny(magnitude))
    return x;
  if (magnitude >= FLOAT_INFINITY)
    return bits_float(FLOAT_NAN);
  struct reduced r = reduce(magnitude);
  uint32_t z = square(r);
  uint32_t s = sine(r, z), c = cosine(z);
  int zeros = leading_zeros(s);
  s <<= zeros;
  int exponent = r.exponent - zeros + 32; /* of the quotient s/c, c being Q32 */
  uint32_t sign_bit = (bits & FLOAT_SIGN) ^ r.sign_bit;
  if (r.quadrant & 1)
    return make_float(sign_bit ^ FLOAT_SIGN, quotient_q31(c, s), -exponent - 31);
  return make_float(sign_bit, quotient_q31(s, c), exponent - 31);
}
