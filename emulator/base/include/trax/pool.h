/* A pool of host threads that process the same items again and again, in rounds. */
#ifndef TRAX_POOL_H
#define TRAX_POOL_H

#include "trax/status.h"

#include <stdint.h>

struct trax_pool;

/* To be called by a thread that polls. */
static inline void trax_pause(void) {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

/* Creates a pool of `threads` threads, the caller included. Each round calls work(context, i) once for every i below
   `items`. An item is processed by the thread that did so in the round before, unless that is late: the thread's caches
   have its data. NULL: an error. */
struct trax_pool *trax_pool_create(unsigned threads, uint32_t items, void (*work)(void *context, uint32_t item),
                                   void *context, trax_error *error);
void trax_pool_destroy(struct trax_pool *pool);

/* Runs a round and returns when all items are done. */
void trax_pool_run(struct trax_pool *pool);
/* Runs rounds with a function of their own, which receives the number of the round. When all items are done in a round,
   one thread finishes it; meanwhile others process the items for the next round, but no item for the one after it. So
   threads seldom wait for each other, although their items take different times. */
void trax_pool_run_rounds(struct trax_pool *pool, unsigned rounds,
                          void (*work)(void *context, uint32_t item, unsigned round),
                          void (*finish)(void *context, unsigned round));

#endif
