/* The machine of docs/simt.md: the reference's chip, whose TPs are lanes of warps. Each chapter of that page is a file
   of this folder. Everything that the page does not describe is the reference's: a lane is a trax_ref_tp, and holds an
   instruction from the fetch of its group until it has issued it.

   Sets of lanes are masks of the TPs of a TM. A lane outside a group does nothing, and is charged when it is in a group
   again (Accounting). */
#ifndef TRAX_SIMT_H
#define TRAX_SIMT_H

#include "machine/text.h"
#include "machine/watch.h"
#include "reference/reference.h"

#define TRAX_SIMT_SURFACE UINT64_C(0x7FFFFFFF) /* of a depth of 0, so that depths may be negative */

/* An instruction of the text. */
struct trax_simt_inst {
  const struct trax_decoded *decoded;
  trax_inst inst;
  uint32_t needs; /* registers that must be usable, as a set */
  int8_t calls;   /* 1: it calls; -1: it returns */
  bool is_wait;   /* whether threads wait for others with it */
};

struct trax_simt_lane {
  uint64_t charged;  /* the number of cycles for which it is charged, unless it is in a group */
  uint32_t pending;  /* registers, as a set; all others are usable */
  uint8_t waits_for; /* the register that refused it in the latest step 2; 0: none */
  uint8_t bank;      /* of the instruction cache, if it asks for one */
  uint8_t warp, icache;
};

struct trax_simt_warp {
  uint32_t first;       /* its first lane */
  uint64_t running;     /* lanes whose threads have not ended */
  uint64_t group;       /* the active mask; 0: none */
  uint64_t left;        /* lanes of the group that hold its instruction and have not issued it; 0: it is not fetched */
  uint64_t active;      /* those of them that no step of this cycle has refused so far */
  uint64_t uncharged;   /* lanes of the group that have not been charged in this cycle */
  bool is_checked;      /* the lanes of the group have been in step 2 */
  bool has_operands;    /* step 2 has accepted all of them */
  uint64_t bubble_ends; /* no lane is in a branch bubble from this cycle on */
  const struct trax_simt_inst *inst; /* the group's instruction, from step 1 on */
  uint64_t issued;                   /* what it has issued, by cost (Choice) */
  uint64_t waits_from;               /* no running lane has issued last when `issued` was less */
  uint32_t turns_lane;               /* the lane that has the turn */
  uint32_t turns_left;               /* instructions of its turn; 0: no lane has it */
  uint64_t stays;                    /* the latest group, if its lanes are at one place and run; 0: otherwise */
  uint64_t others;     /* the least place of the running lanes outside of it; 0: some of them have another depth */
  uint64_t wakes;      /* asleep: the cycle in which it wakes at the latest */
  uint64_t slept_from; /* asleep: the first cycle for which the lanes of its group are not charged */
};

/* A warp's memory of its latest fetches. */
struct trax_simt_fetched {
  struct trax_simt_inst inst; /* its instruction, if that is not in the first segment */
  uint32_t line;              /* the latest line that was found in the cache */
  uint64_t arrivals;          /* of lines in that cache by then */
};

/* Two things are no rules of the page, and show in nothing. A group that has not diverged and is before all other lanes
   remains the group (`stays`, `others`). A warp whose group waits for registers or for a line of instructions sleeps:
   nothing changes for it before a known cycle or an arrival, and its lanes are charged when it wakes. */
struct trax_simt_tm {
  struct trax_ref_tm *ref;
  uint32_t warps;
  const struct trax_text *text;
  const struct trax_simt_inst *inst; /* [inst_count]: of its first segment, which begins at inst_begin */
  uint32_t inst_begin, inst_count;
  bool refuses[TRAX_SHARED_COUNT]; /* whether units of the kind are ever taken */
  uint64_t awake;                  /* warps, as a set; those whose lanes have all ended are not awake either */
  uint64_t wakes;                  /* if no warp is awake: the cycle in which the first one wakes at the latest */
  struct trax_simt_warp warp[MOST];
  struct trax_simt_fetched fetched[MOST]; /* by warp */
  struct trax_simt_lane lane[MOST];
  /* Lanes, for Choice: */
  uint64_t place[MOST];       /* TRAX_SIMT_SURFACE less its depth, then its pc: the least goes first */
  uint64_t last_issued[MOST]; /* `issued` of its warp when it issued last */
  uint64_t lost_bank;         /* lanes that have asked a bank of the instruction cache in vain in this cycle */
  uint64_t broadcast;         /* lanes that another lane's access to a bank serves in this cycle */
  /* Warps with active lanes, from step 2 on: those that ask for units, access memory, and take turns for places. */
  uint64_t for_units, for_memory, for_turns;
};

struct trax_simt_chip {
  struct trax_ref_chip ref;
  struct trax_simt_tm *tm;     /* [ref.tms] */
  struct trax_simt_inst *inst; /* as trax_simt_tm.inst */
  uint64_t t;                  /* the next cycle */
  /* Memory beyond the TMs is visited only when it has something to do. */
  bool is_waited_for; /* a request may wait for it, or it has rules of its own for every cycle */
  uint64_t arrives;   /* the cycle of the next arrival of those it has served */
};

/* --- sets of lanes --- */

static inline uint64_t trax_simt_bit(uint32_t lane) {
  return UINT64_C(1) << lane;
}

/* The n lanes from `first` on, at least one. */
static inline uint64_t trax_simt_lanes(uint32_t first, uint32_t n) {
  return UINT64_MAX >> (64 - n) << first;
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

/* Takes note of what a step of the reference has charged the lane for. False: for nothing. */
static inline bool trax_simt_note_charge(struct trax_simt_warp *warp, struct trax_ref_tp *lane) {
  if (!lane->charged)
    return false;
  lane->charged = false; /* for the next cycle */
  warp->active &= ~trax_simt_bit(lane->number);
  warp->uncharged &= ~trax_simt_bit(lane->number);
  return true;
}

/* Serves an arbiter over the n lanes from `first` on. Returns the winner, as a set; 0 if nobody asks. */
static inline uint64_t trax_simt_arbitrate(trax_ref_pointer *pointer, uint64_t asks, uint32_t first, uint32_t n) {
  if (!asks)
    return 0;
  const uint64_t before = trax_simt_bit(first + *pointer) - 1;
  const uint32_t winner = trax_simt_first(asks & ~before ? asks & ~before : asks), next = winner - first + 1;
  *pointer = next == n ? 0 : next;
  return trax_simt_bit(winner);
}

/* --- The text: text.c --- */
/* False: out of memory. */
bool trax_simt_decode(struct trax_simt_chip *chip, const struct trax_text *text);
/* Decodes the instruction at pc, which may be TRAX_RESOURCE_NO_TEXT. */
struct trax_simt_inst trax_simt_decode_at(const struct trax_simt_tm *tm, uint32_t pc);

/* --- Choice: choice.c --- */
void trax_simt_choose(struct trax_simt_tm *tm, uint64_t t);
/* Accounts for an instruction that all lanes of the warp's group have issued, and dissolves the group. */
void trax_simt_dissolve(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint64_t t);

/* --- Fetch: fetch.c --- */
void trax_simt_fetch(struct trax_simt_tm *tm, uint64_t t);
/* Charges a group that has not got its instruction. */
void trax_simt_charge_fetch(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint64_t t);

/* --- Operands: operands.c --- */
void trax_simt_check_operands(struct trax_simt_tm *tm, uint64_t t);

/* --- Sleep: sleep.c --- */
/* Wakes the warps that wait for cycle t, and all if something has arrived. */
void trax_simt_wake(struct trax_simt_tm *tm, uint64_t t, bool has_arrived);
/* Whether it has surely something to do in the next cycle: it chooses a group, or asks for what the group needs. */
static inline bool trax_simt_is_busy(const struct trax_simt_warp *warp) {
  return warp->running && (!warp->group || warp->has_operands);
}

/* Puts a warp that is not busy to sleep, unless it has something to do in the next cycle. The last step of a cycle. */
void trax_simt_sleep(struct trax_simt_tm *tm, uint32_t warp, uint64_t t);
/* Charges the lanes of a sleeping warp's group for all cycles before t. */
void trax_simt_charge_sleep(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint64_t t);

/* --- Shared units, data cache, memory queue: resources.c --- */
void trax_simt_grant_units(struct trax_simt_tm *tm, uint64_t t);
void trax_simt_grant_data_banks(struct trax_simt_tm *tm, uint64_t t);
void trax_simt_grant_places(struct trax_simt_tm *tm, uint64_t t);

/* --- Issue, and Accounting: accounting.c --- */
/* Charges the lanes of the warp's group that have ended or are in a branch bubble. The first step of a cycle. */
void trax_simt_charge_idle(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint64_t t);
void trax_simt_issue(struct trax_simt_tm *tm, uint64_t t);
/* Charges the lanes of the set that have not been charged in this cycle. They do nothing in the later steps. */
void trax_simt_charge(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint64_t set, uint64_t t, trax_cause cause);
void trax_simt_charge_cycles(const struct trax_simt_tm *tm, uint32_t lane, trax_cause cause, uint64_t since,
                             uint64_t cycles);
/* Gives the charges of all lanes, which must be up to date, to the kinds of rays that they work for. */
void trax_simt_settle_rays(struct trax_simt_tm *tm);
/* Charges a lane outside of groups for all cycles before t. */
void trax_simt_catch_up(struct trax_simt_tm *tm, uint32_t lane, uint64_t t);

#endif
