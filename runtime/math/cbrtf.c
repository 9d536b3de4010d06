/* cbrtf: the root of a number in [1, 8) by a float and one step of Newton's iteration in 64 bits, rounded once. */
#include "fixed.h"

#include <math.h>

float cbrtf(float x) {
  uint32_t bits = float_bits(x);
  if ((bits & ~FLOAT_SIGN) - 1 >= FLOAT_INFINITY - 1)
    return x + x;
  struct normal n = take_apart(bits);
  int exponent = n.exponent + 31 + 3 * 64;
  int third = (int)mul_high((uint32_t)exponent, 0x55555556);
  uint32_t m = n.significand >> (2 - (exponent - 3 * third)); /* Q29 */
  /* w = m^(-1/3): a third of the exponent and of the significand gives 5 bits, each step doubles them. */
  float f = (float)m * 0x1p-29f;
  float w = bits_float(0x54A21D2Au - mul_high(float_bits(f), 0x55555556));
  for (int i = 0; i < 3; i++)
    w = w * (1.3333334f - f * (w * w * w) * 0.33333334f);
  float inverse_slope = w * w * 0.33333334f;                                      /* 1 / (3 y^2) */
  uint32_t y = (uint32_t)(f * (w * w) * 0x1.FFFFFCp30f);                          /* Q31, and below 2 */
  int64_t rest = (int64_t)(((uint64_t)m << 32) - mul_high_96(mul_wide(y, y), y)); /* Q61 */
  y += (uint32_t)(int32_t)((float)(int32_t)(rest >> 20) * inverse_slope * 0x1p-10f);
  return make_float(bits & FLOAT_SIGN, y, third - 64 - 31);
}
