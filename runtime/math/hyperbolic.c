/* sinh, cosh, tanh and expm1 with 64 significant bits: small results by a polynomial, others by e^x. */
#include "coefficients64.h"
#include "scaled.h"

#include <math.h>

#define BEYOND 0x4086400000000000u /* 712: the results are infinite */
#define ONE 0x3FF0000000000000u

/* For x < 1. */
static struct scaled small_sinh(struct scaled x) {
  uint64_t fraction = scaled_fraction(x), z = trax_mul_high64(fraction, fraction);
  uint64_t tail = trax_mul_high64(z, trax_polynomial(sinh_coefficients64, LENGTH(sinh_coefficients64), z));
  return normalised((x.significand >> 1) + (trax_mul_high64(x.significand, tail) >> 1), x.exponent + 1);
}

double sinh(double x) {
  uint64_t bits = double_bits(x), m = double_magnitude(bits);
  if (m < 0x3E30000000000000u) /* 2^-28: x^3/6 is lost in rounding */
    return x;
  if (m >= BEYOND)
    return x * 0x1p1023;
  struct scaled n = scaled_of(m);
  if (m < ONE)
    return scaled_to_double(double_sign(bits), small_sinh(n));
  struct scaled up = trax_exp_scaled(n, 0);
  return scaled_to_double(double_sign(bits), times_power(trax_minus(up, trax_quotient(scaled_one, up)), -1));
}

double cosh(double x) {
  uint64_t m = double_magnitude(double_bits(x));
  if (m < 0x3E30000000000000u)
    return 1;
  if (m >= BEYOND)
    return bits_double(m) * 0x1p1023;
  struct scaled up = trax_exp_scaled(scaled_of(m), 0);
  return scaled_to_double(0, times_power(trax_plus(up, trax_quotient(scaled_one, up)), -1));
}

double tanh(double x) {
  uint64_t bits = double_bits(x), m = double_magnitude(bits);
  uint32_t sign = double_sign(bits);
  if (m < 0x3E30000000000000u)
    return x;
  if (m >= 0x4036000000000000u) { /* 22: 1 - tanh x is less than half of the last place */
    if (m > DOUBLE_INFINITY)
      return bits_double(DOUBLE_NAN);
    return bits_double((uint64_t)sign << 63 | ONE);
  }
  struct scaled n = scaled_of(m);
  if (m < ONE) { /* s / sqrt(1 + s^2) */
    struct scaled s = small_sinh(n);
    return scaled_to_double(sign, trax_quotient(s, trax_root(trax_plus(scaled_one, trax_times(s, s)))));
  }
  struct scaled square = trax_exp_scaled(times_power(n, 1), 0);
  return scaled_to_double(sign, trax_quotient(trax_minus(square, scaled_one), trax_plus(square, scaled_one)));
}

double expm1(double x) {
  uint64_t bits = double_bits(x), m = double_magnitude(bits);
  uint32_t sign = double_sign(bits);
  if (m < 0x3C90000000000000u) /* 2^-54: x^2/2 is lost in rounding */
    return x;
  if (m > DOUBLE_INFINITY)
    return bits_double(DOUBLE_NAN);
  if (sign && m >= 0x4043000000000000u) /* 38: e^x is less than half of the last place of 1 */
    return -1;
  if (m >= BEYOND)
    return HUGE_VAL;
  struct scaled n = scaled_of(m);
  if (m < ONE) { /* sinh x + (cosh x - 1), the latter being s^2 / (1 + sqrt(1 + s^2)) */
    struct scaled s = small_sinh(n), square = trax_times(s, s);
    struct scaled even = trax_quotient(square, trax_plus(scaled_one, trax_root(trax_plus(scaled_one, square))));
    return scaled_to_double(sign, sign ? trax_minus(s, even) : trax_plus(s, even));
  }
  struct scaled power = trax_exp_scaled(n, (int)sign);
  return scaled_to_double(sign, sign ? trax_minus(scaled_one, power) : trax_minus(power, scaled_one));
}
