/* asinh, acosh, atanh, log1p and log10 with 64 significant bits, by the logarithm and its series near 1. */
#include "coefficients64.h"
#include "scaled.h"

#include <math.h>

#define ONE 0x3FF0000000000000u
#define BEYOND 0x4200000000000000u /* 2^33: x^2 + 1 and x^2 - 1 are x^2 to 64 bits */

/* ln 2x. */
static double log_of_twice(uint32_t sign, struct scaled x) {
  int negative;
  return scaled_to_double(sign, trax_log_scaled(times_power(x, 1), &negative));
}

double asinh(double x) {
  uint64_t bits = double_bits(x), m = double_magnitude(bits);
  uint32_t sign = double_sign(bits);
  if (m < 0x3E30000000000000u) /* 2^-28: x^3/6 is lost in rounding */
    return x;
  if (m >= DOUBLE_INFINITY)
    return x + x;
  struct scaled n = scaled_of(m);
  if (m >= BEYOND)
    return log_of_twice(sign, n);
  /* ln(1 + x + (sqrt(1 + x^2) - 1)) */
  struct scaled square = trax_times(n, n);
  struct scaled root = trax_root(trax_plus(scaled_one, square));
  struct scaled rest = trax_quotient(square, trax_plus(scaled_one, root));
  return scaled_to_double(sign, trax_log1p_scaled(trax_plus(n, rest), 0));
}

double acosh(double x) {
  uint64_t bits = double_bits(x);
  if (bits <= ONE || bits >= DOUBLE_INFINITY) /* up to 1, infinite, negative or a NaN */
    return bits == ONE ? 0 : bits_double(bits == DOUBLE_INFINITY ? DOUBLE_INFINITY : DOUBLE_NAN);
  struct scaled n = scaled_of(bits);
  if (bits >= BEYOND)
    return log_of_twice(0, n);
  /* ln(1 + t + sqrt(t (t + 2))) */
  struct scaled t = trax_minus(n, scaled_one);
  struct scaled root = trax_root(trax_times(t, trax_plus(n, scaled_one)));
  return scaled_to_double(0, trax_log1p_scaled(trax_plus(root, t), 0));
}

double atanh(double x) {
  uint64_t bits = double_bits(x), m = double_magnitude(bits);
  uint32_t sign = double_sign(bits);
  if (m < 0x3E30000000000000u)
    return x;
  if (m >= ONE)
    return bits_double(m == ONE ? (uint64_t)sign << 63 | DOUBLE_INFINITY : DOUBLE_NAN);
  struct scaled n = scaled_of(m);
  if (n.exponent < -3)
    return scaled_to_double(sign, trax_small_atanh(n));
  int negative;
  struct scaled ratio = trax_quotient(trax_plus(scaled_one, n), trax_minus(scaled_one, n));
  return scaled_to_double(sign, times_power(trax_log_scaled(ratio, &negative), -1));
}

double log10(double x) {
  static const struct scaled log10_e = {LOG10_E_64, -2};
  uint64_t bits = double_bits(x);
  if (bits << 1 == 0)
    return -HUGE_VAL;
  if (bits >= DOUBLE_INFINITY)
    return bits_double(bits == DOUBLE_INFINITY ? DOUBLE_INFINITY : DOUBLE_NAN);
  if (bits == ONE)
    return 0;
  int negative;
  struct scaled logarithm = trax_log_scaled(scaled_of(bits), &negative);
  return scaled_to_double((uint32_t)negative, trax_times(logarithm, log10_e));
}

double log1p(double x) {
  uint64_t bits = double_bits(x), m = double_magnitude(bits);
  uint32_t sign = double_sign(bits);
  if (m < 0x3C90000000000000u) /* 2^-54: x^2/2 is lost in rounding */
    return x;
  if (sign && m >= ONE)
    return m == ONE ? -HUGE_VAL : bits_double(DOUBLE_NAN);
  if (m >= DOUBLE_INFINITY)
    return x + x;
  return scaled_to_double(sign, trax_log1p_scaled(scaled_of(m), (int)sign));
}
