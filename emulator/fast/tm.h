/* A thread multiprocessor: its TPs, what they share, and the rare events of its cycles. cycle.c has the others. */
#ifndef TRAX_FAST_TM_H
#define TRAX_FAST_TM_H

#include "fast/dcache.h"
#include "fast/icache.h"
#include "fast/queue.h"
#include "fast/tp.h"
#include "fast/unit.h"
#include "machine/machine.h"

#define TRAX_WHEEL 64 /* slots of the timer wheel, one for each cycle; they are the bits of wheel_occupied */

struct trax_chip;

/* A TP is awake; or it sleeps until a cycle (in the wheel), until an arrival (in `awaiting`, or in the list of an
   instruction cache), or for ever (ended). */
#define TRAX_TM_STATE(X, S)                                                                                            \
  X(S, uint64_t, awake, ) /* this and the next three: masks of TPs */                                                  \
  X(S, uint64_t, holding, )                                                                                            \
  X(S, uint64_t, awaiting, )                                                                                           \
  X(S, uint64_t, ended, )                                                                                              \
  X(S, uint64_t, wheel, [TRAX_WHEEL]) /* [cycle % 64]: mask of the TPs that wake */                                    \
  X(S, uint64_t, wheel_occupied, )    /* slots that are not empty */                                                   \
  X(S, uint64_t, next_cycle, )        /* no earlier cycle changes anything in this TM */                               \
  X(S, uint64_t, progressed, )        /* the cycle after the latest trap or halt; 0: there was none */                 \
  X(S, uint32_t, running, )           /* threads that have not ended */                                                \
  X(S, trax_arbiter, queue_arbiter, )
struct trax_tm {
  _Alignas(64) uint32_t number; /* host threads run neighbouring TMs: none shares a cache line */
  uint32_t tps;
  struct trax_chip *chip;
  const struct trax_config *config;
  struct trax_machine *machine;
  const struct trax_text *text;
  FILE *output;                         /* the guest's; NULL discards it */
  const struct trax_observer *observer; /* NULL: none */
  struct trax_tp *tp;                   /* [tps] */
  struct trax_icache *icache;           /* [icaches] */
  uint32_t icaches;
  struct trax_tm_stats *stats;
  struct trax_tp_stats *tp_stats; /* [tps] */
  int32_t *exit_statuses;         /* [tps] */

  struct trax_store_buffer *buffer; /* in an epoch; else NULL */
  uint64_t now;                     /* the cycle that is being simulated */
  TRAX_TM_STATE(TRAX_FIELD, )
  struct trax_shared_unit unit[TRAX_SHARED_COUNT];
  struct trax_dcache dcache;
  struct trax_queue queue;
  struct trax_fault fault; /* of the current cycle, of the lowest TP with one */
};

trax_status trax_tm_create(struct trax_tm *tm, uint32_t number, struct trax_chip *chip, FILE *output,
                           trax_error *error);
void trax_tm_destroy(struct trax_tm *tm);

/* Charges sleeping TPs for the cycles before `t`, which are over. */
void trax_tm_settle(struct trax_tm *tm, uint64_t t);

/* Notifies an observer of a charge. */
static inline void trax_tm_notify_charge(const struct trax_tm *tm, unsigned tp, trax_cause cause, uint64_t since,
                                         uint64_t cycles) {
  if (__builtin_expect(tm->observer != NULL, false) && tm->observer->charge && cycles && cause != TRAX_CAUSE_ISSUED)
    tm->observer->charge(tm->observer->context, tm->number, tp, cause, since, cycles);
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
/* Returns the first cycle after t in which anything can happen in the TM. */
uint64_t trax_tm_next_cycle(const struct trax_tm *tm, uint64_t t);

/* Makes and counts a memory request; the queue must have a place. */
void trax_tm_request(struct trax_tm *tm, struct trax_request request);

#endif
