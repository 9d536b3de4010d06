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

static inline __attribute__((always_inline)) void push(struct stack_entry **top, trax_scene_ref reference,
                                                       int32_t enter) {
  **top = (struct stack_entry){reference, enter};
  HIDE_ORIGIN(*top); /* else the next top is computed before, and moved */
  ++*top;
}

#define LAYOUT_FILE "visit.h"
#include "layouts/table.def"

/* More entries of the stack than the tree is deep. */
#ifdef TRAX_NODE_LAYOUT
#define MAY_BE(number, general) (TRAX_NODE_LAYOUT == number)
#else
#define MAY_BE(number, general) (general || !GENERAL_LAYOUTS_ONLY)
#endif
enum {
  MORE_ENTRIES = 0
#define OWN(kind) kind##_more_entries
#define LAYOUT(number, NAME, name, general, planes, visit, ...) | (visit && MAY_BE(number, general))
#include "layouts/table.def"
};
#define STACK_ENTRIES (TRAX_TREE_DEPTH + 1 + MORE_ENTRIES)

/* Goes from a node down to a leaf, or stays at one. False if the ray enters no child of a node on the way. If the
   layout is known only at run time, this chooses its code. */
static inline __attribute__((always_inline)) bool descend(uint32_t layout, const char *scene, const struct ray *ray,
                                                          int32_t limit, trax_scene_ref *reference,
                                                          struct stack_entry **top) {
  while (__builtin_expect_with_probability(!leads_to_leaf(*reference), 1, 0.95)) {
    const char *node = scene_at(scene, *reference);
    ACCESS_NODE(node);
#define OWN(kind) kind##_visit
#define LAYOUT(number, NAME, name, general, planes, visit, ...)                                                        \
  if (number == 0 || is_##name(layout)) {                                                                              \
    if (!visit(TRAX_NODES_##NAME, node, ray, limit, reference, top))                                                   \
      return false;                                                                                                    \
  } else
#include "layouts/table.def"
    {
      __builtin_unreachable();
    }
  }
  return true;
}

/* Descends likewise. If the instruction cache has room, each sign of the ray's x has a copy of the loop: then
   addresses of planes of x are the node's and a constant. */
static inline __attribute__((always_inline)) bool descend_by_sign(uint32_t layout, const char *scene,
                                                                  const struct ray *ray, int32_t limit,
                                                                  trax_scene_ref *reference, struct stack_entry **top) {
  struct ray positive = *ray, negative = *ray;
#define OF(kind)
#define OWN(kind) || (!kind##_by_sign && has_##kind##_visit(layout))
#define LAYOUT(number, NAME, name, general, planes, visit, ...) visit
  if (!LOOPS_FOR_BOTH_SIGNS
#include "layouts/table.def"
  )
    return descend(layout, scene, ray, limit, reference, top);
  positive.near_offset_x = 0, negative.near_offset_x = 3 * (uint32_t)plane_bytes(layout);
  return float_bits(ray->box.inverse.x) < 0 ? descend(layout, scene, &negative, limit, reference, top)
                                            : descend(layout, scene, &positive, limit, reference, top);
}

/* Finds the nearest hit before hit->distance_bits, or, if any hit suffices, whether there is one. The probabilities
   tell the register allocator that rays visit many more nodes than triangles. */
static inline __attribute__((always_inline)) bool trace_ray(uint32_t layout, const char *scene, trax_scene_ref root,
                                                            const struct ray *ray, bool any, struct hit *hit) {
#define OF(kind)
#define OWN(kind)                                                                                                      \
  if (kind##_traces && has_##kind##_visit(layout))                                                                     \
    return kind##_trace(scene, root, ray, any, hit);
#define LAYOUT(number, NAME, name, general, planes, visit, ...) visit
#include "layouts/table.def"
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
