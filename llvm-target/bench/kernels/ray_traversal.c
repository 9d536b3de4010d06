/* The ray tracer's traversal: the nearest hit of every ray of the picture. */
#include "scene.h"

#include "camera.h"
#include "traverse.h"

void kernel_setup(void) {
  make_scene();
}

/* A function of its own, as 512 bytes of stack have no room for everything at once. */
__attribute__((noinline)) static bool trace(const struct trax_render_params *params, unsigned x, unsigned y,
                                            struct hit *found) {
  struct vector direction = camera_direction(params, pixel_at(x, y), PIXEL_MIDDLE);
  struct ray ray;
  struct hit hit = {0x7F000000, NULL, 0, 0};
  prepare_ray(&ray, TRAX_NODES_BINARY, load_vector(params->eye), direction, params->box_margin, NULL);
  bool any = trace_ray(TRAX_NODES_BINARY, (const char *)&hills, hills.header.root, &ray, false, &hit);
  *found = hit;
  return any;
}

struct result kernel_run(void) {
  uint32_t checksum = 0;
  float sum = 0;
  for (unsigned y = 0; y < HEIGHT; y++)
    for (unsigned x = 0; x < WIDTH; x++) {
      struct hit hit;
      if (trace(&frame.params, x, y, &hit)) {
        checksum = mix(checksum, (uint32_t)hit.distance_bits);
        checksum = mix_float(checksum, hit.weight1);
        sum += bits_float(hit.distance_bits);
      }
    }
  return (struct result){checksum, sum / (WIDTH * HEIGHT)};
}
