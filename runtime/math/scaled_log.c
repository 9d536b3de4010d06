/* ln x to 64 bits: x = m * 2^n with m from sqrt(1/2) to sqrt(2), and ln m = 2 atanh((m - 1) / (m + 1)). */
#include "coefficients64.h"
#include "scaled.h"

struct scaled trax_small_atanh(struct scaled x) {
  uint64_t fraction = scaled_fraction(x), z = trax_mul_high64(fraction, fraction);
  uint64_t tail = trax_mul_high64(z, trax_polynomial(atanh_coefficients64, LENGTH(atanh_coefficients64), z));
  uint64_t significand = (x.significand >> 1) + (trax_mul_high64(x.significand, tail) >> 1);
  return normalised(significand, x.exponent + 1);
}

/* n ln 2, for n from 1 to 2^12. */
static struct scaled times_ln2(uint32_t n) {
  uint64_t low = mul_wide(n, ln2_long[1]) + mul_high(n, ln2_long[2]);
  uint64_t high = mul_wide(n, ln2_long[0]) + high_word(low);
  int zeros = leading_zeros64(high);
  return (struct scaled){high << zeros | low_word(low) >> (32 - zeros), 31 - zeros};
}

struct scaled trax_log_scaled(struct scaled x, int *negative) {
  uint64_t m = x.significand;
  int n = x.exponent + (m >= SQRT2_64), below_one = m >= SQRT2_64;
  uint64_t numerator = below_one ? 0 - m : m - DOUBLE_SIGN;
  struct scaled denominator = {DOUBLE_SIGN + (below_one ? m >> 1 : (m - DOUBLE_SIGN) >> 1), !below_one};
  *negative = n < 0;
  if (numerator == 0)
    return times_ln2((uint32_t)(n < 0 ? -n : n));
  struct scaled s = trax_small_atanh(trax_quotient(normalised(numerator, -below_one), denominator));
  s.exponent++;
  if (n == 0) {
    *negative = below_one;
    return s;
  }
  struct scaled whole = times_ln2((uint32_t)(n < 0 ? -n : n));
  return below_one == (n < 0) ? trax_plus(whole, s) : trax_minus(whole, s);
}

struct scaled trax_log1p_scaled(struct scaled x, int negative) {
  static const struct scaled two = {DOUBLE_SIGN, 1};
  if (x.exponent < -2) { /* below 1/4: the quotient is below 1/7 */
    struct scaled s = trax_quotient(x, negative ? trax_minus(two, x) : trax_plus(two, x));
    return times_power(trax_small_atanh(s), 1);
  }
  return trax_log_scaled(negative ? trax_minus(scaled_one, x) : trax_plus(scaled_one, x), &negative);
}
