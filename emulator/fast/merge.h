/* The end of an epoch: what is in the TMs' store buffers takes effect, in the order of cycles and TMs, while the memory
   controller serves their requests cycle by cycle. */
#ifndef TRAX_FAST_MERGE_H
#define TRAX_FAST_MERGE_H

#include "machine/config.h"

#include <stdbool.h>
#include <stddef.h>

struct trax_chip;
struct trax_tm;

/* Entries of store buffers, in the order of their cycles; those of one cycle in the order of TMs, and of making. */
struct trax_merge_order {
  uint64_t begin;               /* the epoch's first cycle */
  uint64_t *cycles;             /* [words]: masks of the epoch's cycles with entries that are not done */
  uint64_t *tms;                /* [64 * words], behind them: for each cycle a mask of the TMs with entries */
  size_t words, word, capacity; /* word: the first one that may have such a cycle */
};

struct trax_merge {
  struct trax_chip *chip;
  struct trax_store_buffer *buffers; /* [tms] */
  bool early;                        /* the controller now serves requests for cycles of the epoch to come */
  bool failed;                       /* the epoch must be given up */
  struct trax_merge_order order;
  char *printed; /* [printed_count]: characters printed since the snapshot */
  size_t printed_count, printed_capacity;
  /* [undo_count]: words of global memory before they were written since the snapshot. Those from epoch_undo on are the
     write set of the epoch: `slots` are a hash table of them. */
  struct trax_merge_undo *undo;
  size_t undo_count, undo_capacity, epoch_undo;
  uint32_t *slots;
};

/* False: out of memory. It must be destroyed in either case. */
bool trax_merge_create(struct trax_merge *merge, struct trax_chip *chip);
void trax_merge_destroy(struct trax_merge *merge);

/* Starts the transfers of the cycles from t to `until` that do not depend on the requests of the epoch to come.
   Returns the first cycle whose transfers may depend on these requests. */
uint64_t trax_merge_begin(struct trax_merge *merge, uint64_t t, uint64_t until);
/* Gives a TM an empty store buffer; takes it from the TM after its cycles. To be called by the TM's thread. */
void trax_merge_give(struct trax_merge *merge, struct trax_tm *tm);
void trax_merge_take(struct trax_merge *merge, struct trax_tm *tm);
/* Ends the epoch of the cycles from t to `end`. False: it must be given up. */
bool trax_merge_end(struct trax_merge *merge, uint64_t t, uint64_t end);

/* The chip does not go back any more beyond what has taken effect: prints, and tells of transfers. */
void trax_merge_keep(struct trax_merge *merge);
/* Restores global memory as it was at the snapshot, and forgets what has been printed and transferred since. */
void trax_merge_roll_back(struct trax_merge *merge);

#endif
