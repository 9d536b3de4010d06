/* Arithmetic of vectors. Sums are in the order written, x first. */
#ifndef TRAX_DEVICE_ALGEBRA_H
#define TRAX_DEVICE_ALGEBRA_H

#include "bits.h"
#include "vector.h"

#include <trax.h>

static inline struct vector load_vector(const float *from) {
  return (struct vector){from[0], from[1], from[2]};
}

static inline struct vector plus(struct vector a, struct vector b) {
  return (struct vector){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline struct vector minus(struct vector a, struct vector b) {
  return (struct vector){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline struct vector times(float factor, struct vector v) {
  return (struct vector){factor * v.x, factor * v.y, factor * v.z};
}

/* The product of two colours, component by component. */
static inline struct vector filtered(struct vector a, struct vector b) {
  return (struct vector){a.x * b.x, a.y * b.y, a.z * b.z};
}

static inline float dot(struct vector a, struct vector b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct vector cross(struct vector a, struct vector b) {
  return (struct vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* The bits of the greatest component. No component may be negative. */
static inline int32_t greatest_bits(struct vector v) {
  return larger(larger(float_bits(v.x), float_bits(v.y)), float_bits(v.z));
}

/* The bits of the greatest component's magnitude. */
static inline int32_t greatest_magnitude(struct vector v) {
  return larger(larger(magnitude(v.x), magnitude(v.y)), magnitude(v.z));
}

static inline float at_least(float value, float least) {
  return bits_float(larger(float_bits(value), float_bits(least))); /* least is not negative, value is no NaN */
}

static inline float at_most(float value, float most) {
  return bits_float(float_bits(value) < float_bits(most) ? float_bits(value) : float_bits(most)); /* both positive */
}

/* The square root. 0 for negative numbers, and for those below 2^-80, whose reciprocals would be large. */
static inline float root(float square) {
  return float_bits(square) < float_bits(0x1p-80f) ? 0 : square * trax_rsqrt(square);
}

/* v scaled to unit length; v must be longer than 2^-40. */
static inline struct vector unit(struct vector v) {
  return times(trax_rsqrt(dot(v, v)), v);
}

/* Two directions that make an orthonormal system with n, which is of unit length: Duff and others, "Building an
   Orthonormal Basis, Revisited" (JCGT 6(1), 2017). */
static inline void tangents(struct vector n, struct vector *s, struct vector *t) {
  float sign = bits_float(float_bits(1.0f) | (float_bits(n.z) & SIGN_BIT));
  float a = -1.0f / (sign + n.z), b = n.x * n.y * a;
  *s = (struct vector){1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
  *t = (struct vector){b, sign + n.y * n.y * a, -n.y};
}

#endif
