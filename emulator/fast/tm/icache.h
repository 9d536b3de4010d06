/* One instruction cache and the TPs that share it (docs/timing.md, "Fetch"). */
#ifndef TRAX_FAST_ICACHE_H
#define TRAX_FAST_ICACHE_H

#include "fast/tm/arbiter.h"
#include "fast/tm/cache_tags.h"
#include "machine/section.h"

struct trax_tm;

/* A line on its way. */
#define TRAX_ICACHE_PENDING_STATE(X, S)                                                                                \
  X(S, uint32_t, line, )                                                                                               \
  X(S, uint64_t, waiting, ) /* mask of TPs */
struct trax_icache_pending {
  TRAX_ICACHE_PENDING_STATE(TRAX_FIELD, )
};

#define TRAX_ICACHE_STATE(X, S) X(S, uint32_t, pending_count, ) /* lines on their way */
struct trax_icache {
  TRAX_ICACHE_STATE(TRAX_FIELD, )
  struct trax_cache_tags tags;
  struct trax_icache_pending *pending; /* [tps], the first pending_count in use */
  uint32_t evicted;                    /* the number of the line that the latest arrival replaced, + 1; 0: none */
};

bool trax_icache_create(struct trax_icache *icache, const struct trax_tm *tm);
void trax_icache_destroy(struct trax_icache *icache);

/* A TP that has won its bank misses the line of its pc: it sleeps until the line's arrival, or has been charged for the
   full memory queue. */
void trax_icache_miss(struct trax_icache *icache, struct trax_tm *tm, unsigned tp, uint64_t t);

/* Handles the arrival of a line in cycle t: all TPs that wait for it hold their instructions. */
void trax_icache_arrival(struct trax_icache *icache, struct trax_tm *tm, uint32_t line, uint64_t t);

#endif
