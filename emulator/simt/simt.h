/* The machine of docs/simt.md: the reference's chip, whose TPs are lanes of warps. Each chapter of that page is a file of
   this folder. Everything that the page does not describe is the reference's: a lane is a trax_ref_tp, and holds an
   instruction from the fetch of its group until it has issued it.

   Sets of lanes are masks of the TPs of a TM. */
#ifndef TRAX_SIMT_H
#define TRAX_SIMT_H

#include "reference/reference.h"

struct trax_simt_lane {
  int32_t depth;   /* number of calls that it is in */
  uint32_t waited; /* what its warp has issued since its last instruction, by cost (Choice) */
};

struct trax_simt_warp {
  uint64_t lanes;
  uint64_t group;      /* 0: none */
  uint64_t left;       /* lanes of the group that hold its instruction and have not issued it; 0: it is not fetched */
  uint32_t turns_lane; /* the lane that has the turn */
  uint32_t turns_left; /* instructions of its turn; 0: no lane has it */
};

struct trax_simt_tm {
  struct trax_ref_tm *ref;
  uint32_t warps;
  struct trax_simt_warp warp[MOST];
  struct trax_simt_lane lane[MOST];
  uint64_t broadcast; /* lanes that another lane's access to a bank serves in this cycle */
};

struct trax_simt_chip {
  struct trax_ref_chip ref;
  struct trax_simt_tm *tm; /* [ref.tms] */
};

/* --- sets of lanes --- */

static inline uint64_t trax_simt_bit(uint32_t lane) {
  return UINT64_C(1) << lane;
}

/* Takes the first lane out of a set that is not empty, and returns it. */
static inline uint32_t trax_simt_take(uint64_t *set) {
  const uint32_t first = (uint32_t)__builtin_ctzll(*set);
  *set &= *set - 1;
  return first;
}

static inline uint32_t trax_simt_count(uint64_t set) {
  return (uint32_t)__builtin_popcountll(set);
}

/* The lane whose pc and number a group asks with. */
static inline struct trax_ref_tp *trax_simt_first(const struct trax_simt_tm *tm, uint64_t group) {
  return &tm->ref->tp[__builtin_ctzll(group)];
}

/* Serves an arbiter over positions from `first` on: returns the winner's mask, 0 if no lane of `asks` has one. */
uint64_t trax_simt_arbitrate(trax_ref_pointer *pointer, uint64_t asks, uint32_t first, uint32_t n);
/* Charges all lanes of the set that have not been charged in this cycle. */
void trax_simt_charge(struct trax_simt_tm *tm, uint64_t set, uint64_t t, trax_cause cause);

/* --- Choice: choice.c --- */
void trax_simt_choose(struct trax_simt_tm *tm);
/* Accounts for an instruction that all lanes of the warp's group have issued, and dissolves the group. */
void trax_simt_dissolve(struct trax_simt_tm *tm, struct trax_simt_warp *warp);

/* --- Fetch: fetch.c --- */
void trax_simt_fetch(struct trax_simt_tm *tm, uint64_t t);

/* --- Operands: operands.c --- */
void trax_simt_check_operands(struct trax_simt_tm *tm, uint64_t t);

/* --- Data cache: data_cache.c --- */
void trax_simt_grant_data_banks(struct trax_simt_tm *tm, uint64_t t);

/* --- Accounting: accounting.c. After step 5. --- */
void trax_simt_account(struct trax_simt_tm *tm, uint64_t t);

#endif
