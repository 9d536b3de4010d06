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

/* The pixel's word, and how many rays it took. Both rays go through one copy of the traversal, so that the program fits
   in the instruction cache. */
static inline __attribute__((always_inline)) uint32_t render_pixel(const struct trax_render_params *frame, uint32_t x,
                                                                   uint32_t y, unsigned *rays) {
  const char *bytes = scene.data;
  struct vector origin = {frame->eye[0], frame->eye[1], frame->eye[2]}, direction = camera_direction(frame, x, y);
  struct hit hit = {FARTHEST_BITS, NULL, 0, 0};
  const float *colour = NULL;
  float light = 0, lit = 0;
  unsigned shadow = 0;

  for (;;) {
    struct ray ray;
    prepare_ray(&ray, origin.x, origin.y, origin.z, direction.x, direction.y, direction.z, frame->box_margin);
    HIDE_ORIGIN(shadow); /* or the loop would be unrolled into two copies */
    bool found = trace_ray(bytes, ((const struct trax_scene_header *)scene.data)->root, &ray, shadow, &hit);
    HIDE_ORIGIN(frame); /* what it has is loaded again when needed, not kept during the traversal */
    *rays = 1 + shadow;
    if (shadow)
      return shade(colour, found ? light : light + lit);
    if (!found)
      return frame->background;

    struct surface surface;
    struct light way;
    struct vector eye = {frame->eye[0], frame->eye[1], frame->eye[2]};
    find_surface(&surface, &hit, eye);
    aim_at_light(&way, &surface, frame->light);
    colour = ((const struct trax_palette_entry *)(frame + 1))[surface.material].colour;
    light = ambient_light(frame, &surface);
    if (way.cosine_bits <= 0)
      return shade(colour, light);
    lit = frame->light_strength * bits_float(way.cosine_bits);
    origin = surface.point, direction = way.direction;
    hit = (struct hit){way.distance_bits, NULL, 0, 0};
    shadow = 1;
  }
}

int main(void) {
  const struct trax_render_params *frame = params.data;
  unsigned *pixels = image.data;
  uint32_t slot;
  while ((slot = trax_atomic_inc(&next_slot)) < frame->slot_count) {
    uint32_t x, y;
    if (!slot_pixel(frame, slot, &x, &y))
      continue;
    unsigned *pixel = &pixels[y * frame->width + x], rays;
    trax_store_nt(pixel, render_pixel(frame, x, y, &rays));
    trax_count_rays(rays);
    trax_count_items(1);
  }
  return 0;
}
