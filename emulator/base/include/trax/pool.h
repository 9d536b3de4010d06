/* A pool of host threads, which process the items of a few jobs again and again, in rounds. Those who work in turns
   share a pool: the threads of another one would spin meanwhile. */
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

/* Creates a pool of `threads` threads, the caller included. NULL: an error. */
struct trax_pool *trax_pool_create(unsigned threads, trax_error *error);
void trax_pool_destroy(struct trax_pool *pool); /* which may be NULL */
unsigned trax_pool_threads(const struct trax_pool *pool);

/* Adds a job, between rounds: each of its rounds calls work(context, i) once for every i below `items`. An item is
   processed by the thread that did so in the job's round before, unless that is late: the thread's caches have its
   data. */
trax_status trax_pool_add(struct trax_pool *pool, uint32_t items, void (*work)(void *context, uint32_t item),
                          void *context, unsigned *job, trax_error *error);
/* Runs a round of a job and returns when all items are done. */
void trax_pool_run(struct trax_pool *pool, unsigned job);
/* Runs rounds of a job with functions of their own, which receive the number of the round. When all items are done in a
   round, one thread finishes it. Meanwhile others process the items for the next round, but no item for the one after
   it. So threads seldom wait for each other, although their items take different times. */
void trax_pool_run_rounds(struct trax_pool *pool, unsigned job, unsigned rounds,
                          void (*work)(void *context, uint32_t item, unsigned round),
                          void (*finish)(void *context, unsigned round));

#endif
