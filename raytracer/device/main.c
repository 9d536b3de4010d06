/* The ray tracer that every TP runs: pixel by pixel, a ray from the eye, and a ray from what it hits towards the light.
   Compiled for the TP, and unchanged for the host as the native twin: the pictures are the same bit for bit, since only
   operations that both round alike are used, in the order written.

   The machine shapes the code. Eight TPs share an adder, which also compares floats, and a data-cache bank; a TM shares
   one divider: so comparisons are of integers, planes and edges are tested one by one, and a pixel takes few divisions.
 */
#include "camera.h"
#include "shade.h"
#include "traverse.h"
#include "trax/render_params.h"

#include <trax.h>

struct trax_buffer scene, params, image;
unsigned next_slot; /* shared by all threads: the atomic increment hands out the pixels */

#define FARTHEST_BITS 0x7F000000 /* 2^127, farther than anything in a scene that frame.c accepts */

static inline __attribute__((always_inline)) uint32_t render_pixel(const struct trax_render_params *frame, uint32_t x,
                                                                   uint32_t y) {
  const char *bytes = scene.data;
  trax_scene_ref root = ((const struct trax_scene_header *)scene.data)->root;
  struct vector direction = camera_direction(frame, x, y);
  struct hit hit = {FARTHEST_BITS, 0, 0, 0};
  struct ray ray;

  prepare_ray(&ray, frame->eye[0], frame->eye[1], frame->eye[2], direction.x, direction.y, direction.z,
              frame->box_margin);
  if (!trace_ray(bytes, root, &ray, false, &hit)) {
    trax_count_rays(1);
    return frame->background;
  }

  struct surface surface;
  find_surface(&surface, &hit, direction);
  struct light light;
  aim_at_light(&light, &surface, frame->light);
  float lit = 0;
  if (light.cosine_bits > 0) {
    struct hit shadow = {light.distance_bits, 0, 0, 0};
    prepare_ray(&ray, surface.x, surface.y, surface.z, light.direction.x, light.direction.y, light.direction.z,
                frame->box_margin);
    if (!trace_ray(bytes, root, &ray, true, &shadow))
      lit = bits_float(light.cosine_bits);
    trax_count_rays(2);
  } else {
    trax_count_rays(1);
  }
  const struct trax_palette_entry *palette = (const struct trax_palette_entry *)(frame + 1);
  return shade(frame, palette[surface.material].colour, &surface, lit);
}

int main(void) {
  const struct trax_render_params *frame = params.data;
  unsigned *pixels = image.data;
  for (;;) {
    uint32_t slot = trax_atomic_inc(&next_slot);
    if (slot >= frame->slot_count)
      return 0;
    uint32_t x, y;
    if (!slot_pixel(frame, slot, &x, &y))
      continue;
    trax_store_nt(&pixels[y * frame->width + x], render_pixel(frame, x, y));
    trax_count_items(1);
  }
}
