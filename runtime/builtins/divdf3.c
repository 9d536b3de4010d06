/* binary64 division. */
#include "../internal/divide.h"
#include "double.h"

double __divdf3(double x, double y) {
  uint64_t a = double_bits(x), b = double_bits(y);
  uint32_t sign = double_sign(a ^ b);
  uint64_t sign_bit = (uint64_t)sign << 63;
  a = double_magnitude(a);
  b = double_magnitude(b);
  int ea = double_exponent(a), eb = double_exponent(b);
  if (ea == EXPONENT_SPECIAL || eb == EXPONENT_SPECIAL) {
    if (is_nan_bits(a) || is_nan_bits(b) || a == b)
      return bits_double(DOUBLE_NAN);
    return bits_double(sign_bit | (ea == EXPONENT_SPECIAL ? DOUBLE_INFINITY : 0));
  }
  if (b == 0)
    return bits_double(a == 0 ? DOUBLE_NAN : sign_bit | DOUBLE_INFINITY);
  if (a == 0)
    return bits_double(sign_bit);
  /* Half the dividend over the normalised divisor: 64 bits of quotient, the first or the second of them a 1. */
  uint64_t divisor = normalised_significand(b, &eb) << 11;
  uint64_t dividend = normalised_significand(a, &ea) << 10;
  uint32_t v = reciprocal_3by2(divisor);
  struct divided_3by2 first = divide_3by2(dividend, 0, divisor, v);
  struct divided_3by2 second = divide_3by2(first.remainder, 0, divisor, v);
  uint64_t quotient = words(first.quotient, second.quotient) | (second.remainder != 0);
  int exponent = ea - eb + 1022;
  if (quotient >> 63) {
    quotient = quotient >> 1 | (quotient & 1);
    exponent++;
  }
  return trax_round_double(sign, exponent, quotient);
}
