/* Functions of the library whose types are not float(float) or float(float, float), as such; for the TP and for the
   host, where the library's names have a prefix. */
#ifndef TRAX_TEST_ACCURACY_ADAPTED_H
#define TRAX_TEST_ACCURACY_ADAPTED_H

#include <math.h>

#ifdef __trax__
#include <trax.h>
#define OURS(name) name
#else
#include <trax/semantics.h>
#define OURS(name) rt_##name
long rt_lroundf(float);
long rt_lrintf(float);
long long rt_llroundf(float);
long long rt_llrintf(float);
int rt_ilogbf(float);
float rt_frexpf(float, int *);
float rt_modff(float, float *);
float rt_remquof(float, float, int *);
float rt_ldexpf(float, int);
static inline float rt_trax_rsqrt(float x) {
  return trax_to_float(trax_frsqrt(trax_from_float(x)));
}
#endif

#ifdef __trax__ /* for their cost */
static inline float adapted_lroundf(float x) {
  return (float)lroundf(x);
}
static inline float adapted_lrintf(float x) {
  return (float)lrintf(x);
}
static inline float adapted_llroundf(float x) {
  return (float)(int)llroundf(x);
}
static inline float adapted_llrintf(float x) {
  return (float)(int)llrintf(x);
}
static inline float adapted_frexpf(float x) {
  int exponent;
  return frexpf(x, &exponent);
}
static inline float adapted_modff(float x) {
  float integer;
  return modff(x, &integer);
}
static inline float adapted_remquof(float x, float y) {
  int quotient;
  return remquof(x, y, &quotient);
}
#else
/* Rounded floats are floats, so the conversion back is exact. C says nothing about results that the type does not have.
 */
static inline float adapted_lroundf(float x) {
  return x >= -0x1p31f && x < 0x1p31f ? (float)rt_lroundf(x) : NAN;
}
static inline float adapted_lrintf(float x) {
  return x >= -0x1p31f && x < 0x1p31f ? (float)rt_lrintf(x) : NAN;
}
static inline float adapted_llroundf(float x) {
  return x >= -0x1p63f && x < 0x1p63f ? (float)rt_llroundf(x) : NAN;
}
static inline float adapted_llrintf(float x) {
  return x >= -0x1p63f && x < 0x1p63f ? (float)rt_llrintf(x) : NAN;
}

/* x again from both results, if the fraction is in its range. */
static inline float adapted_frexpf(float x) {
  int exponent = 0;
  float fraction = rt_frexpf(x, &exponent);
  if (x == 0 || x - x != 0)
    return fraction;
  return fabsf(fraction) >= 0.5f && fabsf(fraction) < 1 ? ldexpf(fraction, exponent) : NAN;
}
/* The fraction; a wrong integer gives a NaN. */
static inline float adapted_modff(float x) {
  float integer = NAN, fraction = rt_modff(x, &integer);
  if (x != x)
    return fraction;
  return integer == truncf(x) && !signbit(integer) == !signbit(x) ? fraction : NAN;
}
/* The remainder; wrong low bits of the quotient give a NaN. */
static inline float adapted_remquof(float x, float y) {
  int quotient = 0, expected = 0;
  float remainder = rt_remquof(x, y, &quotient);
  remquof(x, y, &expected);
  return remainder != remainder || (quotient & 7) == (expected & 7) ? remainder : NAN;
}
#endif

static inline float adapted_ilogbf(float x) {
  return (float)OURS(ilogbf)(x);
}
static inline float adapted_trax_rsqrt(float x) {
  return OURS(trax_rsqrt)(x);
}
/* An exponent of either sign in and somewhat beyond the range in which results are finite. */
static inline int exponent_operand(float y) {
  return y - y == 0 && fabsf(y) < 0x1p24f ? (int)(y * 4) % 512 : 0;
}
static inline float adapted_ldexpf(float x, float y) {
  return OURS(ldexpf)(x, exponent_operand(y));
}

#endif
