/* The ray tracer's shading: the surface, the light and the colour of every ray that hit something. */
#include "scene.h"

#include "aim.h"
#include "shade.h"
#include "traverse.h"

static struct hit hits[WIDTH * HEIGHT];

void kernel_setup(void) {
  make_scene();
  uint32_t random = 7;
  for (int i = 0; i < WIDTH * HEIGHT; i++) {
    hits[i].triangle = (const char *)&hills.triangles[next_random(&random) >> 21];
    hits[i].weight1 = 0.5f * next_float(&random);
    hits[i].weight2 = 0.5f * next_float(&random);
  }
}

struct result kernel_run(void) {
  const struct trax_render_params *params = &frame.params;
  struct vector eye = {params->eye[0], params->eye[1], params->eye[2]};
  uint32_t checksum = 0;
  float sum = 0;
  for (int i = 0; i < WIDTH * HEIGHT; i++) {
    struct surface surface;
    struct light way;
    find_surface(&surface, &hits[i], eye, eye);
    aim_at_light(&way, &surface, params->light);
    float light = ambient_light(params, &surface);
    if (way.cosine_bits > 0)
      light += params->light_strength * bits_float(way.cosine_bits);
    uint32_t pixel = shade(frame.palette[triangle_material(hits[i].triangle)].colour, light);
    checksum = mix(checksum, pixel);
    sum += (float)(int32_t)(pixel & 255);
  }
  return (struct result){checksum, sum / (WIDTH * HEIGHT)};
}
