/* binary64 multiplication. */
#include "double.h"

/* floor(a * b / 2^64) with the lowest bit set if the division was not exact. */
static inline uint64_t mul_high_sticky64(uint64_t a, uint64_t b) {
  uint64_t low = mul_wide(low_word(a), low_word(b));
  uint64_t middle = mul_wide(high_word(a), low_word(b)) + high_word(low);
  uint64_t other = mul_wide(low_word(a), high_word(b)) + low_word(middle);
  uint64_t high = mul_wide(high_word(a), high_word(b)) + high_word(middle) + high_word(other);
  return high | ((low_word(low) | low_word(other)) != 0);
}

double __muldf3(double x, double y) {
  uint64_t a = double_bits(x), b = double_bits(y);
  uint32_t sign = double_sign(a ^ b);
  uint64_t sign_bit = (uint64_t)sign << 63;
  a = double_magnitude(a);
  b = double_magnitude(b);
  int ea = double_exponent(a), eb = double_exponent(b);
  if (ea == EXPONENT_SPECIAL || eb == EXPONENT_SPECIAL) {
    if (is_nan_bits(a) || is_nan_bits(b) || a == 0 || b == 0)
      return bits_double(DOUBLE_NAN);
    return bits_double(sign_bit | DOUBLE_INFINITY);
  }
  if (a == 0 || b == 0)
    return bits_double(sign_bit);
  uint64_t sa = normalised_significand(a, &ea) << 11;
  uint64_t sb = normalised_significand(b, &eb) << 11;
  uint64_t product = mul_high_sticky64(sa, sb); /* bit 63 or 62 leads */
  int exponent = ea + eb - 1023;
  if (product >> 63) {
    product = product >> 1 | (product & 1);
    exponent++;
  }
  return trax_round_double(sign, exponent, product);
}
