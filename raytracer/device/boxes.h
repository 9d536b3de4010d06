/* Whether a ray enters a box, and where. A box is tested one plane at a time. The test stops at the first plane that
   rules out a hit. All comparisons are of integers. So a child costs 1 to 6 adds and multiplies, and a load for each
   plane that is tested. */
#ifndef TRAX_DEVICE_BOXES_H
#define TRAX_DEVICE_BOXES_H

#include "ray.h"

#include <stdbool.h>

/* The bits of a plane's distance along the ray. */
static inline __attribute__((always_inline)) int32_t plane_distance(uint32_t layout, const char *plane, float origin,
                                                                    float inverse) {
#define OF(kind)
#define OWN(kind)                                                                                                      \
  if (kind##_number == 0 || has_##kind##_planes(layout))                                                               \
    return kind##_plane(plane, origin, inverse);
#define LAYOUT(number, NAME, name, general, planes, ...) planes
#include "layouts/table.def"
}

/* A distance in the unit of the planes' distances. */
static inline __attribute__((always_inline)) int32_t limit_of(uint32_t layout, int32_t distance_bits) {
#define OF(kind)
#define OWN(kind)                                                                                                      \
  if (kind##_number == 0 || has_##kind##_planes(layout))                                                               \
    return kind##_unit ? distance_in_units(distance_bits, kind##_unit) : distance_bits;
#define LAYOUT(number, NAME, name, general, planes, ...) planes
#include "layouts/table.def"
}

/* place - offset, by integers: for pointers the compiler would keep -offset in a register of its own. */
static inline __attribute__((always_inline)) const char *before(const char *place, uint32_t offset) {
  return (const char *)((uintptr_t)place - offset);
}

/* The bits of the distance at which the ray enters a box of a node, if that is before `limit`. `box` is the offset of
   the box's planes in the node.

   Distances are compared as integers, which is wrong for two negative ones. But any entry before 0 is as good as
   another, and a box whose exit distance is negative is missed: as an integer, the near plane's negative distance is
   the greater of an axis's two. */
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
