/* The tiles and queues of step 7, which step 8 keeps. */
#ifndef TRAX_EXAMPLES_QUEUES_H
#define TRAX_EXAMPLES_QUEUES_H

#include "picture.h"

#ifndef QUEUES
#define QUEUES 4 /* as many as the chip has TMs */
#endif
unsigned taken[QUEUES]; /* slots of each queue; shared by all threads */

/* The pixels of a tile stand along a Z-order curve. Tiles stand row by row; a tile's row is its number divided by the
   tiles of a row, which takes a multiplication (trax/render_params.h). False: the slot is beyond the picture's edge. */
static inline bool slot_pixel(const struct trax_render_params *frame, unsigned slot, unsigned *x, unsigned *y) {
  unsigned tile = slot >> 2 * frame->tile_log2_side;
  unsigned row = (unsigned)((uint64_t)(2 * tile) * frame->row_multiplier >> 32) >> frame->row_shift;
  unsigned column = tile - row * frame->tiles_across;
  unsigned within = slot & ((1u << 2 * frame->tile_log2_side) - 1);
  *x = column << frame->tile_log2_side | even_bits(within);
  *y = row << frame->tile_log2_side | even_bits(within >> 1);
  return *x < frame->width && *y < frame->height;
}

/* Queue q of N has the tiles q, q + N, q + 2 N and so on. */
static inline unsigned take_slot(const struct trax_render_params *frame, unsigned queue) {
  unsigned tile_bits = 2 * frame->tile_log2_side, number = trax_atomic_inc(&taken[queue]);
  return ((number >> tile_bits) * QUEUES + queue) << tile_bits | (number & ((1u << tile_bits) - 1));
}

#endif
