/* The machine of docs/simt.md: the reference's chip, whose TPs are lanes of warps. Each chapter of that page is a file
   of this folder. Everything that the page does not describe is the reference's: a lane is a trax_ref_tp, and holds an
   instruction from the fetch of its group until it has issued it.

   Sets of lanes are masks of the TPs of a TM. A lane outside a group does nothing, and is charged when it is in a group
   again (Accounting). */
#ifndef TRAX_SIMT_H
#define TRAX_SIMT_H

#include "reference/reference.h"

struct trax_simt_lane {
  int32_t depth;     /* number of calls that it is in */
  uint32_t waited;   /* what its warp has issued since its last instruction, by cost (Choice) */
  uint64_t charged;  /* the number of cycles for which it is charged, unless it is in a group */
  uint8_t waits_for; /* the register that refused it in the latest step 2; 0: none */
};

struct trax_simt_warp {
  uint64_t running;    /* lanes whose threads have not ended */
  uint64_t group;      /* 0: none */
  uint64_t left;       /* lanes of the group that hold its instruction and have not issued it; 0: it is not fetched */
  uint64_t active;     /* those of them that no step of this cycle has refused so far */
  uint64_t uncharged;  /* lanes of the group that have not been charged in this cycle */
  bool is_checked;     /* the lanes of the group have been in step 2 */
  bool has_operands;   /* step 2 has accepted all of them */
  trax_shared unit;    /* that they then ask for, unless they access memory */
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
  uint64_t t;              /* the next cycle */
};

/* --- sets of lanes --- */

static inline uint64_t trax_simt_bit(uint32_t lane) {
  return UINT64_C(1) << lane;
}

/* The first lane of a set that is not empty. */
static inline uint32_t trax_simt_first(uint64_t set) {
  return (uint32_t)__builtin_ctzll(set);
}

/* Takes the first lane out of a set that is not empty, and returns it. */
static inline uint32_t trax_simt_take(uint64_t *set) {
  const uint32_t first = trax_simt_first(*set);
  *set &= *set - 1;
  return first;
}

/* The lane that speaks for the group: its pc and number are those with which the group asks. */
static inline struct trax_ref_tp *trax_simt_speaker(const struct trax_simt_tm *tm, uint64_t group) {
  return &tm->ref->tp[trax_simt_first(group)];
}

/* Serves an arbiter over the n lanes from `first` on. Returns the winner, as a set; 0 if nobody asks. */
uint64_t trax_simt_arbitrate(trax_ref_pointer *pointer, uint64_t asks, uint32_t first, uint32_t n);

/* --- Choice: choice.c --- */
void trax_simt_choose(struct trax_simt_tm *tm, uint64_t t);
/* Accounts for an instruction that all lanes of the warp's group have issued, and dissolves the group. */
void trax_simt_dissolve(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint64_t t);

/* --- Fetch: fetch.c --- */
void trax_simt_fetch(struct trax_simt_tm *tm, uint64_t t);

/* --- Operands: operands.c --- */
void trax_simt_check_operands(struct trax_simt_tm *tm, uint64_t t);

/* --- Shared units, data cache, memory queue: resources.c --- */
void trax_simt_grant_units(struct trax_simt_tm *tm, uint64_t t);
void trax_simt_grant_data_banks(struct trax_simt_tm *tm, uint64_t t);
void trax_simt_grant_places(struct trax_simt_tm *tm, uint64_t t);

/* --- Issue, and Accounting: accounting.c --- */
/* Charges the lanes of groups that are in a branch bubble. The first step of a cycle. */
void trax_simt_charge_bubbles(struct trax_simt_tm *tm, uint64_t t);
void trax_simt_issue(struct trax_simt_tm *tm, uint64_t t);
/* Whether a step of the reference has charged the lane. */
bool trax_simt_is_charged(struct trax_simt_warp *warp, struct trax_ref_tp *lane);
/* Charges the lanes of the set that have not been charged in this cycle. They do nothing in the later steps. */
void trax_simt_charge(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint64_t set, uint64_t t, trax_cause cause);
/* Charges a lane outside of groups for all cycles before t. */
void trax_simt_catch_up(struct trax_simt_tm *tm, uint32_t lane, uint64_t t);

#endif
