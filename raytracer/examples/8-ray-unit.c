/* Step 8: the ray unit. Boxes and triangles are tested by a unit that TPs share: two instructions, which read a ray and
   a box or a triangle from registers. Then threads wait for the data cache, so two planes of a box are one load.
   The paper's machine has no such unit (docs/results/ray-unit.md). The program needs ray.units_per_group=1. */
#include "quantised.h"
#include "queues.h"

struct trax_buffer scene, params, image;

/* Two planes of a word. The numbers of 16 bits are not converted: taken for floats they are subnormals, the numbers
   times 2^-149, which the unit multiplies as any other. */
static inline float lower(uint32_t word) {
  return value(word & 0xFFFF);
}
static inline float upper(uint32_t word) {
  return value(word >> 16);
}

/* The distance at which the ray enters the box, or infinity if it does not do so before `nearest`. */
static inline float enter_box(const struct ray *ray, const uint16_t *planes, float nearest) {
  uint32_t box[3];
  __builtin_memcpy(box, __builtin_assume_aligned(planes, 4), sizeof box);
  return __builtin_trax_box(nearest, ray->factor.x, ray->factor.y, ray->factor.z, ray->start.x, ray->start.y,
                            ray->start.z, lower(box[0]), upper(box[0]), lower(box[1]), upper(box[1]), lower(box[2]),
                            upper(box[2]));
}

/* The distance at which the ray hits the triangle, if that is before `nearest`, else `nearest`. */
static inline float reach_triangle(const struct ray *ray, const struct trax_triangle *triangle, float nearest) {
  const float *a = triangle->v0, *b = triangle->v1, *c = triangle->v2;
  return __builtin_trax_triangle(nearest, ray->origin.x, ray->origin.y, ray->origin.z, ray->direction.x,
                                 ray->direction.y, ray->direction.z, a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1],
                                 c[2]);
}

/* The nearest hit before hit->distance; or, if any hit will do, whether there is one. */
static inline __attribute__((always_inline)) bool trace(const struct ray *ray, bool any, struct hit *hit) {
  const char *bytes = scene.data; /* references are offsets from its beginning */
  trax_scene_ref stack[TRAX_SCENE_DEFAULT_DEPTH], reference = ((const struct trax_scene_header *)bytes)->root;
  unsigned top = 0;
  for (;;) {
    unsigned count = TRAX_SCENE_REF_COUNT(reference);
    if (__builtin_expect(count == 0, 1)) { /* rays visit more nodes than triangles */
      const struct trax_quantised_node *node = (const void *)(bytes + reference);
      int nearest = in_units_of_boxes(hit->distance); /* not infinite */
      int enter0 = bits(enter_box(ray, node->box[0].min, value(nearest)));
      int enter1 = bits(enter_box(ray, node->box[1].min, value(nearest)));
      bool second = enter1 < enter0;
      if ((second ? enter1 : enter0) <= nearest) {
        if ((second ? enter0 : enter1) <= nearest)
          stack[top++] = node->child[!second];
        reference = node->child[second];
        continue;
      }
    } else {
      const struct trax_triangle *triangle = (const void *)(bytes + TRAX_SCENE_REF_OFFSET(reference));
      for (const struct trax_triangle *end = triangle + count; triangle != end; triangle++) {
        float distance = reach_triangle(ray, triangle, hit->distance);
        if (bits(distance) < bits(hit->distance)) {
          *hit = (struct hit){distance, triangle};
          if (any)
            return true;
        }
      }
    }
    if (top == 0)
      return hit->triangle != NULL;
    reference = stack[--top];
  }
}

#include "registers.h"

int main(void) {
  const struct trax_render_params *frame = params.data;
  check_input(frame, scene.data);
  for (unsigned turn = 0; turn < QUEUES; turn++) { /* a thread whose queue is empty goes on with the next */
    unsigned queue = (trax_tm() + turn) % QUEUES, slot, x, y;
    while ((slot = take_slot(frame, queue)) < frame->slot_count) {
      if (!slot_pixel(frame, slot, &x, &y))
        continue;
      trax_store_nt((unsigned *)image.data + y * frame->width + x, render(frame, x, y));
      trax_count_items(1);
    }
  }
  return 0;
}
