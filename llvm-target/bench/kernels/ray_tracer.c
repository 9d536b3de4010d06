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

/* The loop of render_layout, which does not return on the TP. */
struct result kernel_run(void) {
  const struct trax_render_params *run = params.data;
  next_slot[0] = 0;
  uint32_t checksum = 0, sum = 0, slot, queue = first_queue(), number = ask_for_number(next_slot, queue);
  while (take_slot(run, next_slot, number, &queue, &slot)) {
    struct pixel pixel;
    if (!slot_pixel(run, slot, &pixel)) {
      number = ask_for_number(next_slot, queue);
      continue;
    }
    uint32_t word = render_pixel(run, TRAX_NODES_BINARY, pixel, queue, &number);
    trax_store_nt((unsigned *)image.data + pixel_y(pixel) * run->width + pixel_x(pixel), word);
  }
  for (int i = 0; i < WIDTH * HEIGHT; i++) {
    checksum = mix(checksum, pixels[i]);
    sum += pixels[i] & 255;
  }
  return (struct result){checksum, (float)(int32_t)sum / (WIDTH * HEIGHT)};
}
