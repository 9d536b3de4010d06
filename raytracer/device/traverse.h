/* Traversal of the BVH: the nearest hit of a ray, or whether there is any. */
#ifndef TRAX_DEVICE_TRAVERSE_H
#define TRAX_DEVICE_TRAVERSE_H

#include "access.h"
#include "boxes.h"
#include "ray.h"
#include "run.h"
#include "trax/scene_format.h"

#include <stdbool.h>
#include <stddef.h>

/* The stack has the farther children that are still to be visited, at most one for each level of the tree. Its lowest
   entry is a leaf without triangles that no limit rules out, so that the end of the stack takes no register and no
   branch of its own. */
struct stack_entry {
  trax_scene_ref reference;
  int32_t enter; /* where the ray enters its box */
};

/* Of a node of four children the nearest one is on the stack, too, for a moment. */
#ifdef TRAX_NODE_LAYOUT
#define MAY_BE_WIDE4 (TRAX_NODE_LAYOUT == TRAX_NODES_WIDE4 || TRAX_NODE_LAYOUT == TRAX_NODES_WIDE4_QUANTISED)
#else
#define MAY_BE_WIDE4 KNOWS_WIDE_NODES
#endif
#define STACK_ENTRIES (TRAX_TREE_DEPTH + 1 + MAY_BE_WIDE4)

static inline __attribute__((always_inline)) void push(struct stack_entry **top, trax_scene_ref reference,
                                                       int32_t enter) {
  **top = (struct stack_entry){reference, enter};
  HIDE_ORIGIN(*top); /* else the next top is computed before, and moved */
  ++*top;
}

#include "nodes_wide4.h"
#include "traverse_wide8.h"

/* Goes from a node to the nearer of the children that the ray enters, and pushes the other one. False if it enters
   none. */
static inline __attribute__((always_inline)) bool visit_node(uint32_t layout, const char *node, const struct ray *ray,
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

/* Goes from a node down to a leaf, or stays at one. False if the ray enters no child of a node on the way. If the
   layout is known only at run time, this chooses its code. */
static inline __attribute__((always_inline)) bool descend(uint32_t layout, const char *scene, const struct ray *ray,
                                                          int32_t limit, trax_scene_ref *reference,
                                                          struct stack_entry **top) {
  while (__builtin_expect_with_probability(!leads_to_leaf(*reference), 1, 0.95)) {
    const char *node = scene_at(scene, *reference);
    ACCESS_NODE(node);
    if (nodes_are_wide4(layout)) { /* the next child is the stack's */
      if (nodes_are_quantised(layout))
        visit_wide4_node(TRAX_NODES_WIDE4_QUANTISED, node, ray, limit, top);
      else
        visit_wide4_node(TRAX_NODES_WIDE4, node, ray, limit, top);
      return false;
    }
    if (nodes_are_quantised(layout) ? !visit_node(TRAX_NODES_QUANTISED, node, ray, limit, reference, top)
                                    : !visit_node(TRAX_NODES_BINARY, node, ray, limit, reference, top))
      return false;
  }
  return true;
}

/* The same. If the instruction cache has room, by a copy of the loop for either sign of the ray's x: then addresses of
   planes of x are the node's and a constant. */
static inline __attribute__((always_inline)) bool descend_by_sign(uint32_t layout, const char *scene,
                                                                  const struct ray *ray, int32_t limit,
                                                                  trax_scene_ref *reference, struct stack_entry **top) {
  struct ray positive = *ray, negative = *ray;
  if (!LOOPS_FOR_BOTH_SIGNS || nodes_are_wide4(layout))
    return descend(layout, scene, ray, limit, reference, top);
  positive.near_offset_x = 0, negative.near_offset_x = 3 * (uint32_t)plane_bytes(layout);
  return float_bits(ray->box.inverse.x) < 0 ? descend(layout, scene, &negative, limit, reference, top)
                                            : descend(layout, scene, &positive, limit, reference, top);
}

/* Finds the nearest hit before hit->distance_bits, or, if any hit suffices, whether there is one. The probabilities
   tell the register allocator that rays visit many more nodes than triangles. */
static inline __attribute__((always_inline)) bool trace_ray(uint32_t layout, const char *scene, trax_scene_ref root,
                                                            const struct ray *ray, bool any, struct hit *hit) {
  if (nodes_are_wide8(layout))
    return trace_wide8(scene, root, ray, any, hit);
  struct stack_entry stack[STACK_ENTRIES], *top = stack;
  trax_scene_ref reference = root;
  int32_t limit = limit_of(layout, hit->distance_bits); /* boxes that the ray enters later are left out */

  if (root == 0)
    return false;
  *top++ = (struct stack_entry){NO_LEAF, INT32_MIN};
  for (;;) {
    if (descend_by_sign(layout, scene, ray, limit, &reference, &top)) {
      reference = leaf_of(reference);
      if (TRAX_SCENE_REF_OFFSET(reference) == 0)
        return hit->triangle != NULL;
      const char *triangle = scene_at(scene, TRAX_SCENE_REF_OFFSET(reference));
      const char *end = triangle + TRAX_SCENE_REF_COUNT(reference) * sizeof(struct trax_triangle);
      do {
        HIDE_ORIGIN(triangle); /* else three pointers advance instead of one */
        ACCESS_TRIANGLE(triangle);
        if (hit_triangle(&ray->triangle, triangle, any, hit) && any)
          return true;
        triangle += sizeof(struct trax_triangle);
      } while (__builtin_expect_with_probability(triangle != end, 1, 0.5));
      limit = limit_of(layout, hit->distance_bits);
    }
    KEEP_ROLLED
    do {
      --top;
      HIDE_ORIGIN(top); /* else there are two copies of it */
    } while (top->enter >= limit);
    reference = top->reference;
  }
}

#if TRAX_INSTANCES
#include "instance.h"
#endif

#endif
