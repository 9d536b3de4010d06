/* Whether a ray enters a box, and where. Boxes are tested plane by plane and left behind each plane by which the ray is
   known to miss, and all comparisons are of integers: a node costs between 1 and 6 adds and multiplies a child, and a
   load for each plane. */
#ifndef TRAX_DEVICE_BOXES_H
#define TRAX_DEVICE_BOXES_H

#include "ray.h"

#include <stdbool.h>

/* Where along the ray a plane is, as bits. */
static inline __attribute__((always_inline)) int32_t plane_distance(uint32_t layout, const char *plane, float origin,
                                                                    float inverse) {
  return nodes_are_quantised(layout) ? quantised_plane(plane, origin, inverse) : binary_plane(plane, origin, inverse);
}

/* A distance as planes have it. */
static inline __attribute__((always_inline)) int32_t limit_of(uint32_t layout, int32_t distance_bits) {
  return nodes_are_quantised(layout) ? distance_on_grid(distance_bits) : distance_bits;
}

/* As integers, since the compiler would keep the negative of a pointer's offset in a register of its own. */
static inline __attribute__((always_inline)) const char *before(const char *place, uint32_t offset) {
  return (const char *)((uintptr_t)place - offset);
}

/* Where the ray enters a box of a node, as bits, if it does so before `limit`. `box` is where in the node its planes
   are.

   Distances are compared as integers. Of two negative ones that may go wrong, but to enter anywhere before 0 is as good
   as another place, and who leaves before 0 has missed: of an axis's two negative distances the near plane's is the
   greater. */
static inline __attribute__((always_inline)) bool enter_box(uint32_t layout, const char *node, int box,
                                                            const struct ray *ray, int32_t limit, int32_t *enter) {
  const struct box_ray *way = &ray->box;
  const int plane = plane_bytes(layout), x = box, y = x + plane, z = y + plane, far = 3 * plane;

  const char *near_x = node + ray->near_offset_x;
  int32_t latest = plane_distance(layout, near_x + x, way->near_origin.x, way->inverse.x);
  if (latest > limit)
    return false;
  const char *far_x = before(node, ray->near_offset_x);
  int32_t leave = plane_distance(layout, far_x + x + far, way->far_origin.x, way->inverse.x);
  if (leave < latest)
    return false;
  leave = smaller(leave, limit);

  const char *near_y = node + ray->near_offset_y;
  int32_t near_bits = plane_distance(layout, near_y + y, way->near_origin.y, way->inverse.y);
  if (near_bits > leave)
    return false;
  latest = larger(latest, near_bits);
  const char *far_y = before(node, ray->near_offset_y);
  int32_t far_bits = plane_distance(layout, far_y + y + far, way->far_origin.y, way->inverse.y);
  if (far_bits < latest)
    return false;
  leave = smaller(leave, far_bits);

  const char *near_z = node + ray->near_offset_z;
  near_bits = plane_distance(layout, near_z + z, way->near_origin.z, way->inverse.z);
  if (near_bits > leave)
    return false;
  *enter = larger(latest, near_bits);
  const char *far_z = before(node, ray->near_offset_z);
  return plane_distance(layout, far_z + z + far, way->far_origin.z, way->inverse.z) >= *enter;
}

#endif
