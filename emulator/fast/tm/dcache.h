/* The TM's data cache: banks, lines, and the miss registers for lines on their way (docs/timing.md, "Data cache"). */
#ifndef TRAX_FAST_DCACHE_H
#define TRAX_FAST_DCACHE_H

#include "fast/tm/arbiter.h"
#include "fast/tm/cache_tags.h"
#include "machine/config.h"
#include "machine/section.h"

struct trax_tm;

/* A miss register. The registers that wait for its line form a list through trax_dcache.next_waiter. */
#define TRAX_MSHR_STATE(X, S)                                                                                          \
  X(S, uint32_t, line, )                                                                                               \
  X(S, uint16_t, first_waiter, )                                                                                       \
  X(S, uint16_t, passing, ) /* 1: the line does not enter the cache */
struct trax_mshr {
  TRAX_MSHR_STATE(TRAX_FIELD, )
};

#define TRAX_DCACHE_STATE(X, S)                                                                                        \
  X(S, uint64_t, fills_end, [TRAX_MAX_TPS_PER_TM]) /* by bank; only with dcache.fill_cycles */                         \
  X(S, uint64_t, all_fills_end, )                  /* the latest of these */                                           \
  X(S, uint32_t, mshr_count, )                     /* miss registers in use */
struct trax_dcache {
  TRAX_DCACHE_STATE(TRAX_FIELD, )
  struct trax_cache_tags tags;
  uint32_t banks, mshr_limit;
  struct trax_mshr *mshr; /* [mshr_limit], the first mshr_count in use */
  uint16_t *next_waiter;  /* [TP * 32 + register]: the next one in its list; a register waits for one line at a time */
};

bool trax_dcache_create(struct trax_dcache *dcache, const struct trax_tm *tm);
void trax_dcache_destroy(struct trax_dcache *dcache);

/* Serves a load in step 4 of cycle t: a hit, merged or a miss. False: it needs a queue place or a miss register and
   gets none. */
bool trax_dcache_load(struct trax_dcache *dcache, struct trax_tm *tm, unsigned tp, uint64_t t);

/* Drops all lines, for a fence, and returns their number. The lines on their way will pass. */
uint32_t trax_dcache_drop(struct trax_dcache *dcache);

/* Handles the arrival of a line in cycle t: the registers that wait for it are usable. */
void trax_dcache_arrival(struct trax_dcache *dcache, struct trax_tm *tm, uint32_t line, uint64_t t);

#endif
