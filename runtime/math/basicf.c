/* Functions without arithmetic: signs, order, parts of the representation. */
#include "../internal/bits.h"

#include <math.h>

#define MAGNITUDE 0x7FFFFFFFu

float fabsf(float x) {
  return bits_float(float_bits(x) & MAGNITUDE);
}

float copysignf(float x, float y) {
  return bits_float((float_bits(x) & MAGNITUDE) | (float_bits(y) & FLOAT_SIGN));
}

/* The machine's own minimum and maximum, which count -0 below +0. */
#ifdef __trax__
float fminf(float x, float y) {
  return __builtin_fminf(x, y);
}
float fmaxf(float x, float y) {
  return __builtin_fmaxf(x, y);
}
#else
float fminf(float x, float y) {
  if (x != x || y != y)
    return x == x ? x : y == y ? y : bits_float(FLOAT_NAN);
  return x < y || (x == y && float_bits(x) >> 31) ? x : y;
}
float fmaxf(float x, float y) {
  if (x != x || y != y)
    return x == x ? x : y == y ? y : bits_float(FLOAT_NAN);
  return x > y || (x == y && float_bits(y) >> 31) ? x : y;
}
#endif

float fdimf(float x, float y) {
  return x <= y ? 0 : x - y;
}

float modff(float x, float *integer) {
  *integer = truncf(x);
  if (x != x)
    return *integer;
  return copysignf(fabsf(x) == HUGE_VALF ? 0 : x - *integer, x);
}

/* The exponent of a finite number that is not 0: 1 <= |x| * 2^-exponent < 2. */
static int exponent_of(uint32_t magnitude) {
  return magnitude >= 0x00800000 ? (int)(magnitude >> 23) - 127 : -118 - leading_zeros(magnitude);
}

float frexpf(float x, int *exponent) {
  uint32_t magnitude = float_bits(x) & MAGNITUDE;
  *exponent = 0;
  if (magnitude - 1 >= FLOAT_INFINITY - 1)
    return canonical_float(x);
  *exponent = exponent_of(magnitude) + 1;
  return ldexpf(x, -*exponent);
}

/* Two multiplications with powers of two reach everywhere; only the last one may round. */
float ldexpf(float x, int exponent) {
  if (exponent > 0) {
    for (int i = 0; i < 2 && exponent > 127; i++, exponent -= 127)
      x *= 0x1p127f;
    exponent = exponent > 127 ? 127 : exponent;
  } else {
    /* Down in steps that leave 24 bits above the subnormals, so that nothing rounds twice. */
    for (int i = 0; i < 2 && exponent < -126; i++, exponent += 102)
      x *= 0x1p-102f;
    exponent = exponent < -126 ? -126 : exponent;
  }
  return x * bits_float((uint32_t)(exponent + 127) << 23);
}

float scalbnf(float x, int exponent) {
  return ldexpf(x, exponent);
}

float scalblnf(float x, long exponent) {
  return ldexpf(x, exponent > 1000 ? 1000 : exponent < -1000 ? -1000 : (int)exponent);
}

int ilogbf(float x) {
  uint32_t magnitude = float_bits(x) & MAGNITUDE;
  if (magnitude == 0)
    return FP_ILOGB0;
  if (magnitude >= FLOAT_INFINITY)
    return magnitude == FLOAT_INFINITY ? 0x7FFFFFFF : FP_ILOGBNAN;
  return exponent_of(magnitude);
}

float logbf(float x) {
  uint32_t magnitude = float_bits(x) & MAGNITUDE;
  if (magnitude == 0)
    return -HUGE_VALF;
  if (magnitude >= FLOAT_INFINITY)
    return x * x;
  return (float)exponent_of(magnitude);
}

float nextafterf(float x, float y) {
  uint32_t a = float_bits(x), b = float_bits(y);
  if (x != x || y != y)
    return bits_float(FLOAT_NAN);
  if (x == y)
    return y;
  if ((a & MAGNITUDE) == 0)
    return bits_float((b & FLOAT_SIGN) | 1);
  return bits_float((x < y) == !(a >> 31) ? a + 1 : a - 1);
}

float nexttowardf(float x, long double y) {
  uint32_t a = float_bits(x);
  if (x != x || y != y)
    return bits_float(FLOAT_NAN);
  if ((long double)x == y)
    return (float)y;
  if ((a & MAGNITUDE) == 0)
    return bits_float((y < 0 ? FLOAT_SIGN : 0) | 1);
  return bits_float(((long double)x < y) == !(a >> 31) ? a + 1 : a - 1);
}

float nanf(const char *payload) {
  (void)payload;
  return bits_float(FLOAT_NAN);
}
