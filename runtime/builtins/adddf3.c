/* binary64 addition and subtraction. */
#include "double.h"

static uint64_t significand(uint64_t bits, int *exponent) {
  uint64_t fraction = bits & FRACTION_MASK;
  if (*exponent)
    return (fraction | HIDDEN_BIT) << 10;
  *exponent = 1;
  return fraction << 10;
}

double __adddf3(double x, double y) {
  uint64_t a = double_bits(x), b = double_bits(y);
  if (double_magnitude(a) < double_magnitude(b)) {
    uint64_t t = a;
    a = b;
    b = t;
  }
  int exponent = double_exponent(a), smaller = double_exponent(b);
  uint32_t sign = double_sign(a), subtract = sign ^ double_sign(b);
  if (exponent == EXPONENT_SPECIAL) {
    if (is_nan_bits(a) || (subtract && smaller == EXPONENT_SPECIAL))
      return bits_double(DOUBLE_NAN);
    return bits_double(a);
  }
  uint64_t sum = significand(a, &exponent);
  uint64_t other = significand(b, &smaller);
  /* Ten bits below the last place: a shift of more than two places loses at most one bit to normalisation, so the
     sticky bit stays below the rounding position. */
  other = shift_right_sticky64(other, (unsigned)(exponent - smaller));
  if (!subtract) {
    sum += other;
    if (sum >> 63) {
      sum = sum >> 1 | (sum & 1);
      exponent++;
    }
  } else {
    sum -= other;
    if (sum == 0)
      return 0.0;
  }
  if (sum >> 62 == 0) {
    if (sum == 0) /* two zeros of one sign */
      return bits_double((uint64_t)sign << 63);
    int shift = leading_zeros64(sum) - 1;
    if (shift >= exponent) /* stays or becomes subnormal */
      shift = exponent - 1;
    sum <<= shift;
    exponent -= shift;
  }
  return trax_round_double(sign, exponent, sum);
}

double __subdf3(double a, double b) {
  return __adddf3(a, bits_double(double_bits(b) ^ DOUBLE_SIGN));
}

double __negdf2(double a) {
  return bits_double(double_bits(a) ^ DOUBLE_SIGN);
}
