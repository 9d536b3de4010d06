/* Nodes with frames: planes are numbers of 8 bits in a frame of the node's own (struct trax_quantised8_node). Planes
   are up to 2^9 cells of the grid apart, so the units of distances are 2^72; the factor has 2^149 by the frame's word.
 */
#ifndef TRAX_DEVICE_NODES_QUANTISED8_H
#define TRAX_DEVICE_NODES_QUANTISED8_H

#include "nodes_quantised.h"

#define FRAME_EXPONENT 72

/* Still without what a frame adds. */
static inline void prepare_for_frames(struct box_ray *box, struct vector origin, struct vector inverse,
                                      struct vector margin, const struct trax_ray_grid *grid) {
  prepare_for_grid(box, origin, inverse, margin, grid, 0x1p-72f);
  struct vector bias = times(TRAX_FRAME_BIAS, box->inverse);
  box->near_origin = plus(box->near_origin, bias);
  box->far_origin = plus(box->far_origin, bias);
}

static inline void enter_frame_along(uint32_t word, float *near_origin, float *far_origin, float *inverse) {
  float first = bits_float((int32_t)word) * *inverse;
  *near_origin -= first, *far_origin -= first;
  *inverse = bits_float(float_bits(*inverse) + (int32_t)(word << 23));
}

/* Brings a ray into a node's frame. */
static inline void enter_frame(struct box_ray *box, const char *node) {
  enter_frame_along(load_word(node), &box->near_origin.x, &box->far_origin.x, &box->inverse.x);
  enter_frame_along(load_word(node + 4), &box->near_origin.y, &box->far_origin.y, &box->inverse.y);
  enter_frame_along(load_word(node + 8), &box->near_origin.z, &box->far_origin.z, &box->inverse.z);
}

static inline int32_t quantised8_plane(const char *plane, float origin, float inverse) {
  return float_bits(bits_float(*(const uint8_t *)plane) * inverse - origin);
}

#endif
