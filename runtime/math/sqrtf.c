/* sqrtf, correctly rounded. */
#include "fixed.h"

#include <math.h>

float sqrtf(float x) {
  uint32_t bits = float_bits(x);
  uint32_t half_scale = 0;
  if (bits - 0x00800000 >= 0x7F000000) { /* not a positive normal number */
    if (bits << 1 == 0 || bits == FLOAT_INFINITY)
      return x;
    if (bits > FLOAT_INFINITY)
      return bits_float(FLOAT_NAN);
    bits = float_bits(x * 0x1p24f);
    half_scale = 12u << 23;
  }
  /* x = m * 4^k with 1 <= m < 4: the root s of m, in units of 2^-23, is right or one off after one multiplication. */
  uint32_t odd = ~bits >> 23 & 1;
  uint32_t exponent_of_m = (127 + odd) << 23;
  uint32_t fraction = bits & 0x007FFFFF;
  float m = bits_float(exponent_of_m | fraction);
  uint32_t s = float_bits(m * reciprocal_sqrt(m)) - 0x3F000000; /* 2^23 for 1, 2^24 for 2 */
  /* s is the nearest if (s - 1/2)^2 < m < (s + 1/2)^2, that is -s < m - s^2 <= s in units of 2^-46. The difference is
     small, so its low word is all of it. */
  int32_t rest = (int32_t)(((fraction | 0x00800000) << (23 + odd)) - s * s);
  s += (rest > (int32_t)s) - (rest <= -(int32_t)s);
  return bits_float(((uint32_t)((int32_t)(bits - exponent_of_m) >> 1) & 0xFF800000) + s + 0x3F000000 - half_scale);
}
