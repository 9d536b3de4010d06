/* Nodes of up to four children: pairs, one behind the other as two binary nodes are, so that one copy of the test of a
   pair goes through both. traverse.h includes this file. */
#ifndef TRAX_DEVICE_NODES_WIDE4_H
#define TRAX_DEVICE_NODES_WIDE4_H

#include "boxes.h"

/* Among those above `bottom`, of which the last is entered first; of equals the first put there is the last. */
static inline __attribute__((always_inline)) void
stack_insert(const struct stack_entry *bottom, struct stack_entry **top, trax_scene_ref reference, int32_t enter) {
  struct stack_entry *at = (*top)++;
  KEEP_ROLLED
  for (; at != bottom; at--) {
    int32_t below = at[-1].enter;
    if (below > enter)
      break;
    *at = (struct stack_entry){at[-1].reference, below};
  }
  *at = (struct stack_entry){reference, enter};
}

/* Goes from a wide node to the nearest of the children that the ray enters, and puts the others on the stack, the
   nearest last. False if it enters none. */
static inline __attribute__((always_inline)) bool visit_wide4_node(uint32_t layout, const char *node,
                                                                   const struct ray *ray, int32_t limit,
                                                                   trax_scene_ref *nearest, struct stack_entry **top) {
  const int second_box = second_box_of(layout), children = children_of(layout);
  int32_t first = INT32_MAX;
  *nearest = 0;
  const struct stack_entry *bottom = *top;
  const char *pair = node;
  KEEP_ROLLED
  for (;; pair += children + 8) {
    for (int child = 0; child < 2; child++) {
      int32_t enter;
      if (!enter_box(layout, pair, child ? second_box : 0, ray, limit, &enter))
        continue;
      trax_scene_ref reference = load_word(pair + children + 4 * child);
      if (reference == 0)
        return *nearest != 0;
      if (enter < first) {
        const trax_scene_ref other = *nearest;
        const int32_t other_enter = first;
        *nearest = reference, first = enter;
        reference = other, enter = other_enter;
      }
      if (reference != 0)
        stack_insert(bottom, top, reference, enter);
    }
    if (pair != node)
      return *nearest != 0;
  }
}

#endif
