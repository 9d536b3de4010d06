/* Arithmetic on masks of a TM's TPs, and on a byte for each of them: arbiters and counters. */
#ifndef TRAX_FAST_MASKS_H
#define TRAX_FAST_MASKS_H

#include "machine/section.h"
#include "machine/units.h"

#include <immintrin.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#define ALWAYS_INLINE inline __attribute__((always_inline))

/* Round-robin arbiters, one in each lane. A round-robin mask has the bits after the latest winner, which is equivalent
   to a pointer to the first of them. The first requester in the mask wins, or else the first requester of all. Winners
   are 0 if there are no requesters. */
#define TRAX_FAST_ARBITRATE(LANES, RR_MASK, REQUESTERS, WINNERS)                                                       \
  do {                                                                                                                 \
    const LANES preferred_ = (REQUESTERS) & *(RR_MASK);                                                                \
    const LANES among_ = preferred_ | ((REQUESTERS) & (LANES)(preferred_ == 0));                                       \
    *(WINNERS) = among_ & -among_;                                                                                     \
    *(RR_MASK) = -(*(WINNERS) + *(WINNERS)) | (*(RR_MASK) & (LANES)(*(WINNERS) == 0));                                 \
  } while (0)

#ifdef __AVX2__
enum { TRAX_FAST_VECTOR = 32 }; /* bytes of the host's vectors */
#else
enum { TRAX_FAST_VECTOR = 16 };
#endif
typedef uint8_t trax_fast_bytes __attribute__((vector_size(TRAX_FAST_VECTOR), may_alias));
typedef uint16_t trax_fast_lanes16 __attribute__((vector_size(TRAX_FAST_VECTOR), may_alias));
typedef uint64_t trax_fast_words __attribute__((vector_size(TRAX_FAST_VECTOR), may_alias));

/* Returns the top bits of the bytes. */
static inline uint64_t trax_fast_top_bits(trax_fast_bytes bytes) {
#ifdef __AVX2__
  return (uint32_t)_mm256_movemask_epi8((__m256i)bytes);
#else
  return (uint32_t)_mm_movemask_epi8((__m128i)bytes);
#endif
}

/* Returns a byte of ones for each of the first TPs that is in a mask, and of zeros for the others. */
static inline trax_fast_bytes trax_fast_bytes_of(uint64_t tps) {
  const uint64_t ones = 0x0101010101010101;
  const trax_fast_words none = {0}, bit = none + 0x8040201008040201;
#ifdef __AVX2__
  const trax_fast_words spread = (trax_fast_words)_mm256_shuffle_epi8(
      _mm256_set1_epi32((int)tps), _mm256_set_epi64x(3 * (int64_t)ones, 2 * (int64_t)ones, (int64_t)ones, 0));
#else
  const trax_fast_words spread = {(tps & 0xFF) * ones, (tps >> 8 & 0xFF) * ones};
#endif
  return (trax_fast_bytes)((trax_fast_bytes)(spread & bit) == (trax_fast_bytes)bit);
}

/* Adds 1 to the bytes of some TPs. `wide`: the TM has more than 32 TPs. */
static ALWAYS_INLINE void trax_fast_count_bytes(uint8_t *bytes, const bool wide, uint64_t tps) {
  for (unsigned i = 0; i < 32u + 32 * wide; i += TRAX_FAST_VECTOR)
    *(trax_fast_bytes *)(bytes + i) -= trax_fast_bytes_of(tps >> i);
}

/* Defines a function that grants the banks of caches and returns the losers. LANE: the TPs of a bank's caches, 16 to a
   cache of instructions; ARBITER: those of one of them. rr_masks: [bank][cache]. plane: the bits of the numbers of the
   TPs' banks. A vector has the banks whose numbers differ in their low bits. */
#define TRAX_FAST_REFUSE(NAME, LANE, ARBITER, MOST_BANKS)                                                              \
  static ALWAYS_INLINE LANE NAME(void *rr_masks, uint64_t requesters, const uint64_t *plane) {                         \
    enum { BANKS = TRAX_FAST_VECTOR / sizeof(LANE), BITS = __builtin_ctz(MOST_BANKS) /* of a number */ };              \
    typedef LANE lanes __attribute__((vector_size(TRAX_FAST_VECTOR), may_alias));                                      \
    typedef ARBITER arbiters __attribute__((vector_size(TRAX_FAST_VECTOR), may_alias));                                \
    const lanes none = {0};                                                                                            \
    lanes number = none, low = none + (LANE)requesters, refused = none; /* low: by the bits within a vector */         \
    for (unsigned i = 0; i < BANKS; i++)                                                                               \
      number[i] = (LANE)i;                                                                                             \
    for (unsigned k = 0; 1u << k < BANKS; k++)                                                                         \
      low &= (none + (LANE)plane[k]) ^ (lanes)((number & (LANE)1 << k) == 0);                                          \
    _Pragma("GCC unroll 8") for (unsigned first = 0; first < MOST_BANKS; first += BANKS) {                             \
      LANE high = ~(LANE)0;                                                                                            \
      _Pragma("GCC unroll 4") for (unsigned k = 0; k < BITS; k++) {                                                    \
        high &= 1u << k < BANKS ? ~(LANE)0 : (LANE)(first >> k & 1 ? plane[k] : ~plane[k]);                            \
      }                                                                                                                \
      const lanes requesting = low & (none + high);                                                                    \
      arbiters winners;                                                                                                \
      TRAX_FAST_ARBITRATE(arbiters, (arbiters *)rr_masks + first / BANKS, (arbiters)requesting, &winners);             \
      refused |= requesting ^ (lanes)winners;                                                                          \
    }                                                                                                                  \
    LANE losers = 0;                                                                                                   \
    for (unsigned i = 0; i < BANKS; i++)                                                                               \
      losers |= refused[i];                                                                                            \
    return losers;                                                                                                     \
  }
TRAX_FAST_REFUSE(trax_fast_refuse_two, uint32_t, uint16_t, 16)
TRAX_FAST_REFUSE(trax_fast_refuse_four, uint64_t, uint16_t, 16)
TRAX_FAST_REFUSE(trax_fast_refuse_data4, uint64_t, uint64_t, 4)
TRAX_FAST_REFUSE(trax_fast_refuse_data8, uint64_t, uint64_t, 8)
enum { TRAX_FAST_BANKS = 8 }; /* of a data cache */

/* The TPs that were refused a bank or unit in a cycle, by its kind. */
struct trax_fast_refused {
  uint64_t fetch, unit[TRAX_SHARED_COUNT], bank;
};
enum { TRAX_FAST_REFUSALS = sizeof(struct trax_fast_refused) / sizeof(uint64_t) };

/* Counters of refusals for each kind and TP, in bytes, so that a cycle is counted for all TPs at once. */
struct trax_fast_refusal_counts {
  _Alignas(64) uint8_t count[TRAX_FAST_REFUSALS][64]; /* in the order of trax_fast_refused */
  uint32_t cycles;                                    /* with refusals, since all were 0 */
};

/* Counts a cycle. Returns whether counters may be full. */
static ALWAYS_INLINE bool trax_fast_count(struct trax_fast_refusal_counts *counts, const bool wide,
                                          const struct trax_fast_refused *refused) {
  const uint64_t *const tps = (const uint64_t *)refused;
#pragma GCC unroll 8
  for (unsigned i = 0; i < TRAX_FAST_REFUSALS; i++)
    if (tps[i])
      trax_fast_count_bytes(counts->count[i], wide, tps[i]);
  return ++counts->cycles == UINT8_MAX;
}

/* The adders and multipliers. `even`: both kinds have the same groups, one unit for each, and the groups' size divides
   64. Then all groups are arbitrated at once; otherwise their units are like those of other kinds (tm/tm.h). */
typedef uint64_t trax_fast_pair __attribute__((vector_size(16)));

#define TRAX_FAST_UNITS_STATE(X, S) X(S, trax_fast_pair, rr_masks, ) /* of all groups; only if `even` */
struct trax_fast_units {
  uint32_t group_size;
  bool even;
  uint64_t top; /* if `even`: the last bit of each group */
  TRAX_FAST_UNITS_STATE(TRAX_FIELD, )
};

/* Returns the last bits of the groups in which x has a bit. */
static inline trax_fast_pair trax_fast_groups_of(const struct trax_fast_units *units, trax_fast_pair x) {
  return (((x & ~units->top) + ~units->top) | x) & units->top;
}

/* Returns the winner of each group, by TRAX_FAST_ARBITRATE for all groups at once. Requires `even`. */
static ALWAYS_INLINE trax_fast_pair trax_fast_grant_units(struct trax_fast_units *units, trax_fast_pair requesters) {
  if (units->group_size == 8) {
    typedef uint8_t groups __attribute__((vector_size(16), may_alias));
    groups winners;
    TRAX_FAST_ARBITRATE(groups, (groups *)&units->rr_masks, (groups)requesters, &winners);
    return (trax_fast_pair)winners;
  }
  const int to_first = (int)units->group_size - 1;
  const trax_fast_pair preferred = requesters & units->rr_masks;
  const trax_fast_pair have = trax_fast_groups_of(units, preferred);
  const trax_fast_pair among = preferred | (requesters & ~((have - (have >> to_first)) | have));
  const trax_fast_pair asked = trax_fast_groups_of(units, requesters), first = asked >> to_first;
  /* In groups with a requester, the subtraction of `first` does not borrow from the next group. */
  const trax_fast_pair winners = among & ~(among - first);
  const trax_fast_pair requested_groups = (asked - first) | asked;
  units->rr_masks = (units->rr_masks & ~requested_groups) | (requested_groups & ~(winners | (winners - first)));
  return winners;
}

#endif
