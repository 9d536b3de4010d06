/* fmaf: one rounding. The product of two floats is a double without rounding; its sum with the third is rounded to odd,
   after which rounding to float is right because a double has more than twice as many bits. */
#include "../internal/bits.h"

#include <math.h>

float fmaf(float x, float y, float z) {
  double product = (double)x * (double)y;
  double sum = product + (double)z;
  uint64_t bits = double_bits(sum);
  if ((bits & ~DOUBLE_SIGN) < DOUBLE_INFINITY && !(bits & 1)) {
    /* The part that the addition rounded away. */
    double shared = sum - product;
    double error = (product - (sum - shared)) + ((double)z - shared);
    if (error != 0)
      bits += (error > 0) == !(bits >> 63) ? 1 : (uint64_t)-1;
  }
  return (float)bits_double(bits);
}
