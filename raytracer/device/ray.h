/* A ray, prepared once for the tests that it takes part in many times. */
#ifndef TRAX_DEVICE_RAY_H
#define TRAX_DEVICE_RAY_H

#include "bits.h"
#include "run.h"
#include "trax/render_params.h"
#include "triangle.h"

/* For boxes. A plane is at (plane - origin) * inverse, or, if it is a number on a grid, at plane * inverse - origin. */
struct box_ray {
  float near_origin_x, near_origin_y, near_origin_z;
  float far_origin_x, far_origin_y, far_origin_z;
  float inverse_x, inverse_y, inverse_z;
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
static inline float direction_scale(float dx, float dy, float dz) {
  int32_t exponent = larger(larger(magnitude(dx), magnitude(dy)), magnitude(dz)) & 0x7F800000;
  return bits_float(larger(0x7F000000 - exponent, 0x00800000));
}

/* A plane's number is used as a float as it is: that is the number times 2^-149, a subnormal, which this machine
   multiplies like any other. So it takes no instruction to convert, but its reciprocal 2^149 must be in the factors:
   distances along the ray are in units of 2^64 here, which keeps all of them within the range of floats as long as the
   direction's largest component is within 2^-2 and 2^10 and cells within 2^-44 and 2^6 (trax_normalise). In frames,
   whose planes are up to 2^9 cells apart, the units are 2^72, and the factor has 2^149 by the frame's word. */
#define PLANE_SCALE 0x1p75f * 0x1p74f
#define DISTANCE_EXPONENT(layout) (NODES_HAVE_FRAMES(layout) ? 72 : 64)
#define DISTANCE_SCALE(layout) (NODES_HAVE_FRAMES(layout) ? 0x1p-72f : 0x1p-64f)

/* A distance in those units, as bits; what is nearly 0 becomes a little more. */
static inline int32_t distance_on_grid(uint32_t layout, int32_t distance_bits) {
  return larger(distance_bits - (DISTANCE_EXPONENT(layout) << 23), 0x00800000);
}

static inline float with_sign_of(float magnitude, float sign) {
  return bits_float(float_bits(magnitude) | (float_bits(sign) & SIGN_BIT));
}

/* Prepares the ray that starts at (ox, oy, oz); the direction need not have unit length, but its largest component must
   be within 2^-21 and 2^40, so that the product below neither vanishes nor overflows. grid: of
   quantised nodes, else NULL. */
static inline void prepare_ray(struct ray *ray, uint32_t layout, float ox, float oy, float oz, float dx, float dy,
                               float dz, float box_margin, const struct trax_ray_grid *grid) {
  int32_t size_x = magnitude(dx), size_y = magnitude(dy), size_z = magnitude(dz);
  int32_t size = larger(larger(size_x, size_y), size_z);
  int32_t least = float_bits(bits_float(size) * 0x1p-30f);
  float cx = away_from_zero(dx, least), cy = away_from_zero(dy, least), cz = away_from_zero(dz, least);

  /* One division for the three reciprocals: the divider is shared by all TPs of a TM. Each is within 5 units of 2^-24,
     relatively. */
  float xy = cx * cy;
  float product = 1.0f / (xy * cz);
  float inverse_x = cy * cz * product, inverse_y = cx * cz * product, inverse_z = xy * product;

  const int far_planes = 3 * NODE_PLANE_BYTES(layout);
  ray->near_offset_x = float_bits(cx) >> 31 & far_planes;
  ray->near_offset_y = float_bits(cy) >> 31 & far_planes;
  ray->near_offset_z = float_bits(cz) >> 31 & far_planes;
  HIDE_ORIGIN(ray->near_offset_x); /* else their negatives would take registers, too */
  HIDE_ORIGIN(ray->near_offset_y);
  HIDE_ORIGIN(ray->near_offset_z);
  if (grid) {
    float cell_x = grid->cell[0] * DISTANCE_SCALE(layout), cell_y = grid->cell[1] * DISTANCE_SCALE(layout);
    float cell_z = grid->cell[2] * DISTANCE_SCALE(layout);
    float from_x = ox - grid->origin[0], from_y = oy - grid->origin[1], from_z = oz - grid->origin[2];
    float margin_x = with_sign_of(box_margin, cx), margin_y = with_sign_of(box_margin, cy);
    float margin_z = with_sign_of(box_margin, cz);
    float step_x = inverse_x * DISTANCE_SCALE(layout), step_y = inverse_y * DISTANCE_SCALE(layout),
          step_z = inverse_z * DISTANCE_SCALE(layout);
    ray->box.near_origin_x = (from_x + margin_x) * step_x, ray->box.far_origin_x = (from_x - margin_x) * step_x;
    ray->box.near_origin_y = (from_y + margin_y) * step_y, ray->box.far_origin_y = (from_y - margin_y) * step_y;
    ray->box.near_origin_z = (from_z + margin_z) * step_z, ray->box.far_origin_z = (from_z - margin_z) * step_z;
    if (NODES_HAVE_FRAMES(layout)) {
      ray->box.inverse_x = inverse_x * cell_x, ray->box.inverse_y = inverse_y * cell_y;
      ray->box.inverse_z = inverse_z * cell_z;
      float bias_x = ray->box.inverse_x * TRAX_FRAME_BIAS, bias_y = ray->box.inverse_y * TRAX_FRAME_BIAS;
      float bias_z = ray->box.inverse_z * TRAX_FRAME_BIAS;
      ray->box.near_origin_x += bias_x, ray->box.far_origin_x += bias_x;
      ray->box.near_origin_y += bias_y, ray->box.far_origin_y += bias_y;
      ray->box.near_origin_z += bias_z, ray->box.far_origin_z += bias_z;
    } else {
      ray->box.inverse_x = inverse_x * cell_x * PLANE_SCALE, ray->box.inverse_y = inverse_y * cell_y * PLANE_SCALE;
      ray->box.inverse_z = inverse_z * cell_z * PLANE_SCALE;
    }
  } else {
    float margin_x = with_sign_of(box_margin, cx), margin_y = with_sign_of(box_margin, cy);
    float margin_z = with_sign_of(box_margin, cz);
    ray->box.inverse_x = inverse_x, ray->box.inverse_y = inverse_y, ray->box.inverse_z = inverse_z;
    ray->box.near_origin_x = ox + margin_x, ray->box.far_origin_x = ox - margin_x;
    ray->box.near_origin_y = oy + margin_y, ray->box.far_origin_y = oy - margin_y;
    ray->box.near_origin_z = oz + margin_z, ray->box.far_origin_z = oz - margin_z;
  }

  prepare_triangle_ray(&ray->triangle, ox, oy, oz, dx, dy, dz, inverse_x, inverse_y, inverse_z);
}

#endif
