/* Step 5: quantised nodes. The planes of all boxes are numbers of 16 bits on one grid for the whole scene, rounded
   outwards, so that a node, with both of its children's boxes, takes 32 bytes instead of 64: twice as many are in the
   cache, and a line that misses brings two. The scene is the file as trax-scene wrote it (trax/scene_format.h). */
#include "quantised.h"

struct trax_buffer scene, params, image;
unsigned next_pixel; /* shared by all threads */

/* The nearest hit before hit->distance; or, if any hit will do, whether there is one. */
static __attribute__((noinline)) bool trace(const struct ray *ray, bool any, struct hit *hit) {
  const char *bytes = scene.data; /* references are offsets from its beginning */
  trax_scene_ref stack[TRAX_SCENE_DEFAULT_DEPTH], reference = ((const struct trax_scene_header *)bytes)->root;
  unsigned top = 0;
  for (;;) {
    unsigned count = TRAX_SCENE_REF_COUNT(reference);
    if (count == 0) {
      const struct trax_quantised_node *node = (const void *)(bytes + reference);
      int enter0, enter1, nearest = in_units_of_boxes(hit->distance);
      bool hit0 = hit_box(ray, node->box[0].min, nearest, &enter0);
      bool hit1 = hit_box(ray, node->box[1].min, nearest, &enter1);
      if (hit0 && hit1) {
        bool second = enter1 < enter0;
        stack[top++] = node->child[!second];
        reference = node->child[second];
        continue;
      }
      if (hit0 || hit1) {
        reference = node->child[hit1];
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

#include "pixel.h"

int main(void) {
  const struct trax_render_params *frame = params.data;
  check_input(frame, scene.data);
  unsigned pixels = frame->width * frame->height;
  for (unsigned pixel = trax_atomic_inc(&next_pixel); pixel < pixels; pixel = trax_atomic_inc(&next_pixel)) {
    trax_store_nt((unsigned *)image.data + pixel, render(frame, pixel % frame->width, pixel / frame->width));
    trax_count_items(1);
  }
  return 0;
}
