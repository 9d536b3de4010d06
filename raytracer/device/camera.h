/* The pixel of a slot, and the rays of a pixel. */
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

/* The place of a number on Hilbert's curve through a square of side 2^log2_side, at most 2^5, from the upper left
   corner to the upper right one. Each pair of bits chooses a quadrant, and turns or mirrors everything within it. All
   turns are computed at once, by exclusive ors over the higher pairs (Warren, "Hacker's Delight", 2nd edition, section
   16-2). */
static inline void curve_place(uint32_t number, uint32_t log2_side, uint32_t *x, uint32_t *y) {
  const uint32_t pairs = 0x155, within = (1u << 2 * log2_side) - 1; /* the lower bit of each pair */
  uint32_t bits = (number & within) | (pairs & ~within);            /* a pair 01 turns nothing */
  uint32_t high = bits >> 1 & pairs;
  uint32_t turns = ((bits & pairs) + high) ^ pairs;
  turns ^= turns >> 2;
  turns ^= turns >> 4;
  turns ^= turns >> 8;
  uint32_t flipped = (bits & turns & pairs) ^ (turns >> 1 & pairs);
  bits = (bits ^ high ^ flipped ^ flipped << 1) & within;
  uint32_t across = bits >> 1 & pairs, down = bits & pairs;
  across = (across | across >> 1) & 0x133, down = (down | down >> 1) & 0x133;
  across = (across | across >> 2) & 0x10F, down = (down | down >> 2) & 0x10F;
  *x = (across | across >> 4) & 0x1F;
  *y = (down | down >> 4) & 0x1F;
}

/* False if the slot is past the picture's edge. */
static inline bool slot_pixel(const struct trax_render_params *frame, uint32_t slot, struct pixel *pixel) {
  uint32_t log2_side = frame->tile_log2_side, tile = slot >> 2 * log2_side;
  uint32_t tile_row = (uint32_t)((uint64_t)(2 * tile) * frame->row_multiplier >> 32) >> frame->row_shift;
  uint32_t tile_column = tile - tile_row * frame->tiles_across;
  uint32_t x, y;
  curve_place(slot, log2_side, &x, &y);
  x |= tile_column << log2_side;
  y |= tile_row << log2_side;
  *pixel = pixel_at(x, y);
  return x < frame->width && y < frame->height;
}

/* The point of the pixel that ray number `sample` goes through, from the pixel's upper left corner. The first is the
   middle; the others follow the sequence R2 (Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018),
   of which any number of points is spread evenly. Integers make it exact. */
static inline struct place sample_place(uint32_t sample) {
  uint32_t x = 0x80000000u + sample * 0xC13FA9A9u; /* 2^32 / g and 2^32 / g^2, where g^3 = g + 1 */
  uint32_t y = 0x80000000u + sample * 0x91E10DA5u;
  return (struct place){(float)(int32_t)(x >> 8) * 0x1p-24f, (float)(int32_t)(y >> 8) * 0x1p-24f};
}

/* The direction of the ray through a place of the pixel. */
static inline struct vector camera_direction(const struct trax_render_params *frame, struct pixel pixel,
                                             struct place place) {
  float column = (float)(int32_t)pixel_x(pixel) + place.x, row = (float)(int32_t)pixel_y(pixel) + place.y;
  struct vector direction = {frame->corner[0] + column * frame->step_x[0] + row * frame->step_y[0],
                             frame->corner[1] + column * frame->step_x[1] + row * frame->step_y[1],
                             frame->corner[2] + column * frame->step_x[2] + row * frame->step_y[2]};
  return direction;
}

#endif
