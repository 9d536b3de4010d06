/* The ray tracer's whole program: a picture, with shadows. */
#include "scene.h"

int ray_tracer_main(void);
#define main ray_tracer_main
#include "main.c"
#undef main

static uint32_t pixels[WIDTH * HEIGHT];

void kernel_setup(void) {
  make_scene();
  scene.data = &hills;
  params.data = &frame;
  image.data = pixels;
}

struct result kernel_run(void) {
  next_slot[0] = 0;
  ray_tracer_main();
  uint32_t checksum = 0, sum = 0;
  for (int i = 0; i < WIDTH * HEIGHT; i++) {
    checksum = mix(checksum, pixels[i]);
    sum += pixels[i] & 255;
  }
  return (struct result){checksum, (float)(int32_t)sum / (WIDTH * HEIGHT)};
}
