/* The layouts of nodes. nodes_binary.h and nodes_quantised.h prepare a ray and compute a plane's distance,
   nodes_wide4.h visits nodes of up to four children with such planes, and nodes_wide8.h is the whole of the layout of
   eight. The layout is a constant in code that is compiled for one, so that nothing is left of the others. */
#ifndef TRAX_DEVICE_NODES_H
#define TRAX_DEVICE_NODES_H

#include "trax/scene_format.h"
#include "vector.h"

#include <stdbool.h>
#include <stdint.h>

/* Whether there is code for nodes of more than two children: the general programs of the TPs have none. */
#ifndef KNOWS_WIDE_NODES
#if defined TRAX_NODE_LAYOUT || !defined __trax__
#define KNOWS_WIDE_NODES 1
#else
#define KNOWS_WIDE_NODES 0
#endif
#endif

static inline bool nodes_are_wide4(uint32_t layout) {
  return KNOWS_WIDE_NODES && (layout == TRAX_NODES_WIDE4 || layout == TRAX_NODES_WIDE4_QUANTISED);
}

static inline bool nodes_are_wide8(uint32_t layout) {
  return KNOWS_WIDE_NODES && layout == TRAX_NODES_WIDE8;
}

/* Whether planes are numbers, on the scene's grid or in a frame. */
static inline bool nodes_are_quantised(uint32_t layout) {
  return layout != TRAX_NODES_BINARY && !(KNOWS_WIDE_NODES && layout == TRAX_NODES_WIDE4);
}

/* From a plane of a box to that of the next axis: of eight children, planes of an axis stand together. */
static inline int plane_bytes(uint32_t layout) {
  return nodes_are_wide8(layout) ? 8 : nodes_are_quantised(layout) ? 2 : 4;
}

/* A node, or a pair of children of a wide one, is two boxes of six planes, the three least ones first, and the
   children's references. */
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
