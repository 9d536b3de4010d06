/* Boxes in host arithmetic, and the parts of triangles in them. */
#ifndef TRAX_SCENE_BOXES_H
#define TRAX_SCENE_BOXES_H

#include "trax/scene.h"

struct scene_box {
  float min[3], max[3];
};

static inline struct scene_box scene_empty_box(void) {
  return (struct scene_box){{__builtin_inff(), __builtin_inff(), __builtin_inff()},
                            {-__builtin_inff(), -__builtin_inff(), -__builtin_inff()}};
}

static inline void scene_box_add_point(struct scene_box *box, const float point[3]) {
  for (int axis = 0; axis < 3; axis++) {
    box->min[axis] = point[axis] < box->min[axis] ? point[axis] : box->min[axis];
    box->max[axis] = point[axis] > box->max[axis] ? point[axis] : box->max[axis];
  }
}

/* Half of the surface: proportional to the chance that a random line hits the box. */
static inline double scene_half_area(const float min[3], const float max[3]) {
  double x = (double)max[0] - min[0], y = (double)max[1] - min[1], z = (double)max[2] - min[2];
  return x * y + y * z + z * x;
}

static inline void scene_box_add_box(struct scene_box *box, const struct scene_box *other) {
  scene_box_add_point(box, other->min);
  scene_box_add_point(box, other->max);
}

static inline struct scene_box join_boxes(const struct scene_box *a, const struct scene_box *b) {
  struct scene_box both;
  for (int axis = 0; axis < 3; axis++) {
    both.min[axis] = a->min[axis] < b->min[axis] ? a->min[axis] : b->min[axis];
    both.max[axis] = a->max[axis] > b->max[axis] ? a->max[axis] : b->max[axis];
  }
  return both;
}

/* What both boxes have in common. */
static inline struct scene_box scene_box_within(const struct scene_box *a, const struct scene_box *b) {
  struct scene_box box;
  for (int axis = 0; axis < 3; axis++) {
    box.min[axis] = a->min[axis] > b->min[axis] ? a->min[axis] : b->min[axis];
    box.max[axis] = a->max[axis] < b->max[axis] ? a->max[axis] : b->max[axis];
  }
  return box;
}

static inline struct scene_box scene_triangle_box(const struct trax_mesh *mesh, uint32_t triangle) {
  struct scene_box box = scene_empty_box();
  for (int corner = 0; corner < 3; corner++)
    scene_box_add_point(&box, mesh->vertices[mesh->triangles[triangle].vertices[corner]]);
  return box;
}

/* --- clip.c --- */

/* The next float below or above a finite one. */
static inline float scene_next_float(float x, bool up) {
  union {
    float value;
    uint32_t bits;
  } both = {x};
  both.bits = x == 0 ? (up ? 1 : 0x80000001) : both.bits + ((x > 0) == up ? 1 : UINT32_MAX);
  return both.value;
}

/* The part of a convex polygon where sign * coordinate >= sign * plane. Returns the number of its corners; those beyond
   `most` are left out. */
unsigned scene_clip_polygon(double (*restrict out)[3], unsigned most, const double (*restrict in)[3], unsigned count,
                            int axis, double sign, double plane);
/* The bounds of that part of a triangle which is in the box, rounded outwards but not beyond the box. */
struct scene_box scene_clip_triangle(const float *const corners[3], const struct scene_box *box);
/* The same of the two parts of the box below and above a position on an axis. */
void scene_split_triangle(const float *const corners[3], const struct scene_box *box, int axis, float position,
                          struct scene_box parts[2]);

#endif
