/* Conversions between binary32, binary64 and integers. */
#include "double.h"

double __extendsfdf2(float x) {
  uint32_t a = float_bits(x), magnitude = a & ~FLOAT_SIGN;
  uint64_t sign_bit = (uint64_t)(a & FLOAT_SIGN) << 32;
  if (magnitude > FLOAT_INFINITY)
    return bits_double(DOUBLE_NAN);
  if (magnitude == FLOAT_INFINITY)
    return bits_double(sign_bit | DOUBLE_INFINITY);
  if (magnitude >= 0x00800000)
    return bits_double(sign_bit | (((uint64_t)magnitude << 29) + ((uint64_t)(1023 - 127) << 52)));
  if (magnitude == 0)
    return bits_double(sign_bit);
  int zeros = leading_zeros(magnitude); /* a subnormal is magnitude * 2^-149 */
  uint64_t fraction = (uint64_t)magnitude << (zeros + 21);
  return bits_double(sign_bit | (((uint64_t)(1023 - 149 + 31 - zeros - 1) << 52) + fraction));
}

float __truncdfsf2(double x) {
  uint64_t a = double_bits(x);
  uint32_t sign = double_sign(a);
  a = double_magnitude(a);
  if (a > DOUBLE_INFINITY)
    return bits_float(FLOAT_NAN);
  int exponent = double_exponent(a) - 1023 + 127;
  if (exponent < -25) /* below half the least subnormal; subnormal doubles too */
    return bits_float(sign << 31);
  uint64_t fraction = a << 11;
  uint32_t significand = high_word(fraction) | FLOAT_SIGN | (low_word(fraction) != 0);
  return trax_round_float(sign, exponent, significand);
}

/* floor(|x|) of a number below 2^64 (exponent up to 63), given its stored exponent and fraction. */
static uint64_t integer_part(uint64_t a) {
  int exponent = double_exponent(a) - 1023;
  if (exponent < 0)
    return 0;
  uint64_t significand = (a & FRACTION_MASK) | HIDDEN_BIT;
  return exponent < 52 ? significand >> (52 - exponent) : significand << (exponent - 52);
}

uint64_t __fixunsdfdi(double x) {
  uint64_t a = double_bits(x);
  if (double_magnitude(a) > DOUBLE_INFINITY || double_sign(a))
    return 0;
  if (double_exponent(a) >= 1023 + 64)
    return UINT64_MAX;
  return integer_part(a);
}

int64_t __fixdfdi(double x) {
  uint64_t a = double_bits(x);
  if (double_magnitude(a) > DOUBLE_INFINITY)
    return 0;
  if (double_exponent(a) >= 1023 + 63)
    return double_sign(a) ? INT64_MIN : INT64_MAX;
  uint64_t magnitude = integer_part(a);
  return (int64_t)(double_sign(a) ? 0 - magnitude : magnitude);
}

uint32_t __fixunsdfsi(double x) {
  uint64_t value = __fixunsdfdi(x);
  return high_word(value) ? UINT32_MAX : low_word(value);
}

int32_t __fixdfsi(double x) {
  int64_t value = __fixdfdi(x);
  return value > INT32_MAX ? INT32_MAX : value < INT32_MIN ? INT32_MIN : (int32_t)value;
}

uint64_t __fixunssfdi(float x) {
  uint32_t a = float_bits(x);
  int exponent = (int)(a >> 23) - 127; /* over 128 with the sign */
  if ((a & ~FLOAT_SIGN) > FLOAT_INFINITY || a >> 31 || exponent < 0)
    return 0;
  if (exponent > 63)
    return UINT64_MAX;
  uint64_t significand = (a & 0x007FFFFF) | 0x00800000;
  return exponent < 23 ? significand >> (23 - exponent) : significand << (exponent - 23);
}

int64_t __fixsfdi(float x) {
  uint32_t a = float_bits(x);
  uint64_t magnitude = __fixunssfdi(bits_float(a & ~FLOAT_SIGN));
  if (magnitude >> 63)
    return a >> 31 ? INT64_MIN : INT64_MAX;
  return (int64_t)(a >> 31 ? 0 - magnitude : magnitude);
}

double __floatunsidf(uint32_t a) {
  if (a == 0)
    return 0.0;
  int zeros = leading_zeros(a);
  return bits_double(((uint64_t)(1023 + 31 - zeros - 1) << 52) + ((uint64_t)a << (21 + zeros)));
}

double __floatsidf(int32_t a) {
  uint64_t sign_bit = (uint64_t)((uint32_t)a & 0x80000000u) << 32;
  return bits_double(sign_bit | double_bits(__floatunsidf(a < 0 ? 0 - (uint32_t)a : (uint32_t)a)));
}

static double from_magnitude(uint32_t sign, uint64_t magnitude) {
  if (magnitude == 0)
    return 0.0;
  int zeros = leading_zeros64(magnitude);
  uint64_t significand = magnitude << zeros;
  return trax_round_double(sign, 1023 + 63 - zeros, significand >> 1 | (significand & 1));
}

double __floatundidf(uint64_t a) {
  return from_magnitude(0, a);
}

double __floatdidf(int64_t a) {
  return from_magnitude(a < 0, a < 0 ? 0 - (uint64_t)a : (uint64_t)a);
}

float __floatundisf(uint64_t a) {
  if (high_word(a) == 0)
    return (float)low_word(a);
  int zeros = leading_zeros(high_word(a));
  uint64_t significand = a << zeros;
  return trax_round_float(0, 127 + 63 - zeros, high_word(significand) | (low_word(significand) != 0));
}

float __floatdisf(int64_t a) {
  return a < 0 ? -__floatundisf(0 - (uint64_t)a) : __floatundisf((uint64_t)a);
}
