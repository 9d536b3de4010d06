/* A node of two children, or a pair of children of a wider one: two boxes of six planes, the three least ones first,
   and the children's references. For the device. */
#ifndef TRAX_LAYOUTS_PAIRS_H
#define TRAX_LAYOUTS_PAIRS_H

static inline int second_box_of(uint32_t layout) {
  return 6 * plane_bytes(layout);
}
static inline int children_of(uint32_t layout) {
  return 12 * plane_bytes(layout);
}

#endif
