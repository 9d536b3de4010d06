/* expf and exp2f: the exponent for base 2 in fixed point, Q32. */
#include "coefficients.h"
#include "fixed.h"

#include <math.h>

/* The results of both for NaN, and if |x| is at least 2^limit or less than 2^-25. */
static float extreme(float x, uint32_t bits) {
  if ((bits & ~FLOAT_SIGN) > FLOAT_INFINITY)
    return bits_float(FLOAT_NAN);
  if ((bits & ~FLOAT_SIGN) < 0x40000000)
    return 1 + x;
  return bits >> 31 ? 0 : bits_float(FLOAT_INFINITY);
}

float expf(float x) {
  uint32_t bits = float_bits(x);
  int exponent = (int)(bits >> 23 & 0xFF) - 127;
  if ((unsigned)(exponent + 25) >= 32) /* |x| < 2^-25 or >= 2^7 */
    return extreme(x, bits);
  uint64_t product = mul_high_96(LOG2_E, bits << 8 | FLOAT_SIGN); /* Q(62 - exponent) */
  int64_t t = (int64_t)(product >> (30 - exponent));
  return trax_exp2_fixed(0, bits >> 31 ? -t : t);
}

float exp2f(float x) {
  uint32_t bits = float_bits(x);
  int exponent = (int)(bits >> 23 & 0xFF) - 127;
  if ((unsigned)(exponent + 25) >= 33) /* |x| < 2^-25 or >= 2^8 */
    return extreme(x, bits);
  int64_t t = (int64_t)((uint64_t)(bits << 8 | FLOAT_SIGN) << 8 >> (7 - exponent));
  return trax_exp2_fixed(0, bits >> 31 ? -t : t);
}
