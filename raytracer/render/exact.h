/* Rays against triangles without error, for the picture that errors are measured by. Embree's BVH finds the triangles
   whose boxes a ray may meet. Whether the ray meets them, and which is the nearest, is decided in binary64 if that is
   certain, else in double-double if that is, else in rational numbers. */
#ifndef TRAX_RENDER_EXACT_H
#define TRAX_RENDER_EXACT_H

#include "double3.h"
#include "trax/scene.h"

#include <rtcore.h>
#include <stdbool.h>
#include <stdint.h>

/* Distance and weights are within this of their values, as quotients. */
#define EXACT_DISTANCE_ERROR 0x1p-32

struct exact_hit {
  uint32_t triangle; /* its number */
  double distance;   /* in units of the direction */
  double u, v;       /* barycentric weights of v1 and v2 */
};

/* Triangles of a mesh of instances, or all if there are none. */
struct exact_part {
  const struct trax_scene *source;
  uint32_t first, count;
  float room; /* with instances: boxes are widened by it, for the rounding of the ray that Embree transforms */
};

/* exact_scene.c */

/* Attaches the part's triangles. It must outlive the scene. False: out of memory. */
bool exact_attach(RTCDevice device, RTCScene scene, const struct exact_part *part);

/* The nearest triangle at a distance above 0; of equal distances the one that comes first by the bits of its vertices,
   and of those at one place the first in the file, as on the device. A triangle's edges and vertices belong to it; one
   whose plane holds the ray is not hit. */
bool exact_nearest(RTCScene scene, struct double3 origin, struct double3 direction, struct exact_hit *hit);

/* Whether there is any triangle at a distance above 0 and below `limit`. */
bool exact_any(RTCScene scene, struct double3 origin, struct double3 direction, double limit);

/* exact.c */

/* Tests the triangle of a number (placed.h), which *hit has already. An instance's vertices are the products of its
   matrix and its mesh's vertices, without rounding. */
bool exact_placed(const struct trax_scene *scene, uint32_t number, struct double3 origin, struct double3 direction,
                  struct exact_hit *hit);

/* Tests one triangle, whose number *hit has already. */
bool exact_triangle(const struct trax_triangle *triangle, struct double3 origin, struct double3 direction,
                    struct exact_hit *hit);

/* Below 0 if the ray meets the triangle `number`, which it hits, before `other`, which it hits, too; above 0: behind.
 */
int exact_order(const struct trax_scene *scene, uint32_t number, uint32_t other, struct double3 origin,
                struct double3 direction);

#endif
