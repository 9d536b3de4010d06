/* The fast engine (docs/fast-engine.md has its words): it gives the cycles, counts and bytes of emulator/reference.
   function/ executes instructions before their time, time/ simulates their timing on masks of a TM's TPs, tm/ and
   memory/ the rare events one by one. A TM accesses data of another TM only through blocks.c and the memory controller.
   Epochs and threads are above these folders. */
#ifndef TRAX_FAST_CHIP_H
#define TRAX_FAST_CHIP_H

#include "engine/run.h"
#include "fast/function/blocks.h"
#include "fast/memory/memory.h"
#include "fast/tm/tm.h"
#include "translate/translate.h"

/* The part of the engine that works on vectors of TPs, time/cycle.c. It is compiled for every host and for x86-64-v3.
   x86-64-v4 gains nothing (docs/results/performance.md). */
struct trax_fast_variant {
  /* Simulates a cycle of a TM, arrivals included, and sets its next_cycle. */
  void (*cycle)(struct trax_tm *tm, uint64_t t);
  /* Simulates a quantum of a TM (epochs.c): all cycles before `end`, or up to one in which it stops or faults. */
  void (*run_quantum)(struct trax_tm *tm, uint64_t end);
};
extern const struct trax_fast_variant trax_fast_variant, trax_fast_variant_v3; /* _v3: if TRAX_FAST_HAVE_AVX2 */

struct trax_chip {
  struct trax_machine *machine;
  const struct trax_text *text; /* the run's */
  struct trax_tm *tm;           /* [tms] */
  struct trax_tp *tp;           /* [tms * TPs of a TM] */
  uint32_t tms;
  bool is_large; /* the TPs do not fit in the host's caches */
  struct trax_memory memory;
  struct trax_transfer_log transfers; /* no roll back changes it */
  const struct trax_fast_variant *variant;
  struct trax_fast_program program;
  struct trax_fast_blocks blocks;
  struct trax_burst_facts facts;
  struct trax_translation *translation; /* of bursts; NULL: all are interpreted */
  unsigned burst; /* limit of a burst's instructions; 1 with an observer that must see the state at each issue */
  /* One thread is left, and no increment is under way: nobody else accesses memory, so that bursts may store. */
  bool alone;
  struct trax_epochs *epochs; /* if its TMs run ahead of each other; else NULL */
  /* For the report, if there are several TMs: cycles outside epochs, and of these before a stop; epochs given up. */
  uint64_t single_cycles, short_epochs, conflicts;
  uint64_t end; /* when all threads have ended: the cycle in which the last transfer is over; else 0 */
};

/* Returns the number of threads that have not ended. */
static inline uint32_t trax_chip_running(const struct trax_chip *chip) {
  uint32_t running = 0;
  for (uint32_t i = 0; i < chip->tms; i++)
    running += chip->tm[i].running;
  return running;
}

trax_status trax_chip_create(struct trax_run *run, const struct trax_fast_variant *variant, trax_error *error);
void trax_chip_destroy(void *chip); /* may be NULL */

/* Adds the instructions executed since the latest call to the TMs' statistics, with those that have not been issued. */
void trax_fast_collect(void *chip);
/* Completes statistics and charges for the cycles that are over. */
void trax_fast_settle(struct trax_chip *chip);
/* Charges the refusals that have been counted, and begins counting them anew. */
void trax_fast_charge_refusals(struct trax_tm *tm);
/* Sets charges, [TRAX_CAUSE_COUNT], to those of a TP that is awake or has been settled, for the cycles that are over.
 */
void trax_fast_read_charges(const struct trax_tm *tm, unsigned number, uint64_t *charges);
/* With trax_tm.ray_counts: counts the cycles of rays after the issue of a trap, and up to now, for a TM that has been
   settled. */
void trax_fast_count_rays(struct trax_tm *tm, unsigned number, int32_t code, uint32_t value);
void trax_fast_settle_rays(struct trax_tm *tm);
/* The causes of refusals, in the order of struct trax_fast_refused. */
extern const trax_cause trax_fast_refusal_causes[TRAX_FAST_REFUSALS];
/* Notifies an observer, which is none of stretches, of the refusals of the current cycle. */
void trax_fast_notify_refusals(struct trax_tm *tm, const struct trax_fast_refused *refused);
/* Calls the observer's `keep`, if it has one. */
void trax_fast_keep(struct trax_chip *chip, bool holds);
/* For an observer of stretches: logs the refusals of some TPs' heads; records the outcomes of accesses by TPs that
   issue in this cycle, `issued`; tells the observer of the instruction at pc, which was executed at issue; of the steps
   before `end` of the current burst, of which it does not know yet; of those that were issued; of these before the TP
   rolls back to them, which may be in the cycle of the head's issue. */
void trax_fast_log_refusals(struct trax_tm *tm, uint64_t tps);
void trax_fast_record_outcomes(struct trax_tm *tm, uint64_t issued);
void trax_fast_tell_single(struct trax_tm *tm, unsigned number, uint32_t pc, const struct trax_decoded *inst);
void trax_fast_tell_steps(struct trax_tm *tm, unsigned number, unsigned end, uint32_t next_pc);
void trax_fast_tell_issued(struct trax_tm *tm, unsigned number);
void trax_fast_tell_before(struct trax_tm *tm, unsigned number);
/* The number of the TP's head in its next stretch. */
static inline unsigned trax_fast_next_of_stretch(const struct trax_tm *tm, unsigned tp) {
  return tm->heads.at[tp] - (unsigned)tm->observed->told[tp];
}

/* Simulates cycles from t on, before `end`, of a TM in which one TP is awake, as long as it issues a step in each, or
   until it makes a request, in the last of them. Requires that no transfer starts before `end`. False: there are no
   such cycles; else `now` is the last one, and next_cycle is set. */
bool trax_fast_run_alone(struct trax_tm *tm, uint64_t t, uint64_t end);

/* Continues the run before cycle t, after a roll back of all TPs (blocks.h), with the state in the structures. */
void trax_fast_import(struct trax_chip *chip, uint64_t t);

/* Creates chip->epochs (epochs.c), which stays NULL for one TM, with an observer that cannot go back, and if epochs
   would be too short. The threads are the run's. */
trax_status trax_epochs_create(struct trax_chip *chip, struct trax_run *run, trax_error *error);
void trax_epochs_destroy(struct trax_epochs *epochs);
/* Simulates an epoch from cycle *t on that ends in cycle `until` at the latest. Sets *t to the next cycle, which is an
   earlier one after a roll back. False: the next cycle must be simulated without an epoch. */
bool trax_epochs_advance(struct trax_epochs *epochs, uint64_t *t, uint64_t until);
/* Gives up the snapshot: the chip never rolls back beyond the current cycle, whose state a watch has seen. */
void trax_epochs_commit(struct trax_epochs *epochs);

/* Visits all that changes during a run, except global memory, as sections (machine/section.h), for rollback and for
   checkpoints, in an order that depends on the configuration alone. What follows from the rest between cycles
   (import.c) has no fields. */
void trax_state_visit(void *chip, trax_section_visitor *visit, void *context);
/* Checks that a state's indices are within bounds, so that the run stays within its structures. Returns NULL, or the
   reason of the refusal, in `text`. */
const char *trax_state_check(void *chip, uint64_t t, char text[128]);

/* The engine with the best variant that the host can run, and that with the variant for any host. */
extern const struct trax_engine trax_fast_engine, trax_fast_any_engine;
/* The best variant without translation, and, for tests, with all of it at once. */
extern const struct trax_engine trax_fast_interpreted_engine, trax_fast_translated_engine;

#endif
