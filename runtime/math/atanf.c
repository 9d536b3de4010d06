/* atan2f, and through it atanf, asinf and acosf: the angle of a point whose coordinates have 32 bits. */
#include "coefficients.h"
#include "fixed.h"

#include <math.h>

#define FLOAT_PI 0x40490FDBu
#define FLOAT_HALF_PI 0x3FC90FDBu
#define FLOAT_QUARTER_PI 0x3F490FDBu
#define FLOAT_THREE_QUARTERS_PI 0x4016CBE4u
#define TAN_PI_OVER_8 0x6A09E667u /* Q32 */

/* The angle of (x, y), both positive, or of (-x, y) if x is to be taken as negative. The polynomial serves angles t up
   to pi/8; others are a multiple k of pi/4 plus or minus such an angle. */
static float angle(uint32_t sign_bit, struct normal y, struct normal x, int x_is_negative) {
  int k = 0, negate = 0;
  int swap = y.exponent > x.exponent || (y.exponent == x.exponent && y.significand > x.significand);
  struct normal n = swap ? x : y, d = swap ? y : x;
  int distance = d.exponent - n.exponent;
  if (distance <= 2) {
    uint32_t aligned = n.significand >> distance;
    if (aligned > mul_high(d.significand, TAN_PI_OVER_8)) { /* atan(n/d) = pi/4 - atan((d - n) / (d + n)) */
      uint32_t difference = d.significand - aligned;
      k = 1;
      negate = 1;
      if (difference == 0)
        difference = 1; /* an angle below 2^-31: nothing beside pi/4 */
      int zeros = leading_zeros(difference);
      n = (struct normal){difference << zeros, d.exponent - zeros - 1};
      d.significand = (d.significand >> 1) + (aligned >> 1);
      if (!(d.significand >> 31)) { /* n = d/2.4, halved twice */
        d.significand <<= 1;
        n.exponent++;
      }
    }
  }
  if (swap) {
    k = 2 - k;
    negate = !negate;
  }
  if (x_is_negative) {
    k = 4 - k;
    negate = !negate;
  }
  uint32_t t = quotient_q31(n.significand, d.significand);
  int exponent = n.exponent - d.exponent - 31;
  uint32_t fixed = shifted(t, exponent < -127 ? -95 : exponent + 32);
  uint32_t z = mul_high(fixed, fixed);
  uint32_t arc = t - (mul_high(t, mul_high(z, alternating_polynomial(atan_coefficients, 7, z))) >> 1);
  if (k == 0)
    return make_float(sign_bit, arc, exponent);
  /* Q61; angles below 2^-61 do not change a multiple of pi/4. */
  uint64_t total = (PI_64 >> 3) * (uint32_t)k;
  uint64_t small = exponent >= -61 ? (uint64_t)arc << (exponent + 61) : exponent > -93 ? arc >> (-61 - exponent) : 0;
  return make_float64(sign_bit, negate ? total - small : total + small, -61);
}

/* A coordinate is 0, infinite or a NaN. */
static float extreme(uint32_t y, uint32_t x) {
  uint32_t ay = y & ~FLOAT_SIGN, ax = x & ~FLOAT_SIGN, sign_bit = y & FLOAT_SIGN;
  if (ay > FLOAT_INFINITY || ax > FLOAT_INFINITY)
    return bits_float(FLOAT_NAN);
  if (ay == FLOAT_INFINITY && ax == FLOAT_INFINITY)
    return bits_float(sign_bit | (x >> 31 ? FLOAT_THREE_QUARTERS_PI : FLOAT_QUARTER_PI));
  if (ay == 0 || ax == FLOAT_INFINITY)
    return bits_float(sign_bit | (x >> 31 ? FLOAT_PI : 0));
  return bits_float(sign_bit | FLOAT_HALF_PI);
}

static inline int is_extreme(uint32_t bits) {
  return (bits & ~FLOAT_SIGN) - 1 >= FLOAT_INFINITY - 1;
}

float atan2f(float y, float x) {
  uint32_t y_bits = float_bits(y), x_bits = float_bits(x);
  if (is_extreme(y_bits) || is_extreme(x_bits))
    return extreme(y_bits, x_bits);
  return angle(y_bits & FLOAT_SIGN, take_apart(y_bits), take_apart(x_bits), x_bits >> 31);
}

static const struct normal one = {0x80000000u, -31};

float atanf(float x) {
  uint32_t bits = float_bits(x);
  if (is_extreme(bits))
    return extreme(bits, 0x3F800000);
  return angle(bits & FLOAT_SIGN, take_apart(bits), one, 0);
}

/* sqrt(1 - x^2) for 2^-27 <= |x| < 1. */
static struct normal other_leg(uint32_t bits) {
  struct normal x = take_apart(bits);
  uint32_t m = x.significand >> 8;
  int shift = 2 * (x.exponent + 8) + 64; /* m^2 to Q64 */
  uint64_t square = mul_wide(m, m);
  square = shift >= 0 ? square << shift : square >> -shift;
  uint64_t rest = 0 - square;
  int up = leading_zeros64(rest) & ~1;
  return (struct normal){trax_sqrt64(rest << up), -32 - up / 2};
}

float asinf(float x) {
  uint32_t bits = float_bits(x), magnitude = bits & ~FLOAT_SIGN;
  if (magnitude < 0x39800000) /* 2^-12: x^3/6 is lost in rounding */
    return x;
  if (magnitude >= 0x3F800000)
    return bits_float(magnitude == 0x3F800000 ? (bits & FLOAT_SIGN) | FLOAT_HALF_PI : FLOAT_NAN);
  return angle(bits & FLOAT_SIGN, take_apart(bits), other_leg(bits), 0);
}

float acosf(float x) {
  uint32_t bits = float_bits(x), magnitude = bits & ~FLOAT_SIGN;
  if (magnitude < 0x32000000) /* 2^-27 */
    return bits_float(FLOAT_HALF_PI);
  if (magnitude >= 0x3F800000)
    return bits_float(bits == 0x3F800000 ? 0 : magnitude == 0x3F800000 ? FLOAT_PI : FLOAT_NAN);
  return angle(0, other_leg(bits), take_apart(bits), (int)(bits >> 31));
}
