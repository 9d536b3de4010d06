/* A ray, prepared once for its many tests. */
#ifndef TRAX_DEVICE_RAY_H
#define TRAX_DEVICE_RAY_H

#include "algebra.h"
#include "bits.h"
#include "nodes.h"
#include "trax/render_params.h"
#include "triangle.h"

#define LAYOUT_FILE "planes.h"
#include "layouts/table.def"

/* The distance in a node from a plane of a box to that of the next axis. */
static inline int plane_bytes(uint32_t layout) {
#define OF(kind)
#define OWN(kind)                                                                                                      \
  if (kind##_number == 0 || has_##kind##_planes(layout))                                                               \
    return kind##_step;
#define LAYOUT(number, NAME, name, general, planes, ...) planes
#include "layouts/table.def"
}

struct ray {
  struct box_ray box;
  /* The near planes of a box are its minima where the direction is positive, its maxima where it is negative. These are
     their offsets in a box (0, or the bytes of three planes), so that no test compares planes. */
  uint32_t near_offset_x, near_offset_y, near_offset_z;

  struct triangle_ray triangle;

#if TRAX_INSTANCES /* of the ray, and of the boxes in the scene */
  struct vector origin, direction;
  float margin;
#endif
};

/* A component of the direction for box tests. Zeros and negligible components keep their sign and become 2^-30 of the
   largest component, so that its reciprocal is finite and 0 * infinity cannot arise. The ray turns by no more than
   2^-30, less than the rounding that box_margin already allows for. */
static inline float away_from_zero(float component, int32_t least_bits) {
  return bits_float(larger(magnitude(component), least_bits) | (float_bits(component) & SIGN_BIT));
}

/* The power of two that scales a direction of any length but 0 into the range of prepare_ray. Distances along the
   scaled direction are those along the direction, divided by it. Rays of the ray tracer need no scaling. */
static inline float direction_scale(struct vector direction) {
  int32_t exponent = greatest_magnitude(direction) & 0x7F800000;
  return bits_float(larger(0x7F000000 - exponent, 0x00800000));
}

static inline float with_sign_of(float magnitude, float sign) {
  return bits_float(float_bits(magnitude) | (float_bits(sign) & SIGN_BIT));
}

/* The offset of a box's near plane for a component of the direction. */
static inline uint32_t near_offset(float component, uint32_t far_planes) {
  uint32_t offset = (uint32_t)(float_bits(component) >> 31) & far_planes;
  HIDE_ORIGIN(offset); /* else the negative offset would take another register */
  return offset;
}

/* Prepares a ray; the direction need not have unit length, but its largest component must be within 2^-21 and 2^40, so
   that the product below neither vanishes nor overflows. Binary nodes need no grid. */
static inline __attribute__((always_inline)) void prepare_ray(struct ray *ray, uint32_t layout, struct vector origin,
                                                              struct vector direction, float box_margin,
                                                              const struct trax_ray_grid *grid) {
  int32_t least = float_bits(bits_float(greatest_magnitude(direction)) * 0x1p-30f);
  struct vector way = {away_from_zero(direction.x, least), away_from_zero(direction.y, least),
                       away_from_zero(direction.z, least)};

  /* One division for the three reciprocals: the divider is shared by all TPs of a TM. The relative error of each is
     below 5 units of 2^-24. */
  float xy = way.x * way.y;
  float product = 1.0f / (xy * way.z);
  struct vector inverse = {way.y * way.z * product, way.x * way.z * product, xy * product};

#if TRAX_INSTANCES
  ray->origin = origin, ray->direction = direction, ray->margin = box_margin;
#endif
  const uint32_t far_planes = 3 * (uint32_t)plane_bytes(layout);
  ray->near_offset_x = near_offset(way.x, far_planes);
  ray->near_offset_y = near_offset(way.y, far_planes);
  ray->near_offset_z = near_offset(way.z, far_planes);
  struct vector margin = {with_sign_of(box_margin, way.x), with_sign_of(box_margin, way.y),
                          with_sign_of(box_margin, way.z)};
#define OF(kind)
#define OWN(kind)                                                                                                      \
  if (kind##_number == 0 || has_##kind##_planes(layout)) {                                                             \
    kind##_prepare(&ray->box, origin, inverse, margin, grid);                                                          \
  } else
#define LAYOUT(number, NAME, name, general, planes, ...) planes
#include "layouts/table.def"
  {
    __builtin_unreachable();
  }
  prepare_triangle_ray(&ray->triangle, origin, direction, inverse);
}

#endif
