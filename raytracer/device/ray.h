/* A ray, prepared once for the tests that it takes part in many times. */
#ifndef TRAX_DEVICE_RAY_H
#define TRAX_DEVICE_RAY_H

#include "algebra.h"
#include "bits.h"
#include "run.h"
#include "trax/render_params.h"
#include "triangle.h"

/* For boxes. A plane is at (plane - origin) * inverse, or, if it is a number on a grid, at plane * inverse - origin. */
struct box_ray {
  struct vector near_origin, far_origin, inverse;
};

struct ray {
  /* If nodes have frames of their own, still without what these add. */
  struct box_ray box;
  /* The near planes of a box are its minima where the direction is positive, its maxima where it is negative: where in
     a box they are (0, or as many bytes as three planes take), so that no test compares planes. */
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
static inline float direction_scale(struct vector direction) {
  int32_t exponent = greatest_magnitude(direction) & 0x7F800000;
  return bits_float(larger(0x7F000000 - exponent, 0x00800000));
}

/* A plane's number is used as a float as it is: that is the number times 2^-149, a subnormal, which this machine
   multiplies like any other. So it takes no instruction to convert, but its reciprocal 2^149 must be in the factors:
   distances along the ray are in units of 2^64 here, which keeps all of them within the range of floats as long as the
   direction's largest component is within 2^-2 and 2^10 and cells within 2^-44 and 2^6 (trax_normalise). In frames,
   whose planes are up to 2^9 cells apart, the units are 2^72, and the factor has 2^149 by the frame's word. */
static inline struct vector plane_scaled(struct vector v) {
  return times(0x1p74f, times(0x1p75f, v));
}

#define DISTANCE_EXPONENT(layout) (NODES_HAVE_FRAMES(layout) ? 72 : 64)
#define DISTANCE_SCALE(layout) (NODES_HAVE_FRAMES(layout) ? 0x1p-72f : 0x1p-64f)

/* A distance in those units, as bits; what is nearly 0 becomes a little more. */
static inline int32_t distance_on_grid(uint32_t layout, int32_t distance_bits) {
  return larger(distance_bits - (DISTANCE_EXPONENT(layout) << 23), 0x00800000);
}

static inline float with_sign_of(float magnitude, float sign) {
  return bits_float(float_bits(magnitude) | (float_bits(sign) & SIGN_BIT));
}

/* Where a box's near plane is for a component of the direction. */
static inline uint32_t near_offset(float component, uint32_t far_planes) {
  uint32_t offset = (uint32_t)(float_bits(component) >> 31) & far_planes;
  HIDE_ORIGIN(offset); /* else its negative would take a register, too */
  return offset;
}

/* Prepares a ray; the direction need not have unit length, but its largest component must be within 2^-21 and 2^40, so
   that the product below neither vanishes nor overflows. grid: of quantised nodes, else NULL. */
static inline __attribute__((always_inline)) void prepare_ray(struct ray *ray, uint32_t layout, struct vector origin,
                                                              struct vector direction, float box_margin,
                                                              const struct trax_ray_grid *grid) {
  int32_t least = float_bits(bits_float(greatest_magnitude(direction)) * 0x1p-30f);
  struct vector way = {away_from_zero(direction.x, least), away_from_zero(direction.y, least),
                       away_from_zero(direction.z, least)};

  /* One division for the three reciprocals: the divider is shared by all TPs of a TM. Each is within 5 units of 2^-24,
     relatively. */
  float xy = way.x * way.y;
  float product = 1.0f / (xy * way.z);
  struct vector inverse = {way.y * way.z * product, way.x * way.z * product, xy * product};

  const uint32_t far_planes = 3 * NODE_PLANE_BYTES(layout);
  ray->near_offset_x = near_offset(way.x, far_planes);
  ray->near_offset_y = near_offset(way.y, far_planes);
  ray->near_offset_z = near_offset(way.z, far_planes);
  struct vector margin = {with_sign_of(box_margin, way.x), with_sign_of(box_margin, way.y),
                          with_sign_of(box_margin, way.z)};
  if (grid) {
    struct vector cell = times(DISTANCE_SCALE(layout), load_vector(grid->cell));
    struct vector step = times(DISTANCE_SCALE(layout), inverse), from = minus(origin, load_vector(grid->origin));
    ray->box.near_origin = filtered(plus(from, margin), step);
    ray->box.far_origin = filtered(minus(from, margin), step);
    ray->box.inverse = filtered(inverse, cell);
    if (NODES_HAVE_FRAMES(layout)) {
      struct vector bias = times(TRAX_FRAME_BIAS, ray->box.inverse);
      ray->box.near_origin = plus(ray->box.near_origin, bias);
      ray->box.far_origin = plus(ray->box.far_origin, bias);
    } else {
      ray->box.inverse = plane_scaled(ray->box.inverse);
    }
  } else {
    ray->box.inverse = inverse;
    ray->box.near_origin = plus(origin, margin);
    ray->box.far_origin = minus(origin, margin);
  }

  prepare_triangle_ray(&ray->triangle, origin, direction, inverse);
}

#endif
