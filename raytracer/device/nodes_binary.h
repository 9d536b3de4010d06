/* Binary nodes: boxes in binary32, exact (struct trax_bvh_node). */
#ifndef TRAX_DEVICE_NODES_BINARY_H
#define TRAX_DEVICE_NODES_BINARY_H

#include "algebra.h"
#include "nodes.h"

static inline void prepare_for_binary(struct box_ray *box, struct vector origin, struct vector inverse,
                                      struct vector margin) {
  box->inverse = inverse;
  box->near_origin = plus(origin, margin);
  box->far_origin = minus(origin, margin);
}

/* The bits of a plane's distance along the ray. */
static inline int32_t binary_plane(const char *plane, float origin, float inverse) {
  return float_bits((load_float(plane) - origin) * inverse);
}

#endif
