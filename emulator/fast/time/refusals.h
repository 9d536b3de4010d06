/* Refusals of banks and units, for an observer of stretches. Included by cycle.c. */
#ifndef TRAX_FAST_REFUSALS_H
#define TRAX_FAST_REFUSALS_H

#include "fast/time/head.h"

/* Clears the bytes of some TPs; all at once, since the host forwards no stores of bytes to loads of vectors. */
static ALWAYS_INLINE void clear_bytes(uint8_t *bytes, const bool wide, uint64_t tps) {
  for (unsigned i = 0; i < 32u + 32 * wide; i += TRAX_FAST_VECTOR)
    *(trax_fast_bytes *)(bytes + i) &= ~trax_fast_bytes_of(tps >> i);
}

/* Counts the refusals of a cycle. A TP has at most one. */
static ALWAYS_INLINE void count_refusals(struct trax_tm *tm, const bool wide, const struct trax_fast_refused *refused) {
  struct trax_fast_observed *const observed = tm->observed;
  uint64_t others = refused->bank, full = 0;
#pragma GCC unroll 8
  for (unsigned i = 0; i < TRAX_SHARED_COUNT; i++)
    others |= refused->unit[i];
  observed->tps |= refused->fetch | others;
  if (refused->fetch)
    full = trax_fast_count_bytes(observed->fetch, wide, refused->fetch, TRAX_MOST_REFUSED);
  if (others)
    full |= trax_fast_count_bytes(observed->others, wide, others, TRAX_MOST_REFUSED);
  if (__builtin_expect(full != 0, false))
    trax_fast_log_refusals(tm, full);
}

/* Records the refusals of heads that issue. */
static ALWAYS_INLINE void record_refusals(struct trax_tm *tm, const bool wide, uint64_t issued) {
  struct trax_fast_observed *const observed = tm->observed;
  const uint64_t single = issued & tm->executes_at_issue, in_bursts = issued & ~single;
  if (single)
    trax_fast_log_refusals(tm, single);
  if (!in_bursts)
    return;
  for (uint64_t rest = in_bursts; rest; rest &= rest - 1) {
    const unsigned tp = trax_first(rest);
    observed->refused[tp][tm->heads.at[tp]] =
        (uint8_t)(observed->fetch[tp] | observed->others[tp] << TRAX_REFUSED_SHIFT);
  }
  clear_bytes(observed->fetch, wide, in_bursts);
  clear_bytes(observed->others, wide, in_bursts);
  observed->tps &= ~in_bursts;
}

#endif
