/* The merge of the TMs' store buffers in an epoch: the requests of a quantum come to the memory controller, in the
   order of cycles and TMs, while TMs simulate the next quantum. So nothing here touches what they use: increments, and
   in the same order stores to SHARED blocks, change the write set, which takes effect at the end of the epoch. Other
   stores are added when all quanta are over: if their order matters, the epoch is given up. */
#ifndef TRAX_FAST_MERGE_H
#define TRAX_FAST_MERGE_H

#include "machine/config.h"
#include "machine/overlay.h"

#include <stdbool.h>

struct trax_chip;
struct trax_tm;

/* Entries of a quantum, in the order of their cycles; those of one cycle in the order of TMs, and of making. */
struct trax_merge_order {
  uint64_t begin;               /* the quantum's first cycle */
  uint64_t *cycles;             /* [words]: masks of the quantum's cycles with entries that are not done */
  uint64_t *tms;                /* [64 * words], behind them: for each cycle a mask of the TMs with entries */
  size_t words, word, capacity; /* word: the first one that may have such a cycle */
};

struct trax_merge {
  struct trax_chip *chip;
  struct trax_store_buffer *buffers; /* [tms] */
  bool failed;                       /* the epoch must be given up */
  struct trax_merge_order order;
  char *printed; /* [printed_count]: characters printed since the snapshot */
  size_t printed_count, printed_capacity;
  uint32_t *increments; /* [increment_count]: words whose increments were issued in the epoch, in blocks not SHARED */
  size_t increment_count, increment_capacity;
  struct trax_overlay written;  /* the epoch's write set */
  struct trax_merge_undo *undo; /* [undo_count]: lines of memory as they were before each epoch since the snapshot */
  size_t undo_count, undo_capacity;
};

/* False: out of memory. It must be destroyed in either case. */
bool trax_merge_create(struct trax_merge *merge, struct trax_chip *chip);
void trax_merge_destroy(struct trax_merge *merge);

/* Begins an epoch. */
void trax_merge_begin(struct trax_merge *merge);
/* Whether the epoch must be given up, as far as is known. */
static inline bool trax_merge_has_failed(const struct trax_merge *merge) {
  return __atomic_load_n(&merge->failed, __ATOMIC_RELAXED);
}

/* To be called by the thread that simulates the TM: before its first quantum of an epoch; before each quantum; after
 * it. */
void trax_merge_begin_tm(struct trax_merge *merge, struct trax_tm *tm);
void trax_merge_give(struct trax_merge *merge, struct trax_tm *tm, unsigned side);
void trax_merge_take(struct trax_merge *merge, struct trax_tm *tm);

/* Serves the requests of a quantum, the cycles from t to `end`, and merges its stores. */
void trax_merge_quantum(struct trax_merge *merge, unsigned side, uint64_t t, uint64_t end);

/* After all quanta: completes the write set. */
void trax_merge_unite(struct trax_merge *merge);
/* Then: prepares the TM for the next epoch, and looks for conflicts of its reads, and of part `tm->number` of the write
   set with the read set of the run. Threads may do so for several TMs at the same time. */
void trax_merge_check(struct trax_merge *merge, struct trax_tm *tm);
/* Ends an epoch: its stores take effect. False: it must be given up. */
bool trax_merge_end(struct trax_merge *merge);

/* The chip does not go back any more beyond what has taken effect: prints, and tells of transfers. */
void trax_merge_keep(struct trax_merge *merge);
/* Restores global memory as it was at the snapshot, and forgets what has been printed and transferred since. */
void trax_merge_roll_back(struct trax_merge *merge);

#endif
