/* Traversal of the BVH: the nearest hit of a ray, or whether there is any. */
#ifndef TRAX_DEVICE_TRAVERSE_H
#define TRAX_DEVICE_TRAVERSE_H

#include "access.h"
#include "boxes.h"
#include "nodes_wide.h"
#include "ray.h"
#include "run.h"
#include "stack.h"
#include "trax/scene_format.h"

#include <stdbool.h>
#include <stddef.h>

/* Goes from a node to the nearer of the children that the ray enters; the other one is put on the stack. False: it
   enters none. */
static inline __attribute__((always_inline)) bool visit_node(uint32_t layout, const char *node, const struct ray *ray,
                                                             int32_t limit, trax_scene_ref *reference,
                                                             struct stack_entry *stack, struct stack_entry **top,
                                                             struct trail *trail) {
  const int first_box = first_box_of(layout), second_box = second_box_of(layout), children = children_of(layout);
  const struct box_ray way = ray_at_node(layout, ray, node);
  int32_t enter0, enter1;
  if (!enter_box(layout, node + first_box, ray, &way, limit, &enter0)) {
    if (!enter_box(layout, node + second_box, ray, &way, limit, &enter1))
      return false;
    *reference = load_word(node + children + 4);
    trail_descend(trail, true, true);
  } else if (!enter_box(layout, node + second_box, ray, &way, limit, &enter1)) {
    *reference = load_word(node + children);
    trail_descend(trail, false, true);
  } else if (enter0 <= enter1) {
    *reference = load_word(node + children);
    stack_push(stack, top, load_word(node + children + 4), enter1);
    trail_descend(trail, false, false);
  } else {
    *reference = load_word(node + children + 4);
    stack_push(stack, top, load_word(node + children), enter0);
    trail_descend(trail, true, false);
  }
  return true;
}

/* From the root to the child that the trail leads to, whose entry the stack has lost. It may be behind the nearest hit,
   which a visit finds out: to test its box here takes more than it saves. */
static inline trax_scene_ref find_again(uint32_t layout, const char *scene, trax_scene_ref root,
                                        const struct trail *trail) {
  const int children = children_of(layout);
  trax_scene_ref reference = root;
  uint32_t level = TRAIL_END, second = TRAIL_IS_LONG && trail->below ? trail->upper_second : trail->second;
  bool upper = TRAIL_IS_LONG && trail->below;
  do {
    const char *node = scene_at(scene, reference);
    ACCESS_NODE(node);
    if (upper && level == 1)
      upper = false, level = TRAIL_END, second = trail->second;
    level >>= 1;
    reference = load_word(node + children + (second & level ? 4 : 0));
  } while (upper || level != trail->level);
  return reference;
}

/* Goes from a node down to a leaf, or stays at one. False: the way ends before, at a node of which the ray enters no
   child, or at a wide one, whose children are all on the stack. Where the layout is known at run time only its own code
   is chosen here. */
static inline __attribute__((always_inline)) bool descend(uint32_t layout, const char *scene, const struct ray *ray,
                                                          int32_t limit, trax_scene_ref *reference,
                                                          struct stack_entry *stack, struct stack_entry **top,
                                                          struct trail *trail) {
  while (__builtin_expect_with_probability(TRAX_SCENE_REF_COUNT(*reference) == 0, 1, 0.95)) {
    const char *node = scene_at(scene, *reference);
    ACCESS_NODE(node);
    if (STACK_IS_SHORT)
      trail_make_room(trail);
    bool entered;
    if (nodes_are_wide(layout))
      entered = visit_wide(layout, node, ray, limit, top);
    else if (nodes_have_frames(layout))
      entered = visit_node(TRAX_NODES_QUANTISED8, node, ray, limit, reference, stack, top, trail);
    else if (nodes_are_quantised(layout))
      entered = visit_node(TRAX_NODES_QUANTISED, node, ray, limit, reference, stack, top, trail);
    else
      entered = visit_node(TRAX_NODES_BINARY, node, ray, limit, reference, stack, top, trail);
    if (!entered)
      return false;
  }
  return true;
}

/* The nearest hit before hit->distance_bits into *hit, or, if any hit will do, whether there is one. The probabilities
   tell the register allocator what matters: rays visit many more nodes than triangles. */
static inline __attribute__((always_inline)) bool trace_ray(uint32_t layout, const char *scene, trax_scene_ref root,
                                                            const struct ray *ray, bool any, struct hit *hit) {
  /* Of wide nodes the child that is visited next is on it, too. */
  struct stack_entry stack[TRAX_STACK_ENTRIES + (PROGRAM_HAS_LAYOUT(TRAX_NODES_WIDE) && layout >= TRAX_NODES_WIDE)];
  struct stack_entry *top = stack, entry;
  struct trail trail;
  trax_scene_ref reference = root;
  int32_t limit = limit_of(layout, hit->distance_bits); /* boxes that begin there or later are left out */

  if (root == 0)
    return false;
  if (STACK_IS_SHORT)
    trail_begin(&trail);
  stack_begin(stack);
  for (;;) {
    if (descend(layout, scene, ray, limit, &reference, stack, &top, &trail)) {
      const char *triangle = scene_at(scene, TRAX_SCENE_REF_OFFSET(reference));
      const char *end = triangle + TRAX_SCENE_REF_COUNT(reference) * sizeof(struct trax_triangle);
      do {
        HIDE_ORIGIN(triangle); /* else three pointers would be stepped instead of one */
        ACCESS_TRIANGLE(triangle);
        if (hit_triangle(&ray->triangle, triangle, any, hit) && any)
          return true;
        triangle += sizeof(struct trax_triangle);
      } while (__builtin_expect_with_probability(triangle != end, 1, 0.5));
      limit = limit_of(layout, hit->distance_bits);
    }
    KEEP_ROLLED
    do {
      if (STACK_IS_SHORT ? !trail_back(&trail) : top == stack)
        return hit->triangle != NULL;
      entry = stack_pop(stack, &top);
      if (STACK_IS_SHORT && __builtin_expect(entry.reference == 0, 0)) {
        entry.reference = find_again(layout, scene, root, &trail);
        break;
      }
    } while (entry.enter >= limit);
    reference = entry.reference;
  }
}

#endif
