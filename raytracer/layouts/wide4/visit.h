#include "../pairs.h"

/* Nodes of up to four children: pairs, one behind the other as two binary nodes are, so that one copy of the test of a
   pair goes through both. For a moment the nearest child is on the stack, too. */
enum { wide4_by_sign = 0, wide4_more_entries = 1, wide4_traces = 0 };
#define wide4_trace(...) false

/* Inserts an entry among those above `bottom`. They are sorted: the last is entered first, and of equal ones the first
   inserted is the last. */
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

/* Puts the children of a wide node that the ray enters on the stack, the nearest last. The traversal takes that one
   from there; keeping it in a register takes more cycles. */
static inline __attribute__((always_inline)) bool wide4_visit(uint32_t layout, const char *node, const struct ray *ray,
                                                              int32_t limit, trax_scene_ref *next,
                                                              struct stack_entry **top) {
  (void)next;
  const int second_box = second_box_of(layout), children = children_of(layout);
  const struct stack_entry *bottom = *top;
  const char *pair = node;
  KEEP_ROLLED
  for (;; pair += children + 8) {
    for (int child = 0; child < 2; child++) {
      int32_t enter;
      if (!enter_box(layout, pair, child ? second_box : 0, ray, limit, &enter))
        continue;
      const trax_scene_ref reference = load_word(pair + children + 4 * child);
      if (reference == 0)
        return false;
      stack_insert(bottom, top, reference, enter);
    }
    if (pair != node)
      return false;
  }
}
