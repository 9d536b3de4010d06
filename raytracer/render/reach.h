/* The limits of binary32. */
#ifndef TRAX_RENDER_REACH_H
#define TRAX_RENDER_REACH_H

#include "trax/scene.h"

#include <stdbool.h>

/* The watertight test sees each vertex up to 14 units of 2^-24 of its distance away from where it is (frame.c), and
   what is near the eye as far off as its farthest vertex. That is less than 1/292 of the distance of what is seen, and
   as a rule a tenth of it, unless a triangle has a vertex TRAX_REACH times as far from the eye as its nearest point. */
#define TRAX_REACH 0x1p12

/* A distance times a determinant is the product of three lengths. It is a normal float, with 2^30 to spare, unless a
   triangle is smaller than this. */
#define TRAX_LEAST_SIZE 0x1p-32

/* Are there such triangles? scene and eye as trax_normalise left them. */
bool trax_needs_exact(const struct trax_scene *scene, const float eye[3]);

/* Of the start of shadow rays above a triangle (device/shade.h): within TRAX_NEAR_LIGHT of it, a light is seen from
   there at another angle. Farther away the cosine differs by less than 3 in TRAX_NEAR_LIGHT. */
#define TRAX_NEAR_LIGHT 0x1p10

/* Is the light as near as that to a triangle? */
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
