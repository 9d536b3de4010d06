/* Whether a ray enters a box, and where. Boxes are tested plane by plane and left as soon as the ray is known to miss,
   and all comparisons are of integers: a node costs between 2 and 6 adds and multiplies a child, and a load for each
   plane. */
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

/* Clips the ray's way through a box to the slab between two of its planes. False: nothing of it remains. Distances are
   compared as integers. Of two negative ones that may go wrong, but to enter anywhere before 0 is as good as another
   place, and who leaves before 0 has missed in any case, which is asked at the end. */
static inline __attribute__((always_inline)) bool clip_to_slab(uint32_t layout, const char *near, const char *far,
                                                               float near_origin, float far_origin, float inverse,
                                                               int32_t *enter, int32_t *leave) {
  int32_t near_bits = plane_distance(layout, near, near_origin, inverse);
  int32_t far_bits = plane_distance(layout, far, far_origin, inverse);
  if (near_bits > *enter)
    *enter = near_bits;
  if (far_bits < *leave)
    *leave = far_bits;
  return *enter <= *leave;
}

/* Where the ray enters a box, as bits, if it does so before `limit`. */
static inline __attribute__((always_inline)) bool enter_box(uint32_t layout, const char *box, const struct ray *ray,
                                                            int32_t limit, int32_t *enter) {
  const struct box_ray *way = &ray->box;
  const int plane = plane_bytes(layout);
  const char *least = box, *greatest = box + 3 * plane;
  int32_t leave = limit;
  *enter = INT32_MIN;
  return clip_to_slab(layout, least + ray->near_offset_x, greatest - ray->near_offset_x, way->near_origin.x,
                      way->far_origin.x, way->inverse.x, enter, &leave) &&
         clip_to_slab(layout, least + plane + ray->near_offset_y, greatest + plane - ray->near_offset_y,
                      way->near_origin.y, way->far_origin.y, way->inverse.y, enter, &leave) &&
         clip_to_slab(layout, least + 2 * plane + ray->near_offset_z, greatest + 2 * plane - ray->near_offset_z,
                      way->near_origin.z, way->far_origin.z, way->inverse.z, enter, &leave) &&
         leave >= 0;
}

#endif
