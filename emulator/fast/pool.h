/* Threads of the host that do the same work together, again and again, in turn with the thread that owns them. */
#ifndef TRAX_FAST_POOL_H
#define TRAX_FAST_POOL_H

#include "trax/emulator.h"

#include <stdint.h>

struct trax_pool;

/* `threads` of them, the caller included; each round calls work(context, i) once for every i below `items`.
   Neighbouring items go to the same thread, as far as none is idle, so that its caches keep what belongs to them. NULL:
   error. */
struct trax_pool *trax_pool_create(unsigned threads, uint32_t items, void (*work)(void *context, uint32_t item),
                                   void *context, trax_error *error);
void trax_pool_destroy(struct trax_pool *pool);

/* One round; returns when all of it is done. */
void trax_pool_run(struct trax_pool *pool);

#endif
