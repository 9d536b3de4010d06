/* sqrt of binary64, correctly rounded. */
#include "root128.h"

#include <math.h>

double sqrt(double x) {
  uint64_t bits = double_bits(x);
  if (bits << 1 == 0 || bits == DOUBLE_INFINITY)
    return x;
  if (bits > DOUBLE_INFINITY)
    return bits_double(DOUBLE_NAN);
  int exponent;
  uint64_t m = double_bits(frexp(x, &exponent)); /* x = f * 2^exponent with 1/2 <= f < 1 */
  m = (m & 0x000FFFFFFFFFFFFFu) | 0x0010000000000000u;
  int odd = exponent & 1;
  m <<= 11 - odd; /* f * 2^64, halved for an odd exponent: at least 2^62 */
  exponent += odd;
  int inexact;
  uint64_t root = root128(m, &inexact);
  return trax_round_double(0, exponent / 2 + 1022, (root >> 1) | (root & 1) | (uint64_t)inexact);
}
