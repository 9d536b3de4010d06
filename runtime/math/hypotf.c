/* hypotf: the sum of the squares is exact or nearly, so that only the root rounds. */
#include "fixed.h"

#include <math.h>

float hypotf(float x, float y) {
  uint32_t a = float_bits(x) & ~FLOAT_SIGN, b = float_bits(y) & ~FLOAT_SIGN;
  if (a < b) {
    uint32_t t = a;
    a = b;
    b = t;
  }
  if (a >= FLOAT_INFINITY) /* an infinite result takes precedence over a NaN */
    return bits_float(a == FLOAT_INFINITY || b == FLOAT_INFINITY ? FLOAT_INFINITY : FLOAT_NAN);
  if (b == 0)
    return bits_float(a);
  struct normal p = take_apart(a), q = take_apart(b);
  int distance = p.exponent - q.exponent;
  if (distance > 15) /* the lesser adds less than 2^-31 of the greater */
    return bits_float(a);
  uint32_t m = p.significand >> 8, n = q.significand >> 8;
  uint64_t sum = (mul_wide(m, m) << 14) + (mul_wide(n, n) << 14 >> 2 * distance);
  int scale = p.exponent + 8 - 7; /* of the root */
  if (sum >> 62 == 0) {
    sum <<= 2;
    scale--;
  }
  return make_float(0, trax_sqrt64(sum), scale);
}
