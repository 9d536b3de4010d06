/* The limits of binary32. */
#ifndef TRAX_RENDER_REACH_H
#define TRAX_RENDER_REACH_H

#include "trax/scene.h"

#include <stdbool.h>

/* The watertight test displaces each vertex by up to 14 units of 2^-24 of its distance (frame.c), and a near point of a
   triangle by as much as its farthest vertex. That is less than 1/292 of the point's distance, and as a rule a tenth of
   that, unless a triangle has a vertex TRAX_REACH times as far from the eye as its nearest point. */
#define TRAX_REACH 0x1p12

/* A distance times a determinant is the product of three lengths. It is a normal float, with 2^30 to spare, unless a
   triangle is smaller than this. */
#define TRAX_LEAST_SIZE 0x1p-32

/* Whether there are such triangles. scene and eye are those that trax_normalise wrote. */
bool trax_needs_exact(const struct trax_scene *scene, const float eye[3]);

/* The unit is the distance between a triangle and the start of its shadow rays (device/shade.h). A light within
   TRAX_NEAR_LIGHT is seen from that start at another angle than from the triangle. Farther away the cosine differs by
   less than 3 in TRAX_NEAR_LIGHT. */
#define TRAX_NEAR_LIGHT 0x1p10

/* Whether the light is as near as that to a triangle. */
bool trax_light_is_near(const struct trax_scene *scene, const float eye[3], const float light[3]);

/* The bound `b` of device/shade.h, where v0 and the edges have these greatest components; where hits are exact, also
   with those of the eye and of the way from it. */
static inline double trax_start_bound(double v0, double edges) {
  return 0x1p-22 * v0 + 0x1p-17 * edges;
}
static inline double trax_exact_start_bound(double v0, double edges, double eye, double way) {
  const double along = 0x1p-22 * eye + 0x1p-19 * way, bound = trax_start_bound(v0, edges);
  return along < bound ? along : bound;
}

#endif
