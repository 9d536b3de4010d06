/* The second-level cache that the TMs share (docs/timing-memory.md, "Second-level cache"). */
#ifndef TRAX_FAST_L2_H
#define TRAX_FAST_L2_H

#include "fast/memory/memory.h"
#include "fast/tm/cache_tags.h"

/* A miss register, which holds a line on its way. */
#define TRAX_L2_MSHR_STATE(X, S)                                                                                       \
  X(S, struct trax_request, request, )      /* for the line; of 0 bytes if the register is free */                     \
  X(S, uint64_t, arrival, )                 /* TRAX_NEVER until its transfer begins */                                 \
  X(S, struct trax_request_list, waiters, ) /* requests of TMs that wait for the line, until its arrival is known */
struct trax_l2_mshr {
  TRAX_L2_MSHR_STATE(TRAX_FIELD, )
};

#define TRAX_L2_STATE(X, S)                                                                                            \
  X(S, struct trax_request_list, arriving, [TRAX_MAX_CHANNELS]) /* lines whose arrival is known, in its order */
struct trax_l2 {
  TRAX_L2_STATE(TRAX_FIELD, )
  uint32_t waiting;      /* number of requests that wait for banks */
  uint64_t next_arrival; /* of a line; TRAX_NEVER if none is known */
  struct trax_cache_tags tags;
  uint32_t banks, latency;
  uint32_t line_cost; /* bytes of a line's transfer */
  uint32_t mshr_limit;
  struct trax_waiting *bank; /* [banks] */
  struct trax_l2_mshr *mshr; /* [mshr_limit] */
};

trax_status trax_l2_create(struct trax_l2 **l2, const struct trax_config *config, trax_error *error);
void trax_l2_destroy(struct trax_l2 *l2); /* l2 may be NULL */

/* Makes what follows from the lists. */
void trax_l2_import(struct trax_memory *memory, struct trax_tm *tms);
/* The cache's part of step 3 of cycle t. */
void trax_l2_cycle(struct trax_memory *memory, struct trax_tm *tms, uint64_t t);
/* Sets the arrival of a line whose transfer has begun. */
void trax_l2_set_arrival(struct trax_memory *memory, struct trax_tm *tms, unsigned channel, trax_request_id id,
                         uint64_t arrival);

static inline struct trax_waiting *trax_l2_bank(const struct trax_l2 *l2, uint32_t address) {
  return &l2->bank[trax_line_of(&l2->tags, address) % l2->banks];
}

#endif
