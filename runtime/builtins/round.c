/* Rounding and packing, the end of every operation that makes a float or a double from integers. */
#include "builtins.h"

float trax_round_float(uint32_t sign, int exponent, uint32_t significand) {
  if (exponent >= 255)
    return bits_float(sign << 31 | FLOAT_INFINITY);
  if (exponent < 1) {
    significand = shift_right_sticky(significand, (unsigned)(1 - exponent));
    exponent = 1;
  }
  uint32_t rest = significand & 0xFF;
  uint32_t bits = significand >> 8;
  bits += rest > 0x80 || (rest == 0x80 && (bits & 1));
  /* The leading bit, if it is there, adds the last 1 to the exponent; so does a carry, up to infinity. */
  return bits_float((sign << 31) | (((uint32_t)(exponent - 1) << 23) + bits));
}

double trax_round_double(uint32_t sign, int exponent, uint64_t significand) {
  if (exponent >= 0x7FF)
    return bits_double((uint64_t)sign << 63 | DOUBLE_INFINITY);
  if (exponent < 1) {
    significand = shift_right_sticky64(significand, (unsigned)(1 - exponent));
    exponent = 1;
  }
  uint32_t rest = low_word(significand) & 0x3FF;
  uint64_t bits = significand >> 10;
  bits += rest > 0x200 || (rest == 0x200 && (low_word(bits) & 1));
  return bits_double((uint64_t)sign << 63 | (((uint64_t)(exponent - 1) << 52) + bits));
}
