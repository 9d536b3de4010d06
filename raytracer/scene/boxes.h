/* Triangles in boxes. */
#ifndef TRAX_SCENE_BOXES_H
#define TRAX_SCENE_BOXES_H

#include "layouts/boxes.h"
#include "trax/scene.h"

static inline struct scene_box scene_triangle_box(const struct trax_mesh *mesh, uint32_t triangle) {
  struct scene_box box = scene_empty_box();
  for (int corner = 0; corner < 3; corner++)
    scene_box_add_point(&box, mesh->vertices[mesh->triangles[triangle].vertices[corner]]);
  return box;
}

/* --- clip.c --- */

/* The part of a convex polygon where sign * coordinate >= sign * plane. Returns the number of its corners; those beyond
   `most` are left out. */
unsigned scene_clip_polygon(double (*restrict out)[3], unsigned most, const double (*restrict in)[3], unsigned count,
                            int axis, double sign, double plane);
/* The bounds of that part of a triangle which is in the box, rounded outwards but not beyond the box. */
struct scene_box scene_clip_triangle(const float *const corners[3], const struct scene_box *box);
/* The bounds in the two parts of the box, below and above a position on an axis. */
void scene_split_triangle(const float *const corners[3], const struct scene_box *box, int axis, float position,
                          struct scene_box parts[2]);

#endif
