/* Wide nodes, of up to four children (struct trax_wide_node and what follows it): pairs of children, one behind the
   other as two binary nodes are, so that one copy of the test of a pair goes through both. */
#ifndef TRAX_DEVICE_NODES_WIDE_H
#define TRAX_DEVICE_NODES_WIDE_H

#include "boxes.h"
#include "stack.h"

/* Puts the children of a wide node that the ray enters on the stack, the nearest last. */
static inline __attribute__((always_inline)) void
visit_wide_node(uint32_t layout, const char *whole, const struct ray *ray, int32_t limit, struct stack_entry **top) {
  const int first_box = first_box_of(layout), second_box = second_box_of(layout), children = children_of(layout);
  const struct stack_entry *bottom = *top;
  const char *node = whole;
  const struct box_ray way = ray_at_node(layout, ray, whole);
  KEEP_ROLLED
  for (;; node += children - first_box + 8) {
    for (int child = 0; child < 2; child++) {
      int32_t enter;
      if (!enter_box(layout, node + (child ? second_box : first_box), ray, &way, limit, &enter))
        continue;
      trax_scene_ref reference = load_word(node + children + 4 * child);
      if (reference == 0)
        return;
      stack_insert(bottom, top, reference, enter);
    }
    if (node != whole)
      return;
  }
}

/* The same of the layout that it is. False: the next child is the stack's. */
static inline __attribute__((always_inline)) bool visit_wide(uint32_t layout, const char *node, const struct ray *ray,
                                                             int32_t limit, struct stack_entry **top) {
  if (layout == TRAX_NODES_WIDE)
    visit_wide_node(TRAX_NODES_WIDE, node, ray, limit, top);
  else if (layout == TRAX_NODES_WIDE_QUANTISED)
    visit_wide_node(TRAX_NODES_WIDE_QUANTISED, node, ray, limit, top);
  else
    visit_wide_node(TRAX_NODES_WIDE_QUANTISED8, node, ray, limit, top);
  return false;
}

#endif
