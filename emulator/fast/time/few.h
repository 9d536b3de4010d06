/* Banks that are granted one TP after the other, in cycles in which few TPs are awake: operations on all TPs of a TM
   would cost more. Included by grant.h. */
#ifndef TRAX_FAST_FEW_H
#define TRAX_FAST_FEW_H

#include "fast/time/head.h"

enum { MOST_FEW = 4 /* TPs */ };

static inline bool are_few(uint64_t tps) {
  return __builtin_popcountll(tps) <= MOST_FEW;
}

static inline unsigned step_of(const struct trax_tm *tm, unsigned tp) {
  return tm->heads.low[tp] | (unsigned)tm->heads.high[tp] << 8;
}

/* Returns the data bank of the head's step, or what stands in its place. */
static inline unsigned bank_of(const struct trax_tm *tm, unsigned tp) {
  return step_of(tm, tp) >> TRAX_STEP_BANK_SHIFT & 63;
}

/* Returns those of the TPs, which are some, whose steps are equal to the first one's in the bits of `mask`. */
static inline uint64_t like_first(const struct trax_tm *tm, uint64_t tps, unsigned mask) {
  const unsigned first = step_of(tm, trax_first(tps));
  uint64_t like = tps & -tps;
  for (uint64_t rest = tps & (tps - 1); rest; rest &= rest - 1)
    like |= (step_of(tm, trax_first(rest)) ^ first) & mask ? 0 : rest & -rest;
  return like;
}

/* Returns the winner of a bank with a round-robin mask. */
static inline uint64_t win(uint64_t requesters, uint64_t rr_mask) {
  const uint64_t among = requesters & rr_mask ? requesters & rr_mask : requesters;
  return among & -among;
}

/* Grants banks of the instruction caches, if they are arbitrated together; returns the losers. */
static ALWAYS_INLINE uint64_t refuse_few_fetches(struct trax_tm *tm, uint64_t requesters) {
  uint64_t losers = 0;
  for (uint64_t rest = requesters, here; rest; rest &= ~here) {
    const unsigned first = trax_first(rest), cache = first & 48; /* its first TP */
    uint16_t *const rr_mask = trax_fast_fetch_rr_mask(&tm->fetch_rr_masks16, tm->wide, cache / 16,
                                                      step_of(tm, first) >> TRAX_STEP_FETCH_SHIFT);
    here = like_first(tm, rest & (uint64_t)0xFFFF << cache, TRAX_STEP_FETCH);
    const uint64_t winner = win(here, (uint64_t)*rr_mask << cache);
    *rr_mask = (uint16_t)(-2 * winner >> cache);
    losers |= here ^ winner;
  }
  return losers;
}

/* Grants banks of the data cache and returns the winners. */
static ALWAYS_INLINE uint64_t grant_few_banks(struct trax_tm *tm, uint64_t requesters) {
  uint64_t *const rr_masks = (uint64_t *)tm->data_bank_rr_masks, winners = 0;
  for (uint64_t rest = requesters, here; rest; rest &= ~here) {
    uint64_t *const rr_mask = &rr_masks[bank_of(tm, trax_first(rest))];
    here = like_first(tm, rest, 63 << TRAX_STEP_BANK_SHIFT);
    const uint64_t winner = win(here, *rr_mask);
    *rr_mask = -2 * winner;
    winners |= winner;
  }
  return winners;
}

#endif
