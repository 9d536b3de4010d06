/* The layouts of nodes: which of them the program has, and what each is like. Each has a file of its own for what a ray
   is prepared with and where along it a plane is: nodes_binary.h, nodes_quantised.h, nodes_quantised8.h. nodes_wide.h
   has nodes of up to four children, with the planes of any of them. A layout is a constant wherever the program is
   compiled for one, and nothing is left of the others. */
#ifndef TRAX_DEVICE_NODES_H
#define TRAX_DEVICE_NODES_H

#include "run.h"
#include "trax/scene_format.h"
#include "vector.h"

#include <stdbool.h>
#include <stdint.h>

/* The general program of the TPs has only the first two of them, since it is large enough, and one with a short stack
   has no wide ones. */
#if defined __trax__ && !defined TRAX_NODE_LAYOUT
#define PROGRAM_HAS_LAYOUT(layout) ((layout) <= TRAX_NODES_QUANTISED)
#else
#define PROGRAM_HAS_LAYOUT(layout) ((layout) < TRAX_NODES_WIDE || !STACK_IS_SHORT)
#endif

static inline bool nodes_are_wide(uint32_t layout) {
  return PROGRAM_HAS_LAYOUT(TRAX_NODES_WIDE) && layout >= TRAX_NODES_WIDE;
}

/* Have nodes frames of their own, in which their planes are numbers of 8 bits? */
static inline bool nodes_have_frames(uint32_t layout) {
  return PROGRAM_HAS_LAYOUT(TRAX_NODES_QUANTISED8) &&
         (layout == TRAX_NODES_QUANTISED8 || layout == TRAX_NODES_WIDE_QUANTISED8);
}

/* Are planes numbers, on the scene's grid or in frames? */
static inline bool nodes_are_quantised(uint32_t layout) {
  return layout != TRAX_NODES_BINARY && !(nodes_are_wide(layout) && layout == TRAX_NODES_WIDE);
}

static inline int plane_bytes(uint32_t layout) {
  return nodes_have_frames(layout) ? 1 : nodes_are_quantised(layout) ? 2 : 4;
}

/* A node is what its boxes stand in, two boxes of six planes, the three least ones first, and the children's
   references. */
static inline int first_box_of(uint32_t layout) {
  return nodes_have_frames(layout) ? 12 : 0;
}
static inline int second_box_of(uint32_t layout) {
  return first_box_of(layout) + 6 * plane_bytes(layout);
}
static inline int children_of(uint32_t layout) {
  return second_box_of(layout) + 6 * plane_bytes(layout);
}

/* A ray, prepared for boxes. A plane is at (plane - origin) * inverse, or, if it is a number, at plane * inverse -
   origin. The margin by which boxes are widened is in the origins: one for near and one for far planes. */
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
