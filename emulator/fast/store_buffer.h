/* What a TM does to the world while it runs ahead of the others for some cycles (fast/epochs.c): it keeps it to
   itself. Stores become visible to others, and requests known to the controller, when all TMs have come as far. */
#ifndef TRAX_FAST_STORE_BUFFER_H
#define TRAX_FAST_STORE_BUFFER_H

#include "machine/address_space.h"

#include <stdbool.h>
#include <stddef.h>

struct trax_store_buffer_write {
  uint64_t cycle;
  uint32_t address, value;
  uint32_t bytes; /* 0: no store, but an atomic increment that is going to write there */
};

/* What the TM's own stores have made of a word. */
struct trax_store_buffer_word {
  uint64_t round;   /* of the entry; the table is empty but for those of this round */
  uint32_t address; /* a multiple of 4 */
  uint32_t value, mask;
};

struct trax_store_buffer {
  struct trax_store_buffer_write *writes; /* [write_count], in the order of issue */
  size_t write_count, write_capacity;
  uint32_t *reads; /* [read_count]: addresses of words; loads that were not executed before their issue */
  size_t read_count, read_capacity;
  uint64_t *requests; /* [request_count]: the cycles in which they were made */
  size_t request_count, request_capacity;
  struct trax_store_buffer_word *words; /* [word_capacity], a power of two; open addressing */
  size_t word_count, word_capacity;
  uint64_t round;
  bool stop; /* something happened that must not happen ahead, or the host's memory ran out */
};

void trax_store_buffer_destroy(struct trax_store_buffer *buffer);
/* Forgets everything. */
void trax_store_buffer_begin(struct trax_store_buffer *buffer);

/* A load or store of global memory, aligned, in cycle t. */
uint32_t trax_store_buffer_load(struct trax_store_buffer *buffer, const struct trax_space *space, uint32_t address,
                                unsigned bytes);
void trax_store_buffer_store(struct trax_store_buffer *buffer, uint64_t t, uint32_t address, uint32_t value,
                             unsigned bytes);
/* An atomic increment has been issued. */
void trax_store_buffer_increment(struct trax_store_buffer *buffer, uint64_t t, uint32_t address);
/* A request has taken a place in the memory queue. */
void trax_store_buffer_request(struct trax_store_buffer *buffer, uint64_t t);

#endif
