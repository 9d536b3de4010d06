/* The store buffer of a TM in an epoch (fast/epochs.c): its stores, what it has read, and the cycles of its requests
   and of its stores to SHARED blocks. The memory controller receives the requests at the end of each quantum; the
   stores take effect at the end of the epoch. */
#ifndef TRAX_FAST_STORE_BUFFER_H
#define TRAX_FAST_STORE_BUFFER_H

#include "fast/tm/queue.h"
#include "machine/address_space.h"
#include "machine/overlay.h"

struct trax_store_buffer_entry {
  uint64_t cycle;
  uint32_t address, value;
  uint32_t bytes; /* of a store to a SHARED block; or one of these */
};
enum {
  TRAX_INCREMENT = 0, /* by the controller, in a block that is not SHARED yet */
  TRAX_PRINT = 8,     /* a character of the output */
  TRAX_REQUEST = 16   /* in the memory queue, at the place `address` */
};

/* What a quantum has in the order of cycles. */
struct trax_store_buffer_side {
  struct trax_store_buffer_entry *entries; /* [count], in the order of issue */
  size_t count, capacity, done;            /* done: those that have been merged */
};

struct trax_store_buffer {
  struct trax_store_buffer_side *side, sides[TRAX_SIDES]; /* side: of the quantum that the TM simulates */
  struct trax_overlay written; /* as the TM's own stores have changed memory; read: the words that loads have read from
                                  blocks that are written; docs/fast-engine.md, read set */
  bool stop;                   /* the epoch must be given up: output, or out of memory */
};

/* Returns the line of an address. NULL: out of memory. */
static inline struct trax_overlay_line *trax_store_buffer_line(struct trax_store_buffer *buffer, uint32_t address) {
  struct trax_overlay_line *const line = trax_overlay_put(&buffer->written, address / TRAX_OVERLAY_BYTES);
  buffer->stop |= !line;
  return line;
}

/* Performs an aligned load of global memory from its line, and remembers it. */
static inline uint32_t trax_store_buffer_load(struct trax_overlay_line *line, const struct trax_space *space,
                                              uint32_t address, unsigned bytes) {
  line->read |= trax_overlay_bits(address, bytes);
  return trax_overlay_load(line, space->bytes, address, bytes);
}

/* Performs an aligned store; one to a SHARED block must be recorded, too. */
static inline void trax_store_buffer_store(struct trax_store_buffer *buffer, uint32_t address, uint32_t value,
                                           unsigned bytes) {
  struct trax_overlay_line *const line = trax_store_buffer_line(buffer, address);
  if (line)
    trax_overlay_store(line, address, value, bytes);
}

/* Records a store to a SHARED block, the issue of an atomic increment, a character that the program prints, or a
   request, which has taken a place in the memory queue. */
static inline void trax_store_buffer_record(struct trax_store_buffer *buffer, struct trax_store_buffer_entry entry) {
  struct trax_store_buffer_side *const side = buffer->side;
  if (trax_grow((void **)&side->entries, side->count, &side->capacity, sizeof *side->entries))
    side->entries[side->count++] = entry;
  else
    buffer->stop = true; /* the epoch is given up */
}

#endif
