/* Arithmetic on masks of a TM's TPs: arbiters, counters, planes of bytes. */
#ifndef TRAX_FAST_MASKS_H
#define TRAX_FAST_MASKS_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#ifdef __SSE2__
#include <immintrin.h>
#endif

/* Masks that are handled together: of a whole TM's TPs, or of the at most 16 TPs of an instruction cache. */
enum { TRAX_FAST_LANES = 4, TRAX_FAST_LANES16 = 16 };
typedef uint64_t trax_fast_lanes __attribute__((vector_size(8 * TRAX_FAST_LANES), may_alias));
typedef uint16_t trax_fast_lanes16 __attribute__((vector_size(2 * TRAX_FAST_LANES16), may_alias));

/* Vectors are passed by address: how they are passed by value depends on what they are compiled for. */
static inline uint64_t trax_fast_any(const trax_fast_lanes *lanes) {
  return (*lanes)[0] | (*lanes)[1] | (*lanes)[2] | (*lanes)[3];
}

static inline uint64_t trax_fast_any16(const trax_fast_lanes *lanes) {
#ifdef __SSE2__
  const __m128i *const halves = (const __m128i *)lanes;
  __m128i four = _mm_or_si128(halves[0], halves[1]);
  four = _mm_or_si128(four, _mm_shuffle_epi32(four, 0x4E));
  uint64_t any = (uint64_t)_mm_cvtsi128_si64(four);
#else
  uint64_t any = trax_fast_any(lanes);
#endif
  any |= any >> 32;
  return (any | any >> 16) & 0xFFFF;
}

/* Arbiters, one in each lane. `behind` has the bits behind the latest winner, which says what the reference's pointer
   says. The first of the askers among them, or else the first of all, wins; 0 of 0. */
#define TRAX_FAST_ARBITRATE(LANES, BEHIND, ASKERS, WINNERS)                                                            \
  do {                                                                                                                 \
    const LANES preferred_ = (ASKERS) & *(BEHIND);                                                                     \
    const LANES among_ = preferred_ | ((ASKERS) & (LANES)(preferred_ == 0));                                           \
    *(WINNERS) = among_ & -among_;                                                                                     \
    *(BEHIND) = ~(*(WINNERS) | (*(WINNERS)-1)) | (*(BEHIND) & (LANES)(*(WINNERS) == 0));                               \
  } while (0)

/* The TPs that were refused something in a cycle, by what it was. */
struct trax_fast_lost {
  uint64_t fetch, fp_add, fp_mul, int_mul, special, bank;
};

/* Counters of each TP for each of them, bit-sliced: planes[k] holds bit k of all TPs' counters, so that a cycle is
   charged to all TPs at once; several cycles together, since carries cost most. */
enum { TRAX_FAST_LOG = 15 }; /* cycles; their sums have 4 bits */

struct trax_fast_tally {
  trax_fast_lanes planes[64][2]; /* fetch, fp_add, fp_mul, int_mul; special, bank */
  trax_fast_lanes log[TRAX_FAST_LOG][2];
  uint32_t logged;
};

/* Adds the log to the planes. */
void trax_fast_count_log(struct trax_fast_tally *tally);

static inline void trax_fast_count(struct trax_fast_tally *tally, const struct trax_fast_lost *lost) {
  trax_fast_lanes(*const log)[2] = &tally->log[tally->logged];
  (*log)[0] = (trax_fast_lanes){lost->fetch, lost->fp_add, lost->fp_mul, lost->int_mul};
  (*log)[1] = (trax_fast_lanes){lost->special, lost->bank};
  if (++tally->logged == TRAX_FAST_LOG)
    trax_fast_count_log(tally);
}

/* Shared units of two kinds, for groups of neighbours. `even`: one of each kind to a group, grouped alike and so that
   the groups are 64 bits; then all groups are served at once. */
typedef uint64_t trax_fast_pair __attribute__((vector_size(16)));

struct trax_fast_units {
  uint32_t group_size;
  bool even;
  uint64_t top, below_top; /* of each group, if they are: the last bit, the others */
  trax_fast_pair behind;   /* those who come before the others: the bits behind the latest winners */
  struct {
    uint32_t groups, per_group;
    uint64_t group[64];
  } uneven[2];
};

static inline uint64_t trax_fast_grant_unevenly(struct trax_fast_units *units, unsigned kind, uint64_t askers) {
  uint64_t winners = 0, behind = units->behind[kind];
  for (uint32_t i = 0; i < units->uneven[kind].groups; i++) {
    const uint64_t group = units->uneven[kind].group[i];
    uint64_t all = askers & group;
    for (uint32_t unit = units->uneven[kind].per_group; unit && all; unit--) {
      const uint64_t preferred = all & behind, among = preferred ? preferred : all, winner = among & -among;
      winners |= winner;
      all ^= winner;
      behind = (behind & ~group) | (group & ~(winner | (winner - 1)));
    }
  }
  units->behind[kind] = behind;
  return winners;
}

/* The last bits of the groups in which x has a bit. */
static inline trax_fast_pair trax_fast_groups_of(const struct trax_fast_units *units, trax_fast_pair x) {
  return (((x & units->below_top) + units->below_top) | x) & units->top;
}

/* The winner of each group, in the manner of trax_fast_first_after for all groups at once. */
static inline trax_fast_pair trax_fast_grant_units(struct trax_fast_units *units, trax_fast_pair askers) {
  if (!units->even)
    return (trax_fast_pair){trax_fast_grant_unevenly(units, 0, askers[0]),
                            trax_fast_grant_unevenly(units, 1, askers[1])};
  if (units->group_size == 1)
    return askers;
  const int to_first = (int)units->group_size - 1;
  const trax_fast_pair preferred = askers & units->behind;
  const trax_fast_pair have = trax_fast_groups_of(units, preferred);
  const trax_fast_pair among = preferred | (askers & ~((have - (have >> to_first)) | have));
  const trax_fast_pair asked = trax_fast_groups_of(units, askers), first = asked >> to_first;
  /* In groups with an asker, among - first borrows from no neighbour. */
  const trax_fast_pair winners = among & ~(among - first);
  const trax_fast_pair asked_groups = (asked - first) | asked;
  units->behind = (units->behind & ~asked_groups) | (asked_groups & ~(winners | (winners - first)));
  return winners;
}

/* What the heads ask for, turned into masks of TPs. */
struct trax_fast_planes {
  uint64_t bit[16];
};

/* Bits 0 to 6 and, of the data-cache bank, the first `bank_bits`, of each of `count` TPs' words. */
static inline void trax_fast_transpose(const uint16_t *words, unsigned count, unsigned bank_bits,
                                       struct trax_fast_planes *planes) {
#if defined(__AVX2__) || defined(__SSE2__)
  for (unsigned i = 0; i == 0 || i < count; i += 32) {
#ifdef __AVX2__
    const __m256i low_byte = _mm256_set1_epi16(0xFF);
    const __m256i first = _mm256_load_si256((const __m256i *)(words + i));
    const __m256i second = _mm256_load_si256((const __m256i *)(words + i + 16));
    const __m256i low = _mm256_permute4x64_epi64(
        _mm256_packus_epi16(_mm256_and_si256(first, low_byte), _mm256_and_si256(second, low_byte)), 0xD8);
    const __m256i high =
        _mm256_permute4x64_epi64(_mm256_packus_epi16(_mm256_srli_epi16(first, 8), _mm256_srli_epi16(second, 8)), 0xD8);
#define MASK(OF, K) ((uint64_t)(unsigned)_mm256_movemask_epi8(_mm256_slli_epi16(OF, 7 - (K))) << i)
#else
    __m128i low[2], high[2];
    for (unsigned half = 0; half < 2; half++) {
      const __m128i low_byte = _mm_set1_epi16(0xFF);
      const __m128i first = _mm_load_si128((const __m128i *)(words + i + 16 * half));
      const __m128i second = _mm_load_si128((const __m128i *)(words + i + 16 * half + 8));
      low[half] = _mm_packus_epi16(_mm_and_si128(first, low_byte), _mm_and_si128(second, low_byte));
      high[half] = _mm_packus_epi16(_mm_srli_epi16(first, 8), _mm_srli_epi16(second, 8));
    }
#define HALF(OF, K) (uint64_t)(unsigned) _mm_movemask_epi8(_mm_slli_epi16(OF, 7 - (K)))
#define MASK(OF, K) ((HALF(OF[0], K) | HALF(OF[1], K) << 16) << i)
#endif
#define PLANE(OF, K, BIT) planes->bit[BIT] = (i ? planes->bit[BIT] : 0) | MASK(OF, K)
    PLANE(low, 0, 0);
    PLANE(low, 1, 1);
    PLANE(low, 2, 2);
    PLANE(low, 3, 3);
    PLANE(low, 4, 4);
    PLANE(low, 5, 5);
    PLANE(low, 6, 6);
    PLANE(high, 0, 8);
    PLANE(high, 1, 9);
    PLANE(high, 2, 10);
    if (bank_bits <= 3)
      continue;
    PLANE(high, 3, 11);
    PLANE(high, 4, 12);
    PLANE(high, 5, 13);
#undef PLANE
#undef MASK
#undef HALF
  }
#else
  (void)bank_bits;
  for (unsigned k = 0; k < 16; k++)
    planes->bit[k] = 0;
  for (unsigned i = 0; i < count; i++)
    for (unsigned k = 0; k < 16; k++)
      planes->bit[k] |= (uint64_t)(words[i] >> k & 1) << i;
#endif
}

#endif
