/* The ray tracer's triangle test: some rays against every triangle. */
#include "scene.h"

#include "camera.h"
#include "traverse.h"

void kernel_setup(void) {
  make_scene();
}

struct result kernel_run(void) {
  const struct trax_render_params *params = &frame.params;
  uint32_t checksum = 0;
  float sum = 0;
  for (unsigned i = 0; i < 16; i++) {
    struct vector direction = camera_direction(params, pixel_at(4 * i + 2, 18 + i), PIXEL_MIDDLE);
    struct ray ray;
    struct hit hit = {0x7F000000, NULL, 0, 0};
    prepare_ray(&ray, TRAX_NODES_BINARY, load_vector(params->eye), direction, params->box_margin, NULL);
    const char *triangle = (const char *)hills.triangles, *end = triangle + sizeof hills.triangles;
    do {
      hit_triangle(&ray.triangle, triangle, false, &hit);
      triangle += sizeof(struct trax_triangle);
    } while (triangle != end);
    checksum = mix(mix_float(checksum, hit.weight2), (uint32_t)hit.distance_bits);
    if (hit.triangle)
      sum += bits_float(hit.distance_bits);
  }
  return (struct result){checksum, sum / 16};
}
