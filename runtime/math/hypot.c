/* hypot with 64 significant bits, whose exponents neither overflow nor underflow. */
#include "scaled.h"

#include <math.h>

double hypot(double x, double y) {
  uint64_t a = double_magnitude(double_bits(x)), b = double_magnitude(double_bits(y));
  if (a == DOUBLE_INFINITY || b == DOUBLE_INFINITY)
    return HUGE_VAL;
  if (a > DOUBLE_INFINITY || b > DOUBLE_INFINITY)
    return bits_double(DOUBLE_NAN);
  if (a == 0 || b == 0)
    return bits_double(a | b);
  struct scaled m = scaled_of(a), n = scaled_of(b);
  return scaled_to_double(0, trax_root(trax_plus(trax_times(m, m), trax_times(n, n))));
}
