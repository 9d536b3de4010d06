/* Refusals of banks and units, for an observer of stretches. Included by cycle.c. */
#ifndef TRAX_FAST_REFUSALS_H
#define TRAX_FAST_REFUSALS_H

#include "fast/time/head.h"

/* Adds 1 to the lower half of the bytes of some TPs, and to the upper half of those of others. Returns the TPs that
   have a full half. */
static ALWAYS_INLINE uint64_t count_halves(uint8_t *bytes, const bool wide, uint64_t lower, uint64_t upper) {
  const uint8_t one = 1 << TRAX_REFUSED_SHIFT, most = TRAX_MOST_REFUSED;
  uint64_t full = 0;
  for (unsigned i = 0; i < 32u + 32 * wide; i += TRAX_FAST_VECTOR) {
    trax_fast_bytes *const some = (trax_fast_bytes *)(bytes + i);
    *some += (trax_fast_bytes_of(upper >> i) & one) - trax_fast_bytes_of(lower >> i);
    full |= trax_fast_top_bits((trax_fast_bytes)(((*some & most) == most) | ((*some | most) == UINT8_MAX))) << i;
  }
  return full;
}

/* Clears the bytes of some TPs; all at once, since the host forwards no stores of bytes to loads of vectors. */
static ALWAYS_INLINE void clear_bytes(uint8_t *bytes, const bool wide, uint64_t tps) {
  for (unsigned i = 0; i < 32u + 32 * wide; i += TRAX_FAST_VECTOR)
    *(trax_fast_bytes *)(bytes + i) &= ~trax_fast_bytes_of(tps >> i);
}

/* Counts the refusals of a cycle. A TP has at most one. */
static ALWAYS_INLINE void count_refusals(struct trax_tm *tm, const bool wide, const struct trax_fast_refused *refused) {
  struct trax_fast_observed *const observed = tm->observed;
  uint64_t others = refused->bank;
#pragma GCC unroll 8
  for (unsigned i = 0; i < TRAX_SHARED_COUNT; i++)
    others |= refused->unit[i];
  observed->tps |= refused->fetch | others;
  const uint64_t full = count_halves(observed->of_head, wide, refused->fetch, others);
  if (__builtin_expect(full != 0, false))
    trax_fast_log_refusals(tm, full);
}

/* Records those of the first TP, and returns the rest of the TPs; of `last`, the last TP, if there is none. */
static ALWAYS_INLINE uint64_t record_next(struct trax_tm *tm, uint64_t rest, uint64_t last) {
  const unsigned number = trax_first(rest | last);
  tm->observed->refused[number][tm->heads.at[number]] = tm->observed->of_head[number];
  return rest & (rest - 1);
}

static ALWAYS_INLINE uint64_t record_four(struct trax_tm *tm, uint64_t rest, uint64_t last) {
  rest = record_next(tm, record_next(tm, rest, last), last);
  return record_next(tm, record_next(tm, rest, last), last);
}

/* Records the refusals of heads that issue. */
static ALWAYS_INLINE void record_refusals(struct trax_tm *tm, const bool wide, uint64_t issued) {
  struct trax_fast_observed *const observed = tm->observed;
  const uint64_t single = issued & tm->executes_at_issue, in_bursts = issued & ~single;
  if (single)
    trax_fast_log_refusals(tm, single);
  if (!in_bursts)
    return;
  /* By eight without a branch, which the host would mispredict. */
  const uint64_t last = (uint64_t)1 << (63 - __builtin_clzll(in_bursts));
  for (uint64_t rest = in_bursts; rest;)
    rest = record_four(tm, record_four(tm, rest, last), last);
  clear_bytes(observed->of_head, wide, in_bursts);
  observed->tps &= ~in_bursts;
}

#endif
