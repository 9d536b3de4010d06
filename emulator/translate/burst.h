/* The record of a burst of the fast engine (docs/fast-engine.md), which is interpreted (fast/function/burst.c) or
   translated, and the facts of the engine that translated bursts depend on. */
#ifndef TRAX_TRANSLATE_BURST_H
#define TRAX_TRANSLATE_BURST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
  TRAX_BURST = 128,  /* limit of a burst's instructions: a TM's bursts should fit in the host's caches */
  TRAX_CHUNK = 32,   /* instructions of a chunk, which begins at a multiple of it */
  TRAX_PIECE = 16,   /* most instructions of a translated sequence */
  TRAX_REACH = 32000 /* most instructions between a burst's first one and the beginning of a chunk or sequence */
};

/* The state of a block of global memory in the run (fast/function/blocks.h). */
enum { TRAX_BLOCK_SHIFT = 4, TRAX_BLOCK = 1 << TRAX_BLOCK_SHIFT };
enum { TRAX_BLOCK_LOADED = 1, TRAX_BLOCK_WRITTEN, TRAX_BLOCK_SHARED, TRAX_BLOCK_HOLE };

enum { TRAX_STEP_BANK_SHIFT = 4 /* a data bank's place in a step */ };

/* A load of global memory, with the value from a written block; a store to it, with the value that takes effect at its
   issue, or if the thread is alone the word before it; or a word of local memory before a store: an undo. So no step
   takes more than one. */
struct trax_burst_access {
  uint32_t address, word;
};

/* The last step may be followed by others that are not part of the burst. */
struct trax_burst {
  _Alignas(64) uint64_t lines; /* bit line % 64: a superset of the lines of the steps */
  uint32_t jumps;              /* taken jumps, that of the last step included */
  uint32_t first;              /* the index of the first instruction */
  uint32_t load_count;         /* loads of global memory, and stores to it: from access[0] on */
  uint32_t undo_begin;         /* the latest undo; the others follow, up to access[TRAX_BURST] */
  uint16_t step[TRAX_BURST + TRAX_CHUNK];
  uint16_t index[TRAX_BURST + TRAX_CHUNK]; /* the low bits of the instructions' indices, which are near the first one */
  struct trax_burst_access access[TRAX_BURST + 1];
};

/* The facts that translated bursts depend on. */
struct trax_burst_facts {
  const uint16_t *step; /* [instruction]: its step, unless an address decides it */
  const uint16_t *line; /* [instruction]: the index of its line */
  uint8_t *blocks;      /* the states of blocks */
  uint32_t load_step;   /* is added to the step of a load of global memory, with the bits bank_mask of address * 4 */
  uint32_t bank_mask;
  uint32_t slow_local, slow_jump; /* are added to the steps of loads of local memory, and of taken jumps */
  bool end_at_calls;              /* bursts end before what trax_changes_stack */
};

#endif
