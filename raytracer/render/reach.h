/* How far binary32 reaches. */
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

#endif
