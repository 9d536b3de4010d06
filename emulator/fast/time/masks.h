/* Arithmetic on masks of a TM's TPs: arbiters and bit-sliced counters. */
#ifndef TRAX_FAST_MASKS_H
#define TRAX_FAST_MASKS_H

#include "machine/units.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#ifdef __AVX2__
#include <immintrin.h>
#endif

/* Four masks, which are processed together. */
enum { TRAX_FAST_LANES = 4, TRAX_FAST_BANK_BITS = 6 /* of at most 64 banks */ };
typedef uint64_t trax_fast_lanes __attribute__((vector_size(8 * TRAX_FAST_LANES), may_alias));

/* Vectors are passed by address, since the ABI of passing them by value differs between the variants. */
static inline uint64_t trax_fast_any(const trax_fast_lanes *lanes) {
  return (*lanes)[0] | (*lanes)[1] | (*lanes)[2] | (*lanes)[3];
}

/* Round-robin arbiters, one in each lane. A round-robin mask has the bits after the latest winner, which is equivalent
   to a pointer to the first of them. The first requester in the mask wins, or else the first requester of all. Winners
   are 0 if there are no requesters. */
#define TRAX_FAST_ARBITRATE(LANES, RR_MASK, REQUESTERS, WINNERS)                                                       \
  do {                                                                                                                 \
    const LANES preferred_ = (REQUESTERS) & *(RR_MASK);                                                                \
    const LANES among_ = preferred_ | ((REQUESTERS) & (LANES)(preferred_ == 0));                                       \
    *(WINNERS) = among_ & -among_;                                                                                     \
    *(RR_MASK) = ~(*(WINNERS) | (*(WINNERS)-1)) | (*(RR_MASK) & (LANES)(*(WINNERS) == 0));                             \
  } while (0)

/* The arbiters of the 16 banks of the instruction caches, with 16 TPs to a cache. A pair of caches takes 32 bits for
   each bank. */
#if defined(__AVX512BW__)
enum { TRAX_FAST_PAIRS = 16 }; /* elements of 32 bits in a vector */
#elif defined(__AVX2__)
enum { TRAX_FAST_PAIRS = 8 };
#else
enum { TRAX_FAST_PAIRS = 4 };
#endif
typedef uint16_t trax_fast_lanes16 __attribute__((vector_size(4 * TRAX_FAST_PAIRS), may_alias));
typedef uint32_t trax_fast_pairs __attribute__((vector_size(4 * TRAX_FAST_PAIRS), may_alias));

struct trax_fast_banks16 {
  /* Round-robin masks: [pair][bank][cache of the pair], or [bank][cache] where trax_fast_refuse_four is used. */
  union {
    _Alignas(64) uint16_t of_pair[2][16][2];
    uint16_t of_four[16][4];
  };
};

static inline uint32_t trax_fast_any_pair(const trax_fast_pairs *pairs) {
#ifdef __AVX2__
#ifdef __AVX512BW__
  const __m256i both =
      _mm256_or_si256(_mm512_castsi512_si256((__m512i)*pairs), _mm512_extracti64x4_epi64((__m512i)*pairs, 1));
#else
  const __m256i both = (__m256i)*pairs;
#endif
  __m128i any = _mm_or_si128(_mm256_castsi256_si128(both), _mm256_extracti128_si256(both, 1));
  any = _mm_or_si128(any, _mm_shuffle_epi32(any, 0x4E));
  const uint64_t two = (uint64_t)_mm_cvtsi128_si64(any);
  return (uint32_t)(two | two >> 32);
#else
  return (*pairs)[0] | (*pairs)[1] | (*pairs)[2] | (*pairs)[3];
#endif
}

/* Grants the banks of a pair of caches. plane: the bits of the numbers of the TPs' banks. Returns the losers. */
static inline uint32_t trax_fast_refuse_pair(struct trax_fast_banks16 *banks, unsigned pair, uint64_t requesters,
                                             const uint64_t *plane) {
  static const _Alignas(64) uint32_t match[4][16] = {
#define BANKS(K) /* all ones for the banks whose bit K is 0 */                                                         \
  {BANK(0, K), BANK(1, K), BANK(2, K),  BANK(3, K),  BANK(4, K),  BANK(5, K),  BANK(6, K),  BANK(7, K),                \
   BANK(8, K), BANK(9, K), BANK(10, K), BANK(11, K), BANK(12, K), BANK(13, K), BANK(14, K), BANK(15, K)}
#define BANK(B, K) ((B) >> (K)&1 ? 0 : 0xFFFFFFFF)
      BANKS(0), BANKS(1), BANKS(2), BANKS(3)};
#undef BANK
#undef BANKS
  const trax_fast_pairs none = {0};
  trax_fast_pairs refused = none;
#pragma GCC unroll 4
  for (unsigned i = 0; i < 16; i += TRAX_FAST_PAIRS) {
    trax_fast_pairs requesting = none + (uint32_t)(requesters >> 32 * pair);
#pragma GCC unroll 4
    for (unsigned k = 0; k < 4; k++)
      requesting &= (none + (uint32_t)(plane[k] >> 32 * pair)) ^ *(const trax_fast_pairs *)&match[k][i];
    trax_fast_lanes16 *const rr_mask = (trax_fast_lanes16 *)banks->of_pair[pair][i];
    trax_fast_lanes16 winners;
    TRAX_FAST_ARBITRATE(trax_fast_lanes16, rr_mask, (trax_fast_lanes16)requesting, &winners);
    refused |= requesting ^ (trax_fast_pairs)winners;
  }
  return trax_fast_any_pair(&refused);
}

#ifdef __AVX512BW__
/* The same for four caches, whose round-robin masks are in banks->of_four. */
static inline uint64_t trax_fast_refuse_four(struct trax_fast_banks16 *banks, uint64_t requesters,
                                             const uint64_t *plane) {
  typedef uint16_t masks __attribute__((vector_size(64), may_alias));
  __m512i requesting = _mm512_set1_epi64((long long)requesters);
#pragma GCC unroll 3
  for (unsigned k = 0; k < 3; k++) { /* lane i: banks i and i + 8 */
    static const _Alignas(64) uint64_t zero[3][8] = {{~0ull, 0, ~0ull, 0, ~0ull, 0, ~0ull, 0},
                                                     {~0ull, ~0ull, 0, 0, ~0ull, ~0ull, 0, 0},
                                                     {~0ull, ~0ull, ~0ull, ~0ull}};
    requesting = _mm512_ternarylogic_epi64(requesting, _mm512_set1_epi64((long long)plane[k]),
                                           _mm512_load_si512(zero[k]), 0x60); /* requesting & (plane ^ zero) */
  }
  const __m512i upper = _mm512_set1_epi64((long long)plane[3]);
  const __m512i half[2] = {_mm512_andnot_si512(upper, requesting), _mm512_and_si512(upper, requesting)};
  __m512i refused = _mm512_setzero_si512();
#pragma GCC unroll 2
  for (unsigned i = 0; i < 2; i++) {
    masks winners;
    TRAX_FAST_ARBITRATE(masks, (masks *)banks->of_four[8 * i], (masks)half[i], &winners);
    refused = _mm512_ternarylogic_epi64(refused, half[i], (__m512i)winners, 0xF6); /* refused | (half ^ winners) */
  }
  const __m256i four = _mm256_or_si256(_mm512_castsi512_si256(refused), _mm512_extracti64x4_epi64(refused, 1));
  const __m128i two = _mm_or_si128(_mm256_castsi256_si128(four), _mm256_extracti128_si256(four, 1));
  return (uint64_t)_mm_cvtsi128_si64(_mm_or_si128(two, _mm_unpackhi_epi64(two, two)));
}
#endif

/* Returns the round-robin mask of a cache's bank. `four`: trax_fast_refuse_four is used. */
static inline uint16_t *trax_fast_fetch_rr_mask(struct trax_fast_banks16 *banks, bool four, unsigned icache,
                                                unsigned bank) {
  return four ? &banks->of_four[bank][icache] : &banks->of_pair[icache / 2][bank][icache % 2];
}

/* The TPs that were refused a bank or unit in a cycle, by its kind: X(member, cause). */
#define TRAX_FAST_REFUSED(X) X(fetch, ICACHE_BANK) TRAX_SHARED_UNITS(TRAX_FAST_REFUSED_UNIT, X) X(bank, DCACHE_BANK)
#define TRAX_FAST_REFUSED_UNIT(X, ID, ...) X(unit[TRAX_SHARED_##ID], ID)
enum { TRAX_FAST_REFUSALS = TRAX_SHARED_COUNT + 2 };

struct trax_fast_refused {
  uint64_t fetch, unit[TRAX_SHARED_COUNT], bank;
};

/* Bit-sliced counters of refusals for each TP and kind: planes[k] has bit k of the counters of all TPs, so that a cycle
   is counted for all TPs at once. A log of several cycles is added together, since the carries cost most. */
enum { TRAX_FAST_LOG_BITS = 5, TRAX_FAST_LOG = (1 << TRAX_FAST_LOG_BITS) - 1 /* cycles */ };
#define TRAX_FAST_COUNTERS (TRAX_FAST_REFUSALS <= 8 ? 8 : TRAX_FAST_REFUSALS <= 16 ? 16 : 32) /* a power of two */

struct trax_fast_refusal_counts {
  _Alignas(64) uint64_t planes[64][TRAX_FAST_COUNTERS]; /* in the order of TRAX_FAST_REFUSED */
  uint64_t log[TRAX_FAST_LOG][TRAX_FAST_COUNTERS];
  uint32_t logged;
};

/* Appends a cycle to the log. Returns whether the log is full. */
static inline bool trax_fast_count(struct trax_fast_refusal_counts *counts, const struct trax_fast_refused *refused) {
  uint64_t *log = counts->log[counts->logged];
#define LOG(MEMBER, CAUSE) *log++ = refused->MEMBER;
  TRAX_FAST_REFUSED(LOG)
#undef LOG
  return ++counts->logged == TRAX_FAST_LOG;
}

/* Shared units of two kinds. `even`: both kinds have the same groups, one unit for each, and the groups' size
   divides 64. Then all groups are arbitrated at once. */
typedef uint64_t trax_fast_pair __attribute__((vector_size(16)));

struct trax_fast_units {
  uint32_t group_size;
  bool even;
  uint64_t top, below_top; /* if `even`: the last bit of each group, and the other bits */
  trax_fast_pair rr_masks; /* the round-robin masks of all groups */
  struct {
    uint32_t groups, per_group;
    uint64_t group[64];
  } uneven[2];
};

static inline uint64_t trax_fast_grant_unevenly(struct trax_fast_units *units, unsigned kind, uint64_t requesters) {
  uint64_t winners = 0, rr_mask = units->rr_masks[kind];
  for (uint32_t i = 0; i < units->uneven[kind].groups; i++) {
    const uint64_t group = units->uneven[kind].group[i];
    uint64_t all = requesters & group;
    for (uint32_t unit = units->uneven[kind].per_group; unit && all; unit--) {
      const uint64_t preferred = all & rr_mask, among = preferred ? preferred : all, winner = among & -among;
      winners |= winner;
      all ^= winner;
      rr_mask = (rr_mask & ~group) | (group & ~(winner | (winner - 1)));
    }
  }
  units->rr_masks[kind] = rr_mask;
  return winners;
}

/* Returns the last bits of the groups in which x has a bit. */
static inline trax_fast_pair trax_fast_groups_of(const struct trax_fast_units *units, trax_fast_pair x) {
  return (((x & units->below_top) + units->below_top) | x) & units->top;
}

/* Returns the winner of each group. If `even`, this is TRAX_FAST_ARBITRATE for all groups at once. */
static inline __attribute__((always_inline)) trax_fast_pair trax_fast_grant_units(struct trax_fast_units *units,
                                                                                  trax_fast_pair requesters) {
  if (!units->even)
    return (trax_fast_pair){trax_fast_grant_unevenly(units, 0, requesters[0]),
                            trax_fast_grant_unevenly(units, 1, requesters[1])};
  if (units->group_size == 1)
    return requesters;
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
