/* Functions of binary64 without arithmetic: exponents, neighbours, conversions to integers. */
#include "../builtins/double.h"

#include <math.h>

double fdim(double x, double y) {
  return x <= y ? 0 : x - y;
}

int ilogb(double x) {
  uint64_t m = double_magnitude(double_bits(x));
  if (m == 0)
    return FP_ILOGB0;
  if (m >= DOUBLE_INFINITY)
    return m == DOUBLE_INFINITY ? 0x7FFFFFFF : FP_ILOGBNAN;
  int exponent = double_exponent(m);
  normalised_significand(m, &exponent);
  return exponent - 1023;
}

double logb(double x) {
  uint64_t m = double_magnitude(double_bits(x));
  if (m == 0)
    return -HUGE_VAL;
  if (m >= DOUBLE_INFINITY)
    return m == DOUBLE_INFINITY ? HUGE_VAL : bits_double(DOUBLE_NAN);
  return ilogb(x);
}

double nextafter(double x, double y) {
  uint64_t a = double_bits(x), b = double_bits(y);
  if (is_nan_bits(a) || is_nan_bits(b))
    return bits_double(DOUBLE_NAN);
  if (a == b || double_magnitude(a | b) == 0)
    return y;
  if (double_magnitude(a) == 0)
    return bits_double((b & DOUBLE_SIGN) | 1);
  return bits_double((x < y) == !(a >> 63) ? a + 1 : a - 1);
}

double nexttoward(double x, long double y) {
  return nextafter(x, y);
}

double scalbln(double x, long exponent) {
  return ldexp(x, (int)exponent);
}

long lround(double x) {
  return (long)round(x);
}
long lrint(double x) {
  return (long)rint(x);
}
long long llround(double x) {
  return (long long)round(x);
}
long long llrint(double x) {
  return (long long)rint(x);
}

double nan(const char *payload) {
  (void)payload;
  return bits_double(DOUBLE_NAN);
}

void sincos(double x, double *sine, double *cosine) {
  *sine = sin(x);
  *cosine = cos(x);
}
