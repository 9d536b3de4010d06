/* Boxes in host arithmetic. */
#ifndef TRAX_LAYOUTS_BOXES_H
#define TRAX_LAYOUTS_BOXES_H

#include <stdbool.h>
#include <stdint.h>

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

static inline struct scene_box scene_join_boxes(const struct scene_box *a, const struct scene_box *b) {
  struct scene_box both;
  for (int axis = 0; axis < 3; axis++) {
    both.min[axis] = a->min[axis] < b->min[axis] ? a->min[axis] : b->min[axis];
    both.max[axis] = a->max[axis] > b->max[axis] ? a->max[axis] : b->max[axis];
  }
  return both;
}

/* The intersection of two boxes. */
static inline struct scene_box scene_box_within(const struct scene_box *a, const struct scene_box *b) {
  struct scene_box box;
  for (int axis = 0; axis < 3; axis++) {
    box.min[axis] = a->min[axis] > b->min[axis] ? a->min[axis] : b->min[axis];
    box.max[axis] = a->max[axis] < b->max[axis] ? a->max[axis] : b->max[axis];
  }
  return box;
}

/* The next float below or above a finite one. */
static inline float scene_next_float(float x, bool up) {
  union {
    float value;
    uint32_t bits;
  } both = {x};
  both.bits = x == 0 ? (up ? 1 : 0x80000001) : both.bits + ((x > 0) == up ? 1 : UINT32_MAX);
  return both.value;
}

#endif
