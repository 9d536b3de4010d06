/* From a slot to its pixel, and from a pixel to its ray. */
#ifndef TRAX_DEVICE_CAMERA_H
#define TRAX_DEVICE_CAMERA_H

#include "trax/render_params.h"

#include <stdbool.h>

struct vector {
  float x, y, z;
};

/* False: the slot is past the picture's edge. */
static inline bool slot_pixel(const struct trax_render_params *frame, uint32_t slot, uint32_t *x, uint32_t *y) {
  uint32_t log2_width = frame->tile_log2_width, log2_height = frame->tile_log2_height;
  uint32_t tile = slot >> (log2_width + log2_height);
  uint32_t tile_row = (uint32_t)((uint64_t)(2 * tile) * frame->row_multiplier >> 32) >> frame->row_shift;
  uint32_t tile_column = tile - tile_row * frame->tiles_across;
  *x = tile_column << log2_width | (slot & ((1u << log2_width) - 1));
  *y = tile_row << log2_height | (slot >> log2_width & ((1u << log2_height) - 1));
  return *x < frame->width && *y < frame->height;
}

static inline struct vector camera_direction(const struct trax_render_params *frame, uint32_t x, uint32_t y) {
  float column = (float)(int32_t)x + 0.5f, row = (float)(int32_t)y + 0.5f;
  struct vector direction = {frame->corner[0] + column * frame->step_x[0] + row * frame->step_y[0],
                             frame->corner[1] + column * frame->step_x[1] + row * frame->step_y[1],
                             frame->corner[2] + column * frame->step_x[2] + row * frame->step_y[2]};
  return direction;
}

#endif
