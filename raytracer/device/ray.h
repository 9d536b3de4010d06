/* A ray, prepared once for the tests that it takes part in many times. */
#ifndef TRAX_DEVICE_RAY_H
#define TRAX_DEVICE_RAY_H

#include "bits.h"
#include "triangle.h"

struct ray {
  /* For boxes. The near planes of a box are its minima where the direction is positive, its maxima where it is
     negative; near_offset is where in struct trax_bvh_node's box they are (0 or 12 bytes), so that no test compares
     planes. */
  float near_origin_x, near_origin_y, near_origin_z;
  float far_origin_x, far_origin_y, far_origin_z;
  float inverse_x, inverse_y, inverse_z;
  uint32_t near_offset_x, near_offset_y, near_offset_z;

  struct triangle_ray triangle;
};

/* A component of the direction for box tests: zeros, and what is as good as zero, keep their sign and become 2^-30 of
   the largest component, so that its reciprocal is finite and 0 * infinity cannot arise. The ray turns by no more than
   2^-30, less than the rounding that box_margin already allows for. */
static inline float away_from_zero(float component, int32_t least_bits) {
  return bits_float(larger(magnitude(component), least_bits) | (float_bits(component) & SIGN_BIT));
}

/* What brings a direction of any length but 0 into the range that prepare_ray asks for: a power of two, so distances
   along the scaled direction are those along the direction divided by it. Rays of the ray tracer need none. */
static inline float direction_scale(float dx, float dy, float dz) {
  int32_t exponent = larger(larger(magnitude(dx), magnitude(dy)), magnitude(dz)) & 0x7F800000;
  return bits_float(larger(0x7F000000 - exponent, 0x00800000));
}

/* Prepares the ray that starts at (ox, oy, oz); the direction need not have unit length, but its largest component must
   be within 2^-21 and 2^40, so that the product below neither vanishes nor overflows. */
static inline void prepare_ray(struct ray *ray, float ox, float oy, float oz, float dx, float dy, float dz,
                               float box_margin) {
  int32_t size_x = magnitude(dx), size_y = magnitude(dy), size_z = magnitude(dz);
  int32_t size = larger(larger(size_x, size_y), size_z);
  int32_t least = float_bits(bits_float(size) * 0x1p-30f);
  float cx = away_from_zero(dx, least), cy = away_from_zero(dy, least), cz = away_from_zero(dz, least);

  /* One division for the three reciprocals: the divider is shared by all TPs of a TM. Each is within 5 units of 2^-24,
     relatively. */
  float xy = cx * cy;
  float product = 1.0f / (xy * cz);
  float inverse_x = cy * cz * product, inverse_y = cx * cz * product, inverse_z = xy * product;

  ray->inverse_x = inverse_x, ray->inverse_y = inverse_y, ray->inverse_z = inverse_z;
  ray->near_offset_x = float_bits(cx) >> 31 & 12;
  ray->near_offset_y = float_bits(cy) >> 31 & 12;
  ray->near_offset_z = float_bits(cz) >> 31 & 12;
  HIDE_ORIGIN(ray->near_offset_x); /* else their negatives would take registers, too */
  HIDE_ORIGIN(ray->near_offset_y);
  HIDE_ORIGIN(ray->near_offset_z);
  float margin_x = bits_float(float_bits(box_margin) | (float_bits(cx) & SIGN_BIT));
  float margin_y = bits_float(float_bits(box_margin) | (float_bits(cy) & SIGN_BIT));
  float margin_z = bits_float(float_bits(box_margin) | (float_bits(cz) & SIGN_BIT));
  ray->near_origin_x = ox + margin_x, ray->far_origin_x = ox - margin_x;
  ray->near_origin_y = oy + margin_y, ray->far_origin_y = oy - margin_y;
  ray->near_origin_z = oz + margin_z, ray->far_origin_z = oz - margin_z;

  prepare_triangle_ray(&ray->triangle, ox, oy, oz, dx, dy, dz, inverse_x, inverse_y, inverse_z);
}

#endif
