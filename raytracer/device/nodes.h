/* The two layouts of nodes. nodes_binary.h and nodes_quantised.h prepare a ray and compute a plane's distance for each.
   The layout is a constant in code that is compiled for one, so that nothing is left of the other. Further layouts are
   experiments (evaluation/experiments/nodes). */
#ifndef TRAX_DEVICE_NODES_H
#define TRAX_DEVICE_NODES_H

#include "trax/scene_format.h"
#include "vector.h"

#include <stdbool.h>
#include <stdint.h>

/* Whether planes are numbers on the scene's grid. */
static inline bool nodes_are_quantised(uint32_t layout) {
  return layout != TRAX_NODES_BINARY;
}

static inline int plane_bytes(uint32_t layout) {
  return nodes_are_quantised(layout) ? 2 : 4;
}

/* A node is two boxes of six planes, the three least ones first, and the children's references. */
static inline int second_box_of(uint32_t layout) {
  return 6 * plane_bytes(layout);
}
static inline int children_of(uint32_t layout) {
  return 12 * plane_bytes(layout);
}

/* A ray, prepared for boxes. A plane is at (plane - origin) * inverse, or, if it is a number on the grid, at plane *
   inverse - origin. The origins, one for near and one for far planes, include the margin by which boxes are widened. */
struct box_ray {
  struct vector near_origin, far_origin, inverse;
};

static inline uint32_t load_word(const char *address) {
  return *(const uint32_t *)(const void *)address;
}

static inline float load_float(const char *address) {
  return *(const float *)(const void *)address;
}

#endif
