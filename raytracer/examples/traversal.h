/* The traversal of steps 6, 7, 9 and 10: all in registers, and the second child's test in two places. */
#ifndef TRAX_EXAMPLES_TRAVERSAL_H
#define TRAX_EXAMPLES_TRAVERSAL_H

#include "quantised.h"

/* Finds the nearest hit before hit->distance in the subtree to which *root refers, or, if any hit suffices, whether
   there is one. */
static inline __attribute__((always_inline)) bool trace_below(const trax_scene_ref *root, const struct ray *ray,
                                                              bool any, struct hit *hit) {
  const char *bytes = scene.data; /* references are offsets from its beginning */
  trax_scene_ref stack[TRAX_SCENE_DEFAULT_DEPTH], reference = *root;
  unsigned top = 0;
  for (;;) {
    unsigned count = TRAX_SCENE_REF_COUNT(reference);
    if (__builtin_expect(count == 0, 1)) { /* rays visit more nodes than triangles */
      const struct trax_quantised_node *node = (const void *)(bytes + reference);
      int enter0, enter1, nearest = in_units_of_boxes(hit->distance);
      if (hit_box(ray, node->box[0].min, nearest, &enter0)) {
        if (hit_box(ray, node->box[1].min, nearest, &enter1)) {
          bool second = enter1 < enter0;
          stack[top++] = node->child[!second];
          reference = node->child[second];
        } else {
          reference = node->child[0];
        }
        continue;
      }
      if (hit_box(ray, node->box[1].min, nearest, &enter1)) {
        reference = node->child[1];
        continue;
      }
    } else {
      const struct trax_triangle *triangle = (const void *)(bytes + TRAX_SCENE_REF_OFFSET(reference));
      for (const struct trax_triangle *end = triangle + count; triangle != end; triangle++)
        if (hit_triangle(&ray->origin, &ray->direction, triangle, any, hit) && any)
          return true;
    }
    if (top == 0)
      return hit->triangle != NULL;
    reference = stack[--top];
  }
}

static inline __attribute__((always_inline)) bool trace(const struct ray *ray, bool any, struct hit *hit) {
  return trace_below(&((const struct trax_scene_header *)scene.data)->root, ray, any, hit);
}

#endif
