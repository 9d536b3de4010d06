/* sinhf, coshf, tanhf and expm1f: small results by polynomials, others by powers of two. */
#include "coefficients.h"
#include "fixed.h"

#include <math.h>

/* |x| log2(e) * 2^scale, Q32, for 2^-12 <= |x| < 2^7. */
static int64_t exponent_of(struct normal x, int scale) {
  return (int64_t)(mul_high_96(LOG2_E, x.significand) >> (-1 - x.exponent - scale));
}

/* 2^(t * 2^-32). */
static struct normal power(int64_t t) {
  uint32_t fraction = low_word((uint64_t)t);
  uint32_t above_one = mul_high(polynomial(exp2_coefficients, 8, fraction), fraction);
  return (struct normal){FLOAT_SIGN | above_one >> 1, (int)(t >> 32) - 31};
}

/* The sum for a >= b. */
static struct normal sum(struct normal a, struct normal b) {
  uint32_t significand = a.significand + shifted(b.significand, b.exponent - a.exponent);
  if (significand >= a.significand)
    return (struct normal){significand, a.exponent};
  return (struct normal){significand >> 1 | FLOAT_SIGN, a.exponent + 1};
}

/* x^2, Q32, for |x| < 1. */
static uint32_t square(struct normal x) {
  uint32_t fixed = shifted(x.significand, x.exponent + 32);
  return mul_high(fixed, fixed);
}

float sinhf(float x) {
  uint32_t bits = float_bits(x), magnitude = bits & ~FLOAT_SIGN, sign_bit = bits & FLOAT_SIGN;
  if (magnitude < 0x39800000) /* 2^-12: x^3/6 is lost in rounding */
    return x;
  if (magnitude >= 0x43000000) /* 2^7 */
    return x * 0x1p127f;
  struct normal n = take_apart(magnitude);
  if (magnitude < 0x3F800000) {
    uint32_t z = square(n), tail = mul_high(z, polynomial(sinh_coefficients, 5, z)); /* Q34 */
    return make_float(sign_bit, (n.significand >> 1) + (mul_high(n.significand, tail) >> 3), n.exponent + 1);
  }
  int64_t t = exponent_of(n, 0);
  struct normal up = power(t), down = power(-t);
  return make_float(sign_bit, up.significand - shifted(down.significand, down.exponent - up.exponent), up.exponent - 1);
}

float coshf(float x) {
  uint32_t magnitude = float_bits(x) & ~FLOAT_SIGN;
  if (magnitude < 0x39800000)
    return 1;
  struct normal n = take_apart(magnitude);
  if (magnitude < 0x3F800000) { /* where two powers would change hardly and in opposite directions, one polynomial keeps
                                   the order */
    uint32_t z = square(n);
    return make_float(0, FLOAT_SIGN | mul_high(z, polynomial(cosh_coefficients, 5, z)) >> 1, -31);
  }
  if (magnitude >= 0x43000000)
    return bits_float(magnitude) * 0x1p127f;
  int64_t t = exponent_of(n, 0);
  struct normal twice = sum(power(t), power(-t));
  return make_float(0, twice.significand, twice.exponent - 1);
}

float tanhf(float x) {
  uint32_t bits = float_bits(x), magnitude = bits & ~FLOAT_SIGN, sign_bit = bits & FLOAT_SIGN;
  if (magnitude < 0x39800000)
    return x;
  if (magnitude >= 0x41110000) { /* 9.06: 1 - tanh x is less than half of the last place */
    if (magnitude > FLOAT_INFINITY)
      return bits_float(FLOAT_NAN);
    return bits_float(sign_bit | 0x3F800000);
  }
  struct normal n = take_apart(magnitude);
  if (magnitude < 0x3F000000) {
    uint32_t z = square(n), tail = mul_high(z, alternating_polynomial(tanh_coefficients, 6, z)); /* Q33 */
    return make_float(sign_bit, n.significand - (mul_high(n.significand, tail) >> 1), n.exponent);
  }
  /* 1 - 2 / (e^2x + 1) */
  static const struct normal one = {FLOAT_SIGN, -31};
  struct normal d = sum(power(exponent_of(n, 1)), one);
  uint32_t below_one = reciprocal_q63(d.significand | 1) >> (d.exponent + 30);
  return make_float(sign_bit, 0 - below_one, -32);
}

float expm1f(float x) {
  uint32_t bits = float_bits(x), magnitude = bits & ~FLOAT_SIGN, sign_bit = bits & FLOAT_SIGN;
  if (magnitude < 0x33000000) /* 2^-25: x^2/2 is lost in rounding */
    return x;
  if (magnitude > FLOAT_INFINITY)
    return bits_float(FLOAT_NAN);
  if (bits >= 0xC18C0000) /* -17.5: e^x is less than half of the last place */
    return -1;
  if (magnitude >= 0x43000000)
    return bits_float(FLOAT_INFINITY);
  struct normal n = take_apart(magnitude);
  if (magnitude < 0x3F000000) { /* sinh |x| +- (cosh x - 1), both as multiples of |x| */
    uint32_t fixed = shifted(n.significand, n.exponent + 32), z = mul_high(fixed, fixed);
    uint32_t odd = mul_high(n.significand, mul_high(z, polynomial(sinh_coefficients, 5, z)));      /* Q2 */
    uint32_t even = mul_high(n.significand, mul_high(fixed, polynomial(cosh_coefficients, 5, z))); /* Q0 */
    uint32_t sinh = (n.significand >> 1) + (odd >> 3);
    return make_float(sign_bit, sign_bit ? sinh - (even >> 1) : sinh + (even >> 1), n.exponent + 1);
  }
  int64_t t = exponent_of(n, 0);
  if (sign_bit) {
    struct normal down = power(-t);
    return make_float(sign_bit, 0 - shifted(down.significand, down.exponent + 32), -32);
  }
  struct normal up = power(t);
  return make_float(0, up.significand - shifted(FLOAT_SIGN, -31 - up.exponent), up.exponent);
}
