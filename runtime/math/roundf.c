/* Rounding to integers in binary32. From 2^23 on every float is one. */
#include "../internal/bits.h"

#include <math.h>

INLINE float magnitude_of(float x) {
  return bits_float(float_bits(x) & ~FLOAT_SIGN);
}
/* y's magnitude with x's sign: keeps the sign of zeros and of what rounds to zero. */
INLINE float signed_like(float y, float x) {
  return bits_float((float_bits(y) & ~FLOAT_SIGN) | (float_bits(x) & FLOAT_SIGN));
}
INLINE int is_integer_already(float x) {
  return !(magnitude_of(x) < 0x1p23f);
} /* NaNs too */

float truncf(float x) {
  return is_integer_already(x) ? canonical_float(x) : signed_like((float)(int)x, x);
}

float floorf(float x) {
  if (is_integer_already(x))
    return canonical_float(x);
  float t = (float)(int)x;
  return signed_like(t - (float)(t > x), x);
}

float ceilf(float x) {
  if (is_integer_already(x))
    return canonical_float(x);
  float t = (float)(int)x;
  return signed_like(t + (float)(t < x), x);
}

float roundf(float x) {
  if (is_integer_already(x))
    return canonical_float(x);
  float a = magnitude_of(x), t = (float)(int)a;
  return signed_like(t + (float)(a - t >= 0.5f), x);
}

/* Adding 2^23 rounds as the machine rounds, to nearest even. */
float rintf(float x) {
  return is_integer_already(x) ? canonical_float(x) : signed_like((magnitude_of(x) + 0x1p23f) - 0x1p23f, x);
}

float nearbyintf(float x) {
  return rintf(x);
}

long lroundf(float x) {
  return (long)roundf(x);
}

long lrintf(float x) {
  return (long)rintf(x);
}

long long llroundf(float x) {
  return (long long)roundf(x);
}

long long llrintf(float x) {
  return (long long)rintf(x);
}
