/* A thread multiprocessor: its TPs, what they share, and the rare events of its cycles. cycle.c has the others. */
#ifndef TRAX_FAST_TM_H
#define TRAX_FAST_TM_H

#include "fast/time/heads.h"
#include "fast/time/masks.h"
#include "fast/tm/dcache.h"
#include "fast/tm/icache.h"
#include "fast/tm/queue.h"
#include "fast/tm/tp.h"
#include "machine/machine.h"
#include "machine/ray_cycles.h"
#include "machine/timing.h"

/* Units that TPs share (docs/timing.md, "Units"). Adders and multipliers have masks instead of arbiters if these give
   the same (time/masks.h). */
#define TRAX_SHARED_UNIT_STATE(X, S) X(S, trax_arbiter, arbiter, [64]) /* [groups] */

/* All units of a kind in a TM. */
struct trax_shared_unit {
  struct trax_shared_kind kind;
  uint64_t *free_from; /* [group][unit]: a cycle; NULL if they are always free */
  TRAX_SHARED_UNIT_STATE(TRAX_FIELD, )
};

/* The number of elements of free_from. */
static inline size_t trax_shared_unit_count(const struct trax_shared_unit *unit) {
  return unit->free_from ? (size_t)unit->kind.groups * unit->kind.per_group : 0;
}

#define TRAX_WHEEL 64 /* slots of the timer wheel, one for each cycle; they are the bits of wheel_occupied */

struct trax_chip;

/* Some of trax_fast_heads at the end of a quantum, a byte for each TP (time/prefetch.h). */
struct trax_fast_outlook {
  uint64_t at[TRAX_MAX_TPS_PER_TM / 8], last[TRAX_MAX_TPS_PER_TM / 8], load[TRAX_MAX_TPS_PER_TM / 8];
};

/* A TM's record for an observer of stretches (machine/observer.h). */
enum { TRAX_FAST_NO_OUTCOME = 0xFF /* a load that hit */ };

struct trax_fast_observed {
  uint8_t told[TRAX_MAX_TPS_PER_TM];       /* steps of the burst of which the observer knows */
  uint8_t told_loads[TRAX_MAX_TPS_PER_TM]; /* the accesses to global memory among them */
  /* The refusals of the head, and the TPs with some. They go to `refused` when the head of a burst issues, and
     otherwise to the log. */
  uint64_t tps;
  _Alignas(64) uint8_t of_head[TRAX_MAX_TPS_PER_TM]; /* trax_stretch.refused */
  uint8_t refused[TRAX_MAX_TPS_PER_TM][TRAX_BURST];  /* the same, of each step */
  /* Of each access to global memory of the burst; they are read by 32. */
  uint8_t outcomes[TRAX_MAX_TPS_PER_TM][TRAX_BURST + 32];
};

/* A TP is awake; or it sleeps until a cycle (in the wheel), until an arrival (in `awaiting`, or in the list of an
   instruction cache), or for ever (ended). */
#define TRAX_TM_STATE(X, S)                                                                                            \
  X(S, uint64_t, awake, ) /* this and the next three: masks of TPs */                                                  \
  X(S, uint64_t, holding, )                                                                                            \
  X(S, uint64_t, awaiting, )                                                                                           \
  X(S, uint64_t, ended, )                                                                                              \
  X(S, uint64_t, wheel, [TRAX_WHEEL]) /* [cycle % 64]: mask of the TPs that wake */                                    \
  X(S, uint64_t, progressed, )        /* the cycle after the latest trap or halt; 0: there was none */                 \
  X(S, trax_arbiter, queue_arbiter, )                                                                                  \
  X(S, _Alignas(64) uint64_t, data_bank_rr_masks, [TRAX_MAX_TPS_PER_TM])                                               \
  X(S, _Alignas(64) uint16_t, fetch_rr_masks16, [16 * 4]) /* [bank][instruction cache], 2 caches if not `wide` */
struct trax_tm {
  _Alignas(64) uint32_t number; /* host threads run neighbouring TMs: none shares a cache line */
  uint32_t tps;
  struct trax_chip *chip;
  const struct trax_config *config;
  struct trax_machine *machine;
  FILE *output;                        /* the guest's; NULL discards it */
  struct trax_observer *observer;      /* NULL: none */
  struct trax_fast_observed *observed; /* for one of stretches; else NULL */
  struct trax_tp *tp;                  /* [tps] */
  struct trax_icache *icache;          /* [icaches] */
  uint32_t icaches;
  struct trax_tm_stats *stats;
  struct trax_tp_stats *tp_stats; /* [tps] */
  int32_t *exit_statuses;         /* [tps] */
  trax_ray_counts *ray_counts;    /* NULL: the cycles of rays are not counted */
  struct trax_thread_rays *rays;  /* [tps] */

  struct trax_store_buffer *buffer; /* in an epoch; else NULL */
  uint64_t now;                     /* the cycle that is being simulated */
  TRAX_TM_STATE(TRAX_FIELD, )
  uint64_t wheel_occupied; /* slots that are not empty */
  uint64_t next_cycle;     /* no earlier cycle changes anything in this TM */
  uint32_t running;        /* threads that have not ended */

  /* Masks of TPs. */
  uint64_t ready; /* holds an instruction with usable operands, which lacks a unit, a bank or a queue place */
  uint64_t executes_at_issue;
  uint64_t storing;   /* the burst has stores to global memory; a slow head at a bank may be one of them */
  uint64_t no_text;   /* the head is no text: its fetch faults */
  uint64_t busy;      /* busy_registers is not 0 */
  uint64_t uncertain; /* a line of the burst may not be resident */
  uint64_t load_hits; /* the data cache has the line of heads.address */
  uint64_t recheck;   /* held an instruction at the import, whose operands must be checked in the first cycle */

  /* The number of executions of each instruction since the latest collect(), as differences: that of instruction i is
     the sum of [0] to [i]. So neighbours cost two additions. */
  int64_t *count_deltas; /* [inst_count + 1] */
  struct trax_fast_heads heads;
  bool wide; /* more than 32 TPs */
  /* Masks of registers that may not be usable yet: an issue sets the bit of its destination unless the result is usable
     in the next cycle, and a check that finds the register usable clears it. trax_tp.usable is only valid for registers
     whose bit is set. */
  uint32_t busy_registers[TRAX_MAX_TPS_PER_TM];

  /* `simple_fetch`: 16 TPs share an instruction cache, which has at most 16 banks of one port. Then fetch_rr_masks16 is
     used, and all caches are arbitrated together (masks.h). */
  bool simple_fetch;
  trax_arbiter *fetch_arbiters; /* [icaches][banks] */
  bool serial_hits;             /* data-cache hits are served one by one: they update the scoreboard or the LRU order */
  uint64_t (*resident)[TRAX_FAST_LINES / 64]; /* [icaches]: a bit for each line of the program that the cache holds */
  uint8_t icache_of[TRAX_MAX_TPS_PER_TM];

  struct trax_fast_units fp;
  struct trax_dcache dcache;
  struct trax_queue queue;
  /* [TP]: the places in WRITTEN blocks from which its burst has loaded, as bits trax_fast_line_hash % 64; 0: none.
     [trax_fast_line_hash]: the TPs with bursts that have loaded from there, and perhaps others. */
  _Alignas(64) uint64_t watched[TRAX_MAX_TPS_PER_TM], readers[1024];
  uint64_t looked_up, at_issue; /* fetches and instructions that were slow */
  struct trax_fast_refusal_counts refusal_counts;
  struct trax_shared_unit unit[TRAX_SHARED_COUNT];
  struct trax_fault fault;          /* of the current cycle, of the lowest TP with one */
  struct trax_fast_outlook outlook; /* which other threads may read */
};

/* Charges sleeping TPs for the cycles before `t`, which are over. */
void trax_tm_settle(struct trax_tm *tm, uint64_t t);

static inline bool trax_tm_has_one_awake(const struct trax_tm *tm) {
  return tm->awake && !(tm->awake & (tm->awake - 1));
}

/* Notifies the observer, which must exist, of a charge. */
void trax_tm_tell_charge(struct trax_tm *tm, unsigned tp, trax_cause cause, uint64_t since, uint64_t cycles);
/* Notifies an observer of a charge. */
static inline void trax_tm_notify_charge(struct trax_tm *tm, unsigned tp, trax_cause cause, uint64_t since,
                                         uint64_t cycles) {
  if (__builtin_expect(tm->observer != NULL, false))
    trax_tm_tell_charge(tm, tp, cause, since, cycles);
}

/* Charges a TP for the current cycle. */
static inline void trax_tm_charge(struct trax_tm *tm, unsigned tp, trax_cause cause) {
  tm->tp_stats[tp].cycles[cause]++;
  trax_tm_notify_charge(tm, tp, cause, tm->now, 1);
}

/* Puts an awake TP to sleep; it is charged to cause from cycle `since` on. The caller must make sure that it wakes. */
static inline void trax_tm_sleep(struct trax_tm *tm, unsigned tp, uint64_t since, trax_cause cause) {
  tm->awake &= ~((uint64_t)1 << tp);
  tm->tp[tp].asleep_since = since;
  tm->tp[tp].asleep_cause = (uint8_t)cause;
}

static inline void trax_tm_wake(struct trax_tm *tm, unsigned tp, uint64_t t) {
  tm->awake |= (uint64_t)1 << tp;
  tm->tp_stats[tp].cycles[tm->tp[tp].asleep_cause] += t - tm->tp[tp].asleep_since;
  trax_tm_notify_charge(tm, tp, (trax_cause)tm->tp[tp].asleep_cause, tm->tp[tp].asleep_since,
                        t - tm->tp[tp].asleep_since);
}

/* Ends the thread from cycle `since` on. */
void trax_tm_end_thread(struct trax_tm *tm, unsigned tp, uint64_t since, int32_t status);

/* Records a fault of cycle t unless a lower TP has one, and ends the thread. */
void trax_tm_fault(struct trax_tm *tm, unsigned tp, uint64_t t, trax_fault_kind kind, uint32_t address);

/* Makes register rd of TP `tp` usable in cycle t, and wakes the TP if it waits for it. */
void trax_tm_data_arrival(struct trax_tm *tm, unsigned tp, unsigned rd, uint64_t t);

/* Receives what the memory has served: lowers next_cycle to the completions. */
void trax_tm_receive(struct trax_tm *tm, unsigned side);
/* Handles a request that completes in cycle t. */
void trax_tm_complete(struct trax_tm *tm, const struct trax_request *request, uint64_t t);
/* Wakes the TPs in the wheel's slot of cycle t. */
void trax_tm_wake_sleepers(struct trax_tm *tm, uint64_t t);
/* In cycle t, puts TP `tp` to sleep from `since` on, until it wakes in cycle `until`. */
void trax_tm_sleep_until(struct trax_tm *tm, unsigned tp, uint64_t t, uint64_t since, uint64_t until, trax_cause cause);
/* Serves the TP in step 4; its inst and address must be set. Returns TRAX_CAUSE_ISSUED, or the cause of a refusal. */
trax_cause trax_tm_serve(struct trax_tm *tm, unsigned tp, uint64_t t);
/* Notifies the observer, which must exist, of the instruction that TP `tp` has just issued at pc. */
void trax_tm_notify_issue(struct trax_tm *tm, unsigned tp, uint32_t pc, const struct trax_decoded *inst,
                          uint32_t next_pc);
/* Returns the first cycle from t on, before `end`, with an arrival or a TP that wakes; else `end`. */
uint64_t trax_tm_quiet_until(const struct trax_tm *tm, uint64_t t, uint64_t end);
/* Returns the first cycle after t in which anything can happen in the TM. */
uint64_t trax_tm_next_cycle(const struct trax_tm *tm, uint64_t t);

/* Makes and counts a memory request; the queue must have a place. */
void trax_tm_request(struct trax_tm *tm, struct trax_request request);

#endif
