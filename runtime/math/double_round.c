/* Rounding to integers and taking apart in binary64, on the representation: no arithmetic is needed. */
#include "../internal/bits.h"

#include <math.h>

INLINE uint64_t magnitude_of(uint64_t bits) {
  return bits & ~DOUBLE_SIGN;
}
INLINE int exponent_of(uint64_t bits) {
  return (int)(high_word(bits) >> 20 & 0x7FF) - 1023;
}

enum direction { TOWARDS_ZERO, DOWN, UP, HALF_AWAY, HALF_EVEN };

static double rounded(double x, enum direction direction) {
  uint64_t bits = double_bits(x), sign_bit = bits & DOUBLE_SIGN;
  int exponent = exponent_of(bits);
  if (exponent >= 52 || magnitude_of(bits) == 0)
    return canonical_double(x);
  if (exponent < -1) { /* below a half */
    int up = (direction == DOWN && sign_bit) || (direction == UP && !sign_bit);
    return bits_double(sign_bit | (up ? 0x3FF0000000000000u : 0));
  }
  /* In units of the last place: one is 1, and may exceed the significand by a bit where |x| < 1. */
  uint64_t one = (uint64_t)1 << (52 - exponent), fraction;
  uint64_t whole = exponent < 0 ? 0x3FE0000000000000u : bits & ~sign_bit & ~(one - 1);
  if (exponent < 0) { /* a half up to 1: whole is the half, so that adding it carries to 1 */
    uint64_t m = magnitude_of(bits);
    int to_one = direction == DOWN        ? sign_bit != 0
                 : direction == UP        ? !sign_bit
                 : direction == HALF_AWAY ? 1
                 : direction == HALF_EVEN ? m > whole
                                          : 0;
    return bits_double(sign_bit | (to_one ? 0x3FF0000000000000u : 0));
  }
  fraction = bits & (one - 1);
  int increment = 0;
  switch (direction) {
  case TOWARDS_ZERO:
    break;
  case DOWN:
    increment = fraction && sign_bit;
    break;
  case UP:
    increment = fraction && !sign_bit;
    break;
  case HALF_AWAY:
    increment = fraction >= one / 2;
    break;
  case HALF_EVEN:
    increment = fraction > one / 2 || (fraction == one / 2 && (exponent == 0 || bits & one));
    break;
  }
  return bits_double(sign_bit | (whole + (increment ? one : 0)));
}

double trunc(double x) {
  return rounded(x, TOWARDS_ZERO);
}
double floor(double x) {
  return rounded(x, DOWN);
}
double ceil(double x) {
  return rounded(x, UP);
}
double round(double x) {
  return rounded(x, HALF_AWAY);
}
double rint(double x) {
  return rounded(x, HALF_EVEN);
}
double nearbyint(double x) {
  return rounded(x, HALF_EVEN);
}

double fabs(double x) {
  return bits_double(magnitude_of(double_bits(x)));
}

double copysign(double x, double y) {
  return bits_double(magnitude_of(double_bits(x)) | (double_bits(y) & DOUBLE_SIGN));
}

/* -0 below +0, and the number if the other is a NaN, like the machine's own for floats. */
static int is_less(double x, double y) {
  int64_t a = (int64_t)double_bits(x), b = (int64_t)double_bits(y);
  a ^= a < 0 ? INT64_MAX : 0; /* now in the order of the numbers */
  b ^= b < 0 ? INT64_MAX : 0;
  return a < b;
}
static int is_nan_double(double x) {
  return magnitude_of(double_bits(x)) > DOUBLE_INFINITY;
}

static double chosen(double x, double y, int take_x) {
  if (is_nan_double(x))
    return is_nan_double(y) ? bits_double(DOUBLE_NAN) : y;
  return take_x || is_nan_double(y) ? x : y;
}

double fmin(double x, double y) {
  return chosen(x, y, is_less(x, y));
}
double fmax(double x, double y) {
  return chosen(x, y, is_less(y, x));
}

double modf(double x, double *integer) {
  *integer = trunc(x);
  uint64_t bits = double_bits(x);
  if (magnitude_of(bits) > DOUBLE_INFINITY)
    return *integer;
  return copysign(magnitude_of(bits) == DOUBLE_INFINITY ? 0 : x - *integer, x);
}

double frexp(double x, int *exponent) {
  uint64_t bits = double_bits(x), m = magnitude_of(bits);
  *exponent = 0;
  if (m == 0 || m >= DOUBLE_INFINITY)
    return canonical_double(x);
  int extra = 0;
  if (m < 0x0010000000000000u) { /* subnormal: its leading bit to the hidden one's place */
    extra = leading_zeros64(m) - 11;
    m <<= extra;
  }
  *exponent = (int)(m >> 52) - 1022 - extra;
  return bits_double((bits & DOUBLE_SIGN) | (m & 0x000FFFFFFFFFFFFFu) | 0x3FE0000000000000u);
}

double ldexp(double x, int exponent) {
  uint64_t bits = double_bits(x), m = magnitude_of(bits);
  if (m == 0 || m >= DOUBLE_INFINITY)
    return canonical_double(x);
  int old;
  double fraction = frexp(x, &old);
  exponent = exponent > 5000 ? 5000 : exponent < -5000 ? -5000 : exponent;
  uint64_t significand = (double_bits(fraction) & 0x000FFFFFFFFFFFFFu) | 0x0010000000000000u;
  return trax_round_double((uint32_t)(bits >> 63), old + exponent + 1022, significand << 10);
}

double scalbn(double x, int exponent) {
  return ldexp(x, exponent);
}
