/* The stack of the traversal: the farther child of every inner node above the current one that is still to be visited.

   If it has as many entries as the tree may be deep (TRAX_TREE_DEPTH), no more is needed. If it has fewer, it is a
   ring: an entry too many takes the place of the oldest. What is lost is found again from the root by the trail, which
   has bits for each level, as in S. Laine, "Restart trail for stackless BVH traversal" (2010), and A. Afra and L.
   Szirmay-Kalos, "Stackless multi-BVH traversal for CPU, MIC and GPU ray tracing" (2014). As the trail says which child
   was taken, not only whether it was the nearer one, the way down takes a load a level and no test of a box, and the
   oldest entries are those with the shortest way. */
#ifndef TRAX_DEVICE_STACK_H
#define TRAX_DEVICE_STACK_H

#include "nodes.h"
#include "run.h"
#include "trax/scene_format.h"

#include <stdbool.h>
#include <stdint.h>

struct stack_entry {
  trax_scene_ref reference;
  int32_t enter; /* where the ray enters its box */
};

#ifdef TRAX_NODE_LAYOUT
_Static_assert(PROGRAM_HAS_LAYOUT(TRAX_NODE_LAYOUT), "the trail is of binary nodes");
#endif

/* Of a stack that is not short nothing of it is left. A word has 31 levels, the highest first; where the tree is
   deeper, the upper levels wait in other words while the lower ones are in these. */
#define TRAIL_END 0x80000000u
#define TRAIL_LEVELS 31
#define TRAIL_IS_LONG (TRAX_TREE_DEPTH > TRAIL_LEVELS)
_Static_assert(TRAX_SCENE_MAX_DEPTH == 2 * TRAIL_LEVELS, "two words");

struct trail {
  uint32_t level;  /* of the inner node above the current place; TRAIL_END: it has none in these words */
  uint32_t done;   /* levels whose other child was visited, or missed; none below `level` */
  uint32_t second; /* levels where the second child was taken; none below `level` */
  bool below;      /* the words are those of the lower levels */
  uint32_t upper_done, upper_second;
};

static inline void trail_begin(struct trail *trail) {
  trail->level = TRAIL_END, trail->done = 0, trail->second = 0, trail->below = false;
}

/* Before a visit to an inner node: room for its level. */
static inline void trail_make_room(struct trail *trail) {
  if (TRAIL_IS_LONG && __builtin_expect(trail->level == 1, 0)) {
    trail->upper_done = trail->done, trail->upper_second = trail->second;
    trail->below = true;
    trail->level = TRAIL_END, trail->done = 0, trail->second = 0;
  }
}

/* Down to a child of the node that is one level below. */
static inline void trail_descend(struct trail *trail, bool second, bool only) {
  if (!STACK_IS_SHORT)
    return;
  trail->level >>= 1;
  if (second)
    trail->second |= trail->level;
  if (only)
    trail->done |= trail->level;
}

/* Up to the deepest level with a child left, and over to that; the carry of the sum passes the levels that are done.
   False: there is none. */
static inline bool trail_back(struct trail *trail) {
  for (;;) {
    trail->done += trail->level;
    trail->level = trail->done & -trail->done;
    trail->second = (trail->second & -trail->level) ^ trail->level;
    if (trail->level != TRAIL_END)
      return true;
    if (!TRAIL_IS_LONG || !trail->below)
      return false;
    trail->below = false;
    trail->level = 1, trail->done = trail->upper_done, trail->second = trail->upper_second;
  }
}

/* Of a ring, an entry that is none, since it was taken or never put there, has the reference 0. */
static inline __attribute__((always_inline)) void stack_begin(struct stack_entry *stack) {
  if (STACK_IS_SHORT)
    for (uint32_t i = 0; i < TRAX_STACK_ENTRIES; i++)
      stack[i].reference = 0;
}

static inline __attribute__((always_inline)) void stack_push(struct stack_entry *stack, struct stack_entry **top,
                                                             trax_scene_ref reference, int32_t enter) {
  *(*top)++ = (struct stack_entry){reference, enter};
  if (STACK_IS_SHORT && *top == stack + TRAX_STACK_ENTRIES)
    *top = stack;
}

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

/* The entry that is then above the top. */
static inline __attribute__((always_inline)) struct stack_entry stack_pop(struct stack_entry *stack,
                                                                          struct stack_entry **top) {
  if (STACK_IS_SHORT && *top == stack)
    *top += TRAX_STACK_ENTRIES;
  (*top)--;
  struct stack_entry entry = **top;
  if (STACK_IS_SHORT)
    (*top)->reference = 0;
  return entry;
}

#endif
