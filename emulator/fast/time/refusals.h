/* Refusals of banks and units, for an observer of stretches. Included by cycle.c. */
#ifndef TRAX_FAST_REFUSALS_H
#define TRAX_FAST_REFUSALS_H

#include "fast/time/head.h"

#ifdef __AVX2__
/* Returns a byte of ones for each TP of a mask, and of zeros for others. */
static ALWAYS_INLINE __m256i bytes_of(uint32_t tps) {
#ifdef __AVX512BW__
  return _mm256_movm_epi8(tps);
#else
  const __m256i spread = _mm256_shuffle_epi8(
      _mm256_set1_epi32((int)tps), _mm256_set_epi64x(0x0303030303030303, 0x0202020202020202, 0x0101010101010101, 0));
  const __m256i bit = _mm256_set1_epi64x((long long)0x8040201008040201);
  return _mm256_cmpeq_epi8(_mm256_and_si256(spread, bit), bit);
#endif
}
#endif

/* Adds 1 to the lower half of the bytes of some TPs, and to the upper half of those of others. Returns the TPs that
   have a full half. */
static ALWAYS_INLINE uint64_t count_halves(uint8_t *bytes, const bool wide, uint64_t lower, uint64_t upper) {
  uint64_t full = 0;
#ifdef __AVX2__
  const __m256i most = _mm256_set1_epi8(TRAX_MOST_REFUSED), one = _mm256_set1_epi8(1 << TRAX_REFUSED_SHIFT);
  for (unsigned i = 0; i < 32u + 32 * wide; i += 32) {
    __m256i *const some = (__m256i *)(bytes + i);
    const __m256i sum = _mm256_add_epi8(_mm256_sub_epi8(_mm256_load_si256(some), bytes_of((uint32_t)(lower >> i))),
                                        _mm256_and_si256(bytes_of((uint32_t)(upper >> i)), one));
    _mm256_store_si256(some, sum);
    const __m256i is_full = _mm256_or_si256(_mm256_cmpeq_epi8(_mm256_and_si256(sum, most), most),
                                            _mm256_cmpeq_epi8(_mm256_or_si256(sum, most), _mm256_set1_epi8(-1)));
    full |= (uint64_t)(uint32_t)_mm256_movemask_epi8(is_full) << i;
  }
#else
  (void)wide;
  for (uint64_t rest = lower | upper; rest; rest &= rest - 1) {
    uint8_t *const byte = &bytes[trax_first(rest)];
    *byte += rest & -rest & lower ? 1 : 1 << TRAX_REFUSED_SHIFT;
    const bool is_full =
        trax_refused_fetch(*byte) == TRAX_MOST_REFUSED || trax_refused_others(*byte) == TRAX_MOST_REFUSED;
    full |= (uint64_t)is_full << trax_first(rest);
  }
#endif
  return full;
}

/* Clears the bytes of some TPs; all at once, since the host forwards no stores of bytes to loads of vectors. */
static ALWAYS_INLINE void clear_bytes(uint8_t *bytes, const bool wide, uint64_t tps) {
#ifdef __AVX2__
  for (unsigned i = 0; i < 32u + 32 * wide; i += 32) {
    __m256i *const some = (__m256i *)(bytes + i);
    _mm256_store_si256(some, _mm256_andnot_si256(bytes_of((uint32_t)(tps >> i)), _mm256_load_si256(some)));
  }
#else
  (void)wide;
  for (uint64_t rest = tps; rest; rest &= rest - 1)
    bytes[trax_first(rest)] = 0;
#endif
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

/* Records the refusals of heads that issue. */
static ALWAYS_INLINE void record_refusals(struct trax_tm *tm, const bool wide, uint64_t issued) {
  struct trax_fast_observed *const observed = tm->observed;
  const uint64_t single = issued & tm->executes_at_issue, in_bursts = issued & ~single;
  if (single)
    trax_fast_log_refusals(tm, single);
  if (!in_bursts)
    return;
  for (uint64_t rest = in_bursts; rest; rest &= rest - 1)
    observed->refused[trax_first(rest)][tm->heads.at[trax_first(rest)]] = observed->of_head[trax_first(rest)];
  clear_bytes(observed->of_head, wide, in_bursts);
  observed->tps &= ~in_bursts;
}

#endif
