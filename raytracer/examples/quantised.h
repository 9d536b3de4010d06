/* The parts of step 5 that later steps keep: rays, quantised boxes, and the check of the scene. */
#ifndef TRAX_EXAMPLES_QUANTISED_H
#define TRAX_EXAMPLES_QUANTISED_H

#include "layouts/records.h"

typedef struct trax_triangle triangle_record;
#include "one-division.h"

struct ray {
  struct vector origin, direction; /* of unit length */
  struct vector factor, start;     /* a plane is at plane * factor - start along the ray, divided by 2^64 */
  int near_x, near_y, near_z; /* bytes from a box's minima to its nearer planes: 0, or 6 if the direction is negative */
};

/* The bits of the distance along the ray to a plane. The number of 16 bits is used as a float without a conversion: a
   subnormal, the number times 2^-149, which the machine multiplies like any other. */
static inline int plane_bits(const char *plane, float factor, float start) {
  return bits(value(*(const uint16_t *)plane) * factor - start);
}

/* Clips the way of a ray through a box to the slab between two planes. False: nothing of it is left. */
static inline bool clip(const char *near, const char *far, float factor, float start, int *enter, int *leave) {
  int near_bits = plane_bits(near, factor, start), far_bits = plane_bits(far, factor, start);
  if (near_bits > *enter)
    *enter = near_bits;
  if (far_bits < *leave)
    *leave = far_bits;
  return *enter <= *leave;
}

/* Whether the ray hits the box before `nearest`, and where it enters it: the slabs of Kay and Kajiya (SIGGRAPH 1986).
   All distances are bits. The way begins at 0, so of two that are compared one is never negative. */
static inline bool hit_box(const struct ray *ray, const uint16_t *box, int nearest, int *enter) {
  const char *min = (const char *)box, *max = (const char *)(box + 3);
  int leave = nearest;
  *enter = 0;
  return clip(min + ray->near_x, max - ray->near_x, ray->factor.x, ray->start.x, enter, &leave) &&
         clip(min + 2 + ray->near_y, max + 2 - ray->near_y, ray->factor.y, ray->start.y, enter, &leave) &&
         clip(min + 4 + ray->near_z, max + 4 - ray->near_z, ray->factor.z, ray->start.z, enter, &leave);
}

/* The bits of a distance in the units of boxes, 2^64: the exponent is 64 less. */
static inline int in_units_of_boxes(float distance) {
  return larger(bits(distance) - (64 << 23), bits(0x1p-126f));
}

static inline int far_first(float component) {
  return component < 0 ? 6 : 0;
}

/* The factor contains 2^149, since planes are subnormals. Distances are divided by 2^64, so that all values stay within
   the range of floats. */
static inline struct ray make_ray(const struct trax_render_params *frame, struct vector origin,
                                  struct vector direction) {
  const struct trax_ray_grid *grid = &frame->grid;
  float x = direction.x, y = direction.y, z = direction.z, product = x * y * z;
  if ((bits(product) & ~SIGN_BIT) < bits(0x1p-30f)) { /* along an axis or a plane of two, or nearly so: rarely */
    x = away_from_zero(x), y = away_from_zero(y), z = away_from_zero(z);
    product = x * y * z;
  }
  float reciprocal = 1 / product * 0x1p-64f;
  struct vector inverse = {y * z * reciprocal, x * z * reciprocal, x * y * reciprocal};
  struct vector factor = scale(scale(multiply(inverse, load(grid->cell)), 0x1p75f), 0x1p74f);
  struct vector start = multiply(subtract(origin, load(grid->origin)), inverse);
  return (struct ray){origin, direction, factor, start, far_first(x), far_first(y), far_first(z)};
}

static inline void check_input(const struct trax_render_params *frame, const struct trax_scene_header *header) {
  check_workload(frame);
  if (frame->node_layout != TRAX_NODES_QUANTISED)
    trax_abort("this program needs a scene of quantised nodes (trax-scene --nodes quantised)");
  if (header->root == 0 || header->max_depth > TRAX_SCENE_DEFAULT_DEPTH)
    trax_abort("this program needs a scene with triangles, no deeper than its stack (trax-scene --depth)");
}

#endif
