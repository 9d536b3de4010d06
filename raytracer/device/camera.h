/* From a slot to its pixel, and from a pixel to its ray. */
#ifndef TRAX_DEVICE_CAMERA_H
#define TRAX_DEVICE_CAMERA_H

#include "sampler.h"
#include "trax/render_params.h"
#include "vector.h"

#include <stdbool.h>

/* A pixel's place, in one word: it is kept during the traversal, where registers and stack are scarce. */
struct pixel {
  uint32_t packed; /* y << 16 | x, each less than TRAX_RENDER_MAX_SIDE */
};

static inline struct pixel pixel_at(uint32_t x, uint32_t y) {
  return (struct pixel){y << 16 | x};
}
static inline uint32_t pixel_x(struct pixel pixel) {
  return pixel.packed & 0xFFFF;
}
static inline uint32_t pixel_y(struct pixel pixel) {
  return pixel.packed >> 16;
}

/* False: the slot is past the picture's edge. */
static inline bool slot_pixel(const struct trax_render_params *frame, uint32_t slot, struct pixel *pixel) {
  uint32_t log2_width = frame->tile_log2_width, log2_height = frame->tile_log2_height;
  uint32_t tile = slot >> (log2_width + log2_height);
  uint32_t tile_row = (uint32_t)((uint64_t)(2 * tile) * frame->row_multiplier >> 32) >> frame->row_shift;
  uint32_t tile_column = tile - tile_row * frame->tiles_across;
  uint32_t x = tile_column << log2_width | (slot & ((1u << log2_width) - 1));
  uint32_t y = tile_row << log2_height | (slot >> log2_width & ((1u << log2_height) - 1));
  *pixel = pixel_at(x, y);
  return x < frame->width && y < frame->height;
}

/* Where in its pixel the ray number `sample` goes through, from the pixel's upper left corner. The first is in the
   middle; the others follow the sequence R2 (Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018):
   any number of them is spread evenly. In integers, so exact. */
static inline struct place sample_place(uint32_t sample) {
  uint32_t x = 0x80000000u + sample * 0xC13FA9A9u; /* 2^32 / g and 2^32 / g^2, where g^3 = g + 1 */
  uint32_t y = 0x80000000u + sample * 0x91E10DA5u;
  return (struct place){(float)(int32_t)(x >> 8) * 0x1p-24f, (float)(int32_t)(y >> 8) * 0x1p-24f};
}

/* Of the ray through a place of the pixel. */
static inline struct vector camera_direction(const struct trax_render_params *frame, struct pixel pixel,
                                             struct place place) {
  float column = (float)(int32_t)pixel_x(pixel) + place.x, row = (float)(int32_t)pixel_y(pixel) + place.y;
  struct vector direction = {frame->corner[0] + column * frame->step_x[0] + row * frame->step_y[0],
                             frame->corner[1] + column * frame->step_x[1] + row * frame->step_y[1],
                             frame->corner[2] + column * frame->step_x[2] + row * frame->step_y[2]};
  return direction;
}

#endif
