/* Conversions between binary16, a storage format, and binary32 and binary64. */
#include "double.h"

float __extendhfsf2(uint16_t x) {
  uint32_t sign_bit = (uint32_t)(x & 0x8000) << 16, magnitude = x & 0x7FFF;
  if (magnitude > 0x7C00)
    return bits_float(FLOAT_NAN);
  if (magnitude == 0x7C00)
    return bits_float(sign_bit | FLOAT_INFINITY);
  /* The bits move to those of a float. The multiplication corrects the exponent, and normalises subnormals. */
  return bits_float(sign_bit | float_bits(bits_float(magnitude << 13) * 0x1p112f));
}

/* significand * 2^(exponent - 15 - 31), its top bit set and its lowest set if something was cut off, rounded to nearest
 * even. */
static uint16_t round_half(uint32_t sign, int exponent, uint32_t significand) {
  if (exponent >= 31)
    return (uint16_t)(sign << 15 | 0x7C00);
  if (exponent < 1) {
    significand = shift_right_sticky(significand, (unsigned)(1 - exponent));
    exponent = 1;
  }
  uint32_t rest = significand & 0x1FFFFF, bits = significand >> 21;
  bits += rest > 0x100000 || (rest == 0x100000 && (bits & 1));
  return (uint16_t)(sign << 15 | (((uint32_t)(exponent - 1) << 10) + bits));
}

uint16_t __truncsfhf2(float x) {
  uint32_t a = float_bits(x), magnitude = a & ~FLOAT_SIGN;
  if (magnitude > FLOAT_INFINITY)
    return 0x7E00;
  int exponent = (int)(magnitude >> 23) - 127 + 15;
  return round_half(a >> 31, exponent, exponent < -40 ? 1 : magnitude << 8 | FLOAT_SIGN);
}

uint16_t __truncdfhf2(double x) {
  uint64_t a = double_bits(x), magnitude = double_magnitude(a);
  if (magnitude > DOUBLE_INFINITY)
    return 0x7E00;
  int exponent = double_exponent(magnitude) - 1023 + 15;
  uint64_t fraction = magnitude << 11;
  return round_half(double_sign(a), exponent, high_word(fraction) | FLOAT_SIGN | (low_word(fraction) != 0));
}

float __gnu_h2f_ieee(uint16_t x) {
  return __extendhfsf2(x);
}

uint16_t __gnu_f2h_ieee(float x) {
  return __truncsfhf2(x);
}
