/* erf and erfc with 64 significant bits: erf by a polynomial below 1, erfc = e^(-x^2) P(1 / (x + 3)) / (x + 3) above.
 */
#include "coefficients64.h"
#include "scaled.h"

#include <math.h>

#define ONE 0x3FF0000000000000u

static const struct scaled two_over_sqrt_pi = {TWO_OVER_SQRT_PI_64, 0};

/* For x < 1. */
static struct scaled small_erf(struct scaled x) {
  uint64_t fraction = scaled_fraction(x), z = trax_mul_high64(fraction, fraction);
  uint64_t tail = trax_mul_high64(z, trax_alternating_polynomial(erf_coefficients, LENGTH(erf_coefficients), z));
  return trax_times(normalised(x.significand - trax_mul_high64(x.significand, tail), x.exponent), two_over_sqrt_pi);
}

/* For x from 1 to 28. */
static struct scaled great_erfc(struct scaled x) {
  static const struct scaled three = {0xC000000000000000u, 1};
  struct scaled q = trax_quotient(scaled_one, trax_plus(x, three));
  int64_t t = (int64_t)(0x9000000000000000u - (scaled_fraction(q) << 2)); /* 9/16 - 4 q */
  struct scaled p = normalised((uint64_t)trax_signed_polynomial(erfc_coefficients, LENGTH(erfc_coefficients), t), 1);
  /* The square of 53 bits is exact: e^(-x^2) would magnify an error of it by x^2. */
  uint64_t low = x.significand * x.significand, high = trax_mul_high64(x.significand, x.significand);
  int whole = 2 * x.exponent + 2; /* bits of the upper word before the point, 2 to 10 */
  uint64_t fraction = high << whole | low >> (64 - whole);
  return trax_times(trax_times(p, q), trax_exp_fixed((uint32_t)(high >> (64 - whole)), fraction, 1));
}

double erf(double x) {
  uint64_t bits = double_bits(x), m = double_magnitude(bits);
  uint32_t sign = double_sign(bits);
  if (m == 0)
    return x;
  if (m >= 0x4018000000000000u) { /* 6: erfc is less than half of the last place of 1 */
    if (m > DOUBLE_INFINITY)
      return bits_double(DOUBLE_NAN);
    return bits_double((uint64_t)sign << 63 | ONE);
  }
  struct scaled n = scaled_of(m);
  return scaled_to_double(sign, m < ONE ? small_erf(n) : trax_minus(scaled_one, great_erfc(n)));
}

double erfc(double x) {
  uint64_t bits = double_bits(x), m = double_magnitude(bits);
  uint32_t sign = double_sign(bits);
  if (m > DOUBLE_INFINITY)
    return bits_double(DOUBLE_NAN);
  if (m < 0x3C80000000000000u) /* 2^-55 */
    return 1;
  if (sign && m >= 0x4018000000000000u)
    return 2;
  if (m >= 0x403C000000000000u) /* 28 */
    return 0;
  struct scaled n = scaled_of(m), result;
  if (m < ONE)
    result = sign ? trax_plus(scaled_one, small_erf(n)) : trax_minus(scaled_one, small_erf(n));
  else
    result = sign ? trax_minus(times_power(scaled_one, 1), great_erfc(n)) : great_erfc(n);
  return scaled_to_double(0, result);
}
