/* The store buffer of a TM in an epoch (fast/epochs.c): its stores, the addresses of its loads at issue, and the cycles
   of its requests. The memory controller receives the requests at the end of each quantum; the stores take effect at
   the end of the epoch. */
#ifndef TRAX_FAST_STORE_BUFFER_H
#define TRAX_FAST_STORE_BUFFER_H

#include "fast/tm/queue.h"
#include "machine/address_space.h"
#include "trax/map.h"

#include <stdbool.h>
#include <stddef.h>

struct trax_store_buffer_entry {
  uint64_t cycle;
  uint32_t address, value;
  uint32_t bytes; /* of a store; or one of these */
};
enum {
  TRAX_INCREMENT = 0, /* by the controller, in a block that is not SHARED yet */
  TRAX_PRINT = 8,     /* a character of the output */
  TRAX_REQUEST = 16   /* in the memory queue, at the place `address` */
};

/* The stores of a quantum. */
struct trax_store_buffer_side {
  struct trax_store_buffer_entry *entries; /* [count], in the order of issue */
  size_t count, capacity, done;            /* done: those that have been merged */
};

/* 32 bytes of global memory as the TM's own stores have changed them: a thread's stores are often neighbours. */
struct trax_store_buffer_line {
  struct trax_map_entry entry; /* key: address / 32; value: a bit for each byte that they wrote */
  uint8_t bytes[32];
};

struct trax_store_buffer {
  struct trax_store_buffer_side *side, sides[TRAX_SIDES]; /* side: of the quantum that the TM simulates */
  uint32_t *reads; /* [read_count]: the words that loads have read from blocks that are written; docs/fast-engine.md,
                      read set */
  size_t read_count, read_capacity;
  struct trax_map lines; /* of struct trax_store_buffer_line */
  bool stop;             /* the epoch must be given up: output, or out of memory */
};

void trax_store_buffer_destroy(struct trax_store_buffer *buffer);
/* Empties the buffer for a new epoch; the side for a new quantum. */
void trax_store_buffer_begin(struct trax_store_buffer *buffer);
void trax_store_buffer_begin_quantum(struct trax_store_buffer *buffer, unsigned side);

/* Records that the TM has read a word. */
void trax_store_buffer_read(struct trax_store_buffer *buffer, uint32_t address);
/* Performs an aligned load or store of global memory in cycle t, which must have been checked. */
uint32_t trax_store_buffer_load(struct trax_store_buffer *buffer, const struct trax_space *space, uint32_t address,
                                unsigned bytes);
void trax_store_buffer_store(struct trax_store_buffer *buffer, uint64_t t, uint32_t address, uint32_t value,
                             unsigned bytes);
/* Records the issue of an atomic increment, a character that the program prints, or a request, which has taken a place
   in the memory queue. */
void trax_store_buffer_record(struct trax_store_buffer *buffer, struct trax_store_buffer_entry entry);

#endif
