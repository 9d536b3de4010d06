/* Traversal of the BVH: the nearest hit of a ray, or whether there is any.

   Boxes are tested plane by plane and left as soon as the ray is known to miss, and all comparisons are of integers: a
   node costs between 2 and 6 adds and multiplies a child, and a load for each plane. */
#ifndef TRAX_DEVICE_TRAVERSE_H
#define TRAX_DEVICE_TRAVERSE_H

#include "ray.h"
#include "run.h"
#include "trax/scene_format.h"

#include <stdbool.h>
#include <stddef.h>

#define BOX_MISSED INT32_MAX

static inline uint32_t load_word(const char *address) {
  return *(const uint32_t *)(const void *)address;
}

/* Where the ray enters the slab between two planes of a child's box, as bits, given where it has entered (at 0 or
   later) and left the box so far; BOX_MISSED if it has left before it enters. Distances are compared as integers: a
   negative far distance, whatever its size, is less than `enter`, which is never negative; a negative near distance is
   less too. */
#define CLIP_TO_SLAB(AXIS, BYTES)                                                                                      \
  do {                                                                                                                 \
    float plane_near = load_float(node + ray->near_offset_##AXIS + (BYTES) + 24 * child);                              \
    float plane_far = load_float(node - ray->near_offset_##AXIS + 12 + (BYTES) + 24 * child);                          \
    int32_t near_bits = float_bits((plane_near - ray->near_origin_##AXIS) * ray->inverse_##AXIS);                      \
    int32_t far_bits = float_bits((plane_far - ray->far_origin_##AXIS) * ray->inverse_##AXIS);                         \
    if (near_bits > enter)                                                                                             \
      enter = near_bits;                                                                                               \
    if (far_bits < leave)                                                                                              \
      leave = far_bits;                                                                                                \
    if (enter > leave)                                                                                                 \
      return BOX_MISSED;                                                                                               \
  } while (0)

static inline __attribute__((always_inline)) int32_t enter_box(const struct ray *ray, const char *node, int child,
                                                               int32_t limit_bits) {
  int32_t enter = 0, leave = limit_bits;
  CLIP_TO_SLAB(x, 0);
  CLIP_TO_SLAB(y, 4);
  CLIP_TO_SLAB(z, 8);
  return enter;
}

/* The stack holds the farther child of every inner node above the current one: TRAX_SCENE_MAX_DEPTH bounds it, which
   the host checks; TRAX_STACK_ENTRIES is that or what the scene takes. */
struct stack_entry {
  trax_scene_ref reference;
  int32_t enter; /* where the ray enters its box */
};

/* The nearest hit before hit->distance_bits into *hit, or, if any hit will do, whether there is one. The probabilities
   tell the register allocator what matters: rays visit many more nodes than triangles. */
static inline __attribute__((always_inline)) bool trace_ray(const char *scene, trax_scene_ref reference,
                                                            const struct ray *ray, bool any, struct hit *hit) {
  struct stack_entry stack[TRAX_STACK_ENTRIES], *top = stack;

  if (reference == 0)
    return false;
  for (;;) {
    while (__builtin_expect_with_probability(TRAX_SCENE_REF_COUNT(reference) == 0, 1, 0.95)) {
      const char *node = scene_at(scene, reference);
      int32_t enter0 = enter_box(ray, node, 0, hit->distance_bits);
      int32_t enter1 = enter_box(ray, node, 1, hit->distance_bits);
      if (enter0 <= enter1) {
        if (enter0 == BOX_MISSED)
          goto back;
        reference = load_word(node + 48);
        if (enter1 != BOX_MISSED)
          *top++ = (struct stack_entry){load_word(node + 52), enter1};
      } else {
        reference = load_word(node + 52);
        if (enter0 != BOX_MISSED)
          *top++ = (struct stack_entry){load_word(node + 48), enter0};
      }
    }

    const char *triangle = scene_at(scene, TRAX_SCENE_REF_OFFSET(reference));
    const char *end = triangle + TRAX_SCENE_REF_COUNT(reference) * sizeof(struct trax_triangle);
    do {
      HIDE_ORIGIN(triangle); /* else three pointers would be stepped instead of one */
      if (hit_triangle(&ray->triangle, triangle, any, hit) && any)
        return true;
      triangle += sizeof(struct trax_triangle);
    } while (__builtin_expect_with_probability(triangle != end, 1, 0.5));

  back:
    do {
      if (top == stack)
        return hit->triangle != NULL;
      top--;
    } while (top->enter >= hit->distance_bits);
    reference = top->reference;
  }
}

#endif
