/* Traversal of the BVH: the nearest hit of a ray, or whether there is any.

   Boxes are tested plane by plane and left as soon as the ray is known to miss, and all comparisons are of integers: a
   node costs between 2 and 6 adds and multiplies a child, and a load for each plane. */
#ifndef TRAX_DEVICE_TRAVERSE_H
#define TRAX_DEVICE_TRAVERSE_H

#include "access.h"
#include "ray.h"
#include "run.h"
#include "stack.h"
#include "trax/scene_format.h"

#include <stdbool.h>
#include <stddef.h>

static inline uint32_t load_word(const char *address) {
  return *(const uint32_t *)(const void *)address;
}

/* Where along the ray a plane is, as bits: binary32, or a number on a grid (ray.h). */
static inline __attribute__((always_inline)) int32_t plane_distance(uint32_t layout, const char *address, float origin,
                                                                    float inverse) {
  if (NODES_HAVE_FRAMES(layout))
    return float_bits(bits_float(*(const uint8_t *)address) * inverse - origin);
  if (NODES_ON_GRID(layout))
    return float_bits(bits_float(*(const uint16_t *)(const void *)address) * inverse - origin);
  return float_bits((load_float(address) - origin) * inverse);
}

/* Brings one axis of a ray into a node's frame (scene_format.h, struct trax_quantised8_node). */
#define ENTER_FRAME(AXIS, NUMBER)                                                                                      \
  do {                                                                                                                 \
    uint32_t word = load_word(node + (NUMBER)*4);                                                                      \
    float first = bits_float((int32_t)word) * way.inverse.AXIS;                                                        \
    way.near_origin.AXIS -= first, way.far_origin.AXIS -= first;                                                       \
    way.inverse.AXIS = bits_float(float_bits(way.inverse.AXIS) + (int32_t)(word << 23));                               \
  } while (0)

/* Clips the ray's way through a box to the slab between two of its planes. False: nothing of it remains. Distances are
   compared as integers. Of two negative ones that may go wrong, but to enter anywhere before 0 is as good as another
   place, and who leaves before 0 has missed in any case, which is asked at the end. */
static inline __attribute__((always_inline)) bool clip_to_slab(uint32_t layout, const char *near, const char *far,
                                                               float near_origin, float far_origin, float inverse,
                                                               int32_t *enter, int32_t *leave) {
  int32_t near_bits = plane_distance(layout, near, near_origin, inverse);
  int32_t far_bits = plane_distance(layout, far, far_origin, inverse);
  if (near_bits > *enter)
    *enter = near_bits;
  if (far_bits < *leave)
    *leave = far_bits;
  return *enter <= *leave;
}

/* Where the ray enters a box, as bits, if it does so before `limit`. A box is six planes, the three least ones first.
 */
static inline __attribute__((always_inline)) bool enter_box(uint32_t layout, const char *box, const struct ray *ray,
                                                            const struct box_ray *way, int32_t limit, int32_t *enter) {
  const int plane = NODE_PLANE_BYTES(layout);
  const char *least = box, *greatest = box + 3 * plane;
  int32_t leave = limit;
  *enter = INT32_MIN;
  return clip_to_slab(layout, least + ray->near_offset_x, greatest - ray->near_offset_x, way->near_origin.x,
                      way->far_origin.x, way->inverse.x, enter, &leave) &&
         clip_to_slab(layout, least + plane + ray->near_offset_y, greatest + plane - ray->near_offset_y,
                      way->near_origin.y, way->far_origin.y, way->inverse.y, enter, &leave) &&
         clip_to_slab(layout, least + 2 * plane + ray->near_offset_z, greatest + 2 * plane - ray->near_offset_z,
                      way->near_origin.z, way->far_origin.z, way->inverse.z, enter, &leave) &&
         leave >= 0;
}

#define FIRST_BOX(layout) (NODES_HAVE_FRAMES(layout) ? 12 : 0)

/* Goes from a node to the nearer of the children that the ray enters; the other one is put on the stack. False: it
   enters none. */
static inline __attribute__((always_inline)) bool visit_node(uint32_t layout, const char *node, const struct ray *ray,
                                                             int32_t limit, trax_scene_ref *reference,
                                                             struct stack_entry *stack, struct stack_entry **top,
                                                             struct trail *trail) {
  const int plane = NODE_PLANE_BYTES(layout), first_box = FIRST_BOX(layout), second_box = first_box + 6 * plane;
  const int children = second_box + 6 * plane;
  struct box_ray way = ray->box;
  int32_t enter0, enter1;
  if (NODES_HAVE_FRAMES(layout)) {
    ENTER_FRAME(x, 0);
    ENTER_FRAME(y, 1);
    ENTER_FRAME(z, 2);
  }
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

/* Puts the children of a wide node that the ray enters on the stack, the nearest last. */
static inline __attribute__((always_inline)) void
visit_wide_node(uint32_t layout, const char *whole, const struct ray *ray, int32_t limit, struct stack_entry **top) {
  const int plane = NODE_PLANE_BYTES(layout), first_box = FIRST_BOX(layout), second_box = first_box + 6 * plane;
  const int children = second_box + 6 * plane;
  const struct stack_entry *bottom = *top;
  const char *node = whole;
  struct box_ray way = ray->box;
  if (NODES_HAVE_FRAMES(layout)) {
    ENTER_FRAME(x, 0);
    ENTER_FRAME(y, 1);
    ENTER_FRAME(z, 2);
  }
  KEEP_ROLLED
  for (;; node += 12 * plane + 8) {
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

/* From the root to the child that the trail leads to, whose entry the stack has lost. It may be behind the nearest hit,
   which a visit finds out: to test its box here takes more than it saves. */
static inline trax_scene_ref find_again(uint32_t layout, const char *scene, trax_scene_ref root,
                                        const struct trail *trail) {
  const int children = FIRST_BOX(layout) + 12 * NODE_PLANE_BYTES(layout);
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

/* The nearest hit before hit->distance_bits into *hit, or, if any hit will do, whether there is one. The probabilities
   tell the register allocator what matters: rays visit many more nodes than triangles. */
static inline __attribute__((always_inline)) bool trace_ray(uint32_t layout, const char *scene, trax_scene_ref root,
                                                            const struct ray *ray, bool any, struct hit *hit) {
  /* Of wide nodes the child that is visited next is on it, too. */
  struct stack_entry stack[TRAX_STACK_ENTRIES + (NODES_ARE_WIDE(layout) ? 1 : 0)], *top = stack, entry;
  struct trail trail;
  trax_scene_ref reference = root;
#define LIMIT() (NODES_ON_GRID(layout) ? distance_on_grid(layout, hit->distance_bits) : hit->distance_bits)
  int32_t limit = LIMIT(); /* boxes that begin there or later are left out */

  if (root == 0)
    return false;
  if (STACK_IS_SHORT)
    trail_begin(&trail);
  stack_begin(stack);
  for (;;) {
    while (__builtin_expect_with_probability(TRAX_SCENE_REF_COUNT(reference) == 0, 1, 0.95)) {
      const char *node = scene_at(scene, reference);
      ACCESS_NODE(node);
      if (STACK_IS_SHORT)
        trail_make_room(&trail);
        /* The layout's own code, where it is known at run time only. */
#define VISIT(LAYOUT) visit_node(LAYOUT, node, ray, limit, &reference, stack, &top, &trail)
      if (NODES_ARE_WIDE(layout)) {
        if (layout == TRAX_NODES_WIDE)
          visit_wide_node(TRAX_NODES_WIDE, node, ray, limit, &top);
        else if (layout == TRAX_NODES_WIDE_QUANTISED)
          visit_wide_node(TRAX_NODES_WIDE_QUANTISED, node, ray, limit, &top);
        else
          visit_wide_node(TRAX_NODES_WIDE_QUANTISED8, node, ray, limit, &top);
        goto back;
      }
      if (!(NODES_HAVE_FRAMES(layout) ? VISIT(TRAX_NODES_QUANTISED8)
            : NODES_ON_GRID(layout)   ? VISIT(TRAX_NODES_QUANTISED)
                                      : VISIT(TRAX_NODES_BINARY)))
        goto back;
#undef VISIT
    }

    const char *triangle = scene_at(scene, TRAX_SCENE_REF_OFFSET(reference));
    const char *end = triangle + TRAX_SCENE_REF_COUNT(reference) * sizeof(struct trax_triangle);
    do {
      HIDE_ORIGIN(triangle); /* else three pointers would be stepped instead of one */
      ACCESS_TRIANGLE(triangle);
      if (hit_triangle(&ray->triangle, triangle, any, hit) && any)
        return true;
      triangle += sizeof(struct trax_triangle);
    } while (__builtin_expect_with_probability(triangle != end, 1, 0.5));
    limit = LIMIT();
#undef LIMIT

  back:
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
