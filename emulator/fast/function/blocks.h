/* The blocks of global memory from which bursts have loaded, and those that have been written (blocks.c). */
#ifndef TRAX_FAST_BLOCKS_H
#define TRAX_FAST_BLOCKS_H

#include "fast/store_buffer.h"
#include "machine/address_space.h"
#include "translate/burst.h"

struct trax_chip;
struct trax_tm;

struct trax_fast_blocks {
  /* [block]: 0, then LOADED by a burst, then WRITTEN, then SHARED; or a later one at once. Several TMs may set LOADED
     at the same time. The others are only set while no TM runs. Loads from SHARED blocks and from HOLEs end bursts. */
  uint8_t *state;
  size_t bytes;
  unsigned roll_backs;         /* of all TPs, for the first write of a LOADED block */
  uint32_t input, input_bytes; /* trax_space.input until a first write there: all of it counts as LOADED */
};

static inline bool trax_fast_is_loaded(const struct trax_fast_blocks *blocks, uint32_t address) {
  return __atomic_load_n(&blocks->state[address >> TRAX_BLOCK_SHIFT], __ATOMIC_RELAXED) == TRAX_BLOCK_LOADED ||
         address - blocks->input < blocks->input_bytes;
}

/* Whether no burst loads the word, whatever happens. */
static inline bool trax_fast_is_shared(const struct trax_fast_blocks *blocks, uint32_t address) {
  return __atomic_load_n(&blocks->state[address >> TRAX_BLOCK_SHIFT], __ATOMIC_RELAXED) == TRAX_BLOCK_SHARED;
}

/* Requires that the block is not LOADED, or that all TPs have rolled back. state: WRITTEN or SHARED. */
static inline void trax_fast_set_written(struct trax_fast_blocks *blocks, uint32_t address, uint8_t state) {
  uint8_t *const block = &blocks->state[address >> TRAX_BLOCK_SHIFT];
  *block = *block < state ? state : *block;
  if (address - blocks->input < blocks->input_bytes)
    blocks->input_bytes = 0;
}

/* Makes the block SHARED unless it is LOADED. Several threads may do so at the same time. */
static inline void trax_fast_share(struct trax_fast_blocks *blocks, uint32_t address) {
  if (!trax_fast_is_loaded(blocks, address))
    __atomic_store_n(&blocks->state[address >> TRAX_BLOCK_SHIFT], TRAX_BLOCK_SHARED, __ATOMIC_RELAXED);
}

/* Performs a store of a TM in an epoch. */
static inline void trax_fast_store_in_epoch(const struct trax_fast_blocks *blocks, struct trax_store_buffer *buffer,
                                            uint64_t t, uint32_t address, uint32_t value, unsigned bytes) {
  trax_store_buffer_store(buffer, address, value, bytes);
  if (trax_fast_is_shared(blocks, address))
    trax_store_buffer_record(buffer, (struct trax_store_buffer_entry){t, address, value, bytes});
}

/* Returns the bit of a word in trax_tp.stored. */
static inline uint64_t trax_fast_word_bit(uint32_t address) {
  return (uint64_t)1 << ((address >> 2) * 0x9E3779B1u >> 26);
}

/* Returns the number of 64 bytes in trax_tm.readers: a TP's bursts often load from neighbouring words. */
static inline unsigned trax_fast_line_hash(uint32_t address) {
  return (address >> 6) * 0x9E3779B1u >> 22;
}

trax_status trax_fast_blocks_create(struct trax_fast_blocks *blocks, const struct trax_space *space, trax_error *error);
void trax_fast_blocks_destroy(struct trax_fast_blocks *blocks);
/* To be called outside epochs before a store (WRITTEN) or atomic increment (SHARED) writes to a global address, and
   when the increment is issued: rolls back all TPs whose bursts may have loaded the word. */
void trax_fast_word_written(struct trax_chip *chip, uint32_t address, uint8_t state);
/* Performs store `load` of the TP's burst, whose step is issued in cycle t. False: all TPs must roll back for it, so
   that the store must execute at issue after this TP has rolled back. */
bool trax_fast_store(struct trax_tm *tm, unsigned tp, unsigned load, unsigned bytes, uint64_t t);
/* An atomic increment of the memory controller outside epochs; `chip` is a struct trax_chip. Returns what the word was.
 */
uint32_t trax_fast_increment_outside(void *chip, uint32_t address);
/* As trax_fast_word_written for a range, before a host call writes it. */
void trax_fast_range_written(void *chip, uint32_t address, uint32_t bytes);
/* Returns the TPs of a TM, but for one that stores to the word, whose bursts have loaded it from a WRITTEN block before
   the issue of the load. */
uint64_t trax_fast_find_readers(struct trax_tm *tm, uint32_t address, uint64_t but);
/* Rolls them back. To be called before the store; in an epoch for the TM that makes it. */
void trax_fast_roll_back_readers(struct trax_tm *tm, uint32_t address, uint64_t but);
/* Records the loads of all bursts from WRITTEN blocks in the TM's store buffer, at the beginning of an epoch. */
void trax_fast_record_readers(struct trax_tm *tm);
/* Rolls a TP back to what it has issued; its head executes at issue then. */
void trax_fast_roll_back_tp(struct trax_tm *tm, unsigned tp);
/* Rolls every TP back to what it has issued; all heads execute at issue then. */
void trax_fast_roll_back(void *chip);

#endif
