/* Refusals of banks and units, for an observer of stretches. Included by cycle.c. */
#ifndef TRAX_FAST_REFUSALS_H
#define TRAX_FAST_REFUSALS_H

#include "fast/time/head.h"

/* Adds 1 to the bytes of some TPs. Returns the TPs whose bytes are full. */
static ALWAYS_INLINE uint64_t count_bytes(uint8_t *bytes, const bool wide, uint64_t tps) {
  uint64_t full = 0;
#ifdef __AVX2__
  for (unsigned i = 0; i < 32u + 32 * wide; i += 32) {
    const __m256i spread =
        _mm256_shuffle_epi8(_mm256_set1_epi32((int)(uint32_t)(tps >> i)),
                            _mm256_set_epi64x(0x0303030303030303, 0x0202020202020202, 0x0101010101010101, 0));
    const __m256i bit = _mm256_set1_epi64x((long long)0x8040201008040201);
    const __m256i sum = _mm256_sub_epi8(_mm256_load_si256((const __m256i *)(bytes + i)),
                                        _mm256_cmpeq_epi8(_mm256_and_si256(spread, bit), bit));
    _mm256_store_si256((__m256i *)(bytes + i), sum);
    full |= (uint64_t)(uint32_t)_mm256_movemask_epi8(_mm256_cmpeq_epi8(sum, _mm256_set1_epi8(-1))) << i;
  }
#else
  (void)wide;
  for (uint64_t rest = tps; rest; rest &= rest - 1)
    full |= (uint64_t)(++bytes[trax_first(rest)] == 0xFF) << trax_first(rest);
#endif
  return full;
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
    full = count_bytes(observed->fetch, wide, refused->fetch);
  if (others)
    full |= count_bytes(observed->others, wide, others);
  if (__builtin_expect(full != 0, false))
    trax_fast_log_refusals(tm, full);
}

/* Records the refusals of heads that issue. */
static ALWAYS_INLINE void record_refusals(struct trax_tm *tm, uint64_t issued) {
  struct trax_fast_observed *const observed = tm->observed;
  const uint64_t single = issued & tm->executes_at_issue;
  if (single)
    trax_fast_log_refusals(tm, single);
  for (uint64_t rest = issued & ~single; rest; rest &= rest - 1) {
    const unsigned tp = trax_first(rest);
    observed->refused[tp][tm->heads.at[tp]] = (uint16_t)(observed->fetch[tp] | observed->others[tp] << 8);
    observed->fetch[tp] = observed->others[tp] = 0;
  }
  observed->tps &= ~issued;
}

#endif
