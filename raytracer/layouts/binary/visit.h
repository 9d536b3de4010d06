#include "../pairs.h"

/* Nodes of two children. */
enum { binary_by_sign = 1, binary_more_entries = 0, binary_traces = 0 };
#define binary_trace(...) false /* the traversal is that of traverse.h */

/* Goes from a node to the nearer of the children that the ray enters, and pushes the other one. False if it enters
   none. */
static inline __attribute__((always_inline)) bool binary_visit(uint32_t layout, const char *node, const struct ray *ray,
                                                               int32_t limit, trax_scene_ref *reference,
                                                               struct stack_entry **top) {
  const int second_box = second_box_of(layout), children = children_of(layout);
  int32_t enter0, enter1;
  if (!enter_box(layout, node, 0, ray, limit, &enter0)) {
    if (!enter_box(layout, node, second_box, ray, limit, &enter1))
      return false;
    *reference = load_word(node + children + 4);
  } else if (!enter_box(layout, node, second_box, ray, limit, &enter1)) {
    *reference = load_word(node + children);
  } else if (enter0 <= enter1) {
    *reference = load_word(node + children);
    push(top, load_word(node + children + 4), enter1);
  } else {
    *reference = load_word(node + children + 4);
    push(top, load_word(node + children), enter0);
  }
  return true;
}
