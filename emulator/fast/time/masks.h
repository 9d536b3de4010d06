/* Arithmetic on masks of a TM's TPs: arbiters and bit-sliced counters. */
#ifndef TRAX_FAST_MASKS_H
#define TRAX_FAST_MASKS_H

#include "machine/section.h"
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
    *(RR_MASK) = -(*(WINNERS) + *(WINNERS)) | (*(RR_MASK) & (LANES)(*(WINNERS) == 0));                                 \
  } while (0)

/* The arbiters of the 16 banks of the instruction caches, with 16 TPs to a cache: bank by bank, two caches of a TM with
   at most 32 TPs, or four. A vector has the banks whose numbers differ in their low bits. */
#ifdef __AVX2__
enum { TRAX_FAST_VECTOR = 32 }; /* bytes */
#else
enum { TRAX_FAST_VECTOR = 16 };
#endif
typedef uint16_t trax_fast_lanes16 __attribute__((vector_size(TRAX_FAST_VECTOR), may_alias));

struct trax_fast_banks16 {
  union { /* round-robin masks: [bank][cache] */
    _Alignas(64) uint16_t of_two[16][2];
    uint16_t of_four[16][4];
  };
};

/* Defines a function that grants the banks and returns the losers. LANE: the caches of a bank. plane: the bits of the
   numbers of the TPs' banks. */
#define TRAX_FAST_REFUSE(NAME, LANE, RR_MASKS)                                                                         \
  static inline __attribute__((always_inline)) LANE NAME(struct trax_fast_banks16 *banks, uint64_t requesters,         \
                                                         const uint64_t *plane) {                                      \
    enum { BANKS = TRAX_FAST_VECTOR / sizeof(LANE) };                                                                  \
    typedef LANE lanes __attribute__((vector_size(TRAX_FAST_VECTOR), may_alias));                                      \
    const lanes none = {0};                                                                                            \
    lanes number = none, low = none + (LANE)requesters, refused = none; /* low: by the bits within a vector */         \
    for (unsigned i = 0; i < BANKS; i++)                                                                               \
      number[i] = (LANE)i;                                                                                             \
    for (unsigned k = 0; 1u << k < BANKS; k++)                                                                         \
      low &= (none + (LANE)plane[k]) ^ (lanes)((number & (LANE)1 << k) == 0);                                          \
    _Pragma("GCC unroll 8") for (unsigned first = 0; first < 16; first += BANKS) {                                     \
      LANE high = ~(LANE)0;                                                                                            \
      _Pragma("GCC unroll 4") for (unsigned k = 0; k < 4; k++)                                                         \
        high &= 1u << k < BANKS ? ~(LANE)0 : (LANE)(first >> k & 1 ? plane[k] : ~plane[k]);                            \
      const lanes requesting = low & (none + high);                                                                    \
      trax_fast_lanes16 *const rr_mask = (trax_fast_lanes16 *)banks->RR_MASKS[first];                                  \
      trax_fast_lanes16 winners;                                                                                       \
      TRAX_FAST_ARBITRATE(trax_fast_lanes16, rr_mask, (trax_fast_lanes16)requesting, &winners);                        \
      refused |= requesting ^ (lanes)winners;                                                                          \
    }                                                                                                                  \
    LANE losers = 0;                                                                                                   \
    for (unsigned i = 0; i < BANKS; i++)                                                                               \
      losers |= refused[i];                                                                                            \
    return losers;                                                                                                     \
  }
TRAX_FAST_REFUSE(trax_fast_refuse_two, uint32_t, of_two)
TRAX_FAST_REFUSE(trax_fast_refuse_four, uint64_t, of_four)

/* Returns the round-robin mask of a cache's bank. */
static inline uint16_t *trax_fast_fetch_rr_mask(struct trax_fast_banks16 *banks, bool wide, unsigned icache,
                                                unsigned bank) {
  return wide ? &banks->of_four[bank][icache] : &banks->of_two[bank][icache];
}

/* The TPs that were refused a bank or unit in a cycle, by its kind. */
struct trax_fast_refused {
  uint64_t fetch, unit[TRAX_SHARED_COUNT], bank;
};
enum { TRAX_FAST_REFUSALS = sizeof(struct trax_fast_refused) / sizeof(uint64_t) };

/* Bit-sliced counters of refusals for each TP and kind: planes[k] has bit k of the counters of all TPs, so that a cycle
   is counted for all TPs at once. A log of several cycles is added together, since the carries cost most. */
enum { TRAX_FAST_LOG_BITS = 5, TRAX_FAST_LOG = (1 << TRAX_FAST_LOG_BITS) - 1 /* cycles */ };
#define TRAX_FAST_COUNTERS (TRAX_FAST_REFUSALS <= 8 ? 8 : TRAX_FAST_REFUSALS <= 16 ? 16 : 32) /* a power of two */

struct trax_fast_refusal_counts {
  _Alignas(64) uint64_t planes[64][TRAX_FAST_COUNTERS]; /* in the order of trax_fast_refused */
  uint64_t log[TRAX_FAST_LOG][TRAX_FAST_COUNTERS];
  uint32_t logged;
};

/* Appends a cycle to the log. Returns whether the log is full. */
static inline bool trax_fast_count(struct trax_fast_refusal_counts *counts, const struct trax_fast_refused *refused) {
  memcpy(counts->log[counts->logged], refused, sizeof *refused);
  return ++counts->logged == TRAX_FAST_LOG;
}

/* As many counters as a vector of the host has: larger vectors would go through memory in parts. */
enum { TRAX_FAST_PART = TRAX_FAST_VECTOR / 8 };
typedef uint64_t trax_fast_counters __attribute__((vector_size(8 * TRAX_FAST_PART), may_alias));

/* Adds two terms to a bit of each counter, a full adder; returns the carries to the next bit. */
#define TRAX_FAST_ADD_TWO(SUM, ONE, OTHER)                                                                             \
  (__extension__({                                                                                                     \
    const trax_fast_counters one_ = (ONE), either_ = *(SUM) ^ one_, other_ = (OTHER);                                  \
    const trax_fast_counters carry_ = (*(SUM)&one_) | (either_ & other_);                                              \
    *(SUM) = either_ ^ other_;                                                                                         \
    carry_;                                                                                                            \
  }))

static inline bool trax_fast_is_any(const trax_fast_counters *some) {
  uint64_t any = 0;
  for (unsigned i = 0; i < TRAX_FAST_PART; i++)
    any |= (*some)[i];
  return any != 0;
}

/* Adds the log to the planes of the counters from `first` on. */
static __attribute__((unused)) void trax_fast_count_part(struct trax_fast_refusal_counts *counts, unsigned first) {
  const trax_fast_counters none = {0};
  trax_fast_counters log[TRAX_FAST_LOG], carry = none;
  unsigned count = TRAX_FAST_LOG; /* number of terms of the current bit, at the beginning of the log */
  for (unsigned i = 0; i < count; i++)
    log[i] = *(const trax_fast_counters *)&counts->log[i][first];
  for (unsigned bit = 0; bit < TRAX_FAST_LOG_BITS; bit++) {
    trax_fast_counters sum = log[0];
    count /= 2;
    for (unsigned i = 0; i < count; i++)
      log[i] = TRAX_FAST_ADD_TWO(&sum, log[2 * i + 1], log[2 * i + 2]);
    carry = TRAX_FAST_ADD_TWO((trax_fast_counters *)&counts->planes[bit][first], sum, carry);
  }
  for (unsigned bit = TRAX_FAST_LOG_BITS; bit < 64 && trax_fast_is_any(&carry); bit++)
    carry = TRAX_FAST_ADD_TWO((trax_fast_counters *)&counts->planes[bit][first], carry, none);
}

static __attribute__((unused)) void trax_fast_count_log(struct trax_fast_refusal_counts *counts) {
  if (counts->logged < TRAX_FAST_LOG)
    memset(counts->log[counts->logged], 0, (TRAX_FAST_LOG - counts->logged) * sizeof *counts->log);
  for (unsigned first = 0; first < TRAX_FAST_COUNTERS; first += TRAX_FAST_PART)
    trax_fast_count_part(counts, first);
  counts->logged = 0;
}

/* The adders and multipliers. `even`: both kinds have the same groups, one unit for each, and the groups' size divides
   64. Then all groups are arbitrated at once; otherwise their units are like those of other kinds (tm/unit.h). */
typedef uint64_t trax_fast_pair __attribute__((vector_size(16)));

#define TRAX_FAST_UNITS_STATE(X, S) X(S, trax_fast_pair, rr_masks, ) /* of all groups; only if `even` */
struct trax_fast_units {
  uint32_t group_size;
  bool even;
  uint64_t top, below_top; /* if `even`: the last bit of each group, and the other bits */
  TRAX_FAST_UNITS_STATE(TRAX_FIELD, )
};

/* Returns the last bits of the groups in which x has a bit. */
static inline trax_fast_pair trax_fast_groups_of(const struct trax_fast_units *units, trax_fast_pair x) {
  return (((x & units->below_top) + units->below_top) | x) & units->top;
}

/* Returns the winner of each group, by TRAX_FAST_ARBITRATE for all groups at once. Requires `even`. */
static inline __attribute__((always_inline)) trax_fast_pair trax_fast_grant_units(struct trax_fast_units *units,
                                                                                  trax_fast_pair requesters) {
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
