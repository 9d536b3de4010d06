/* Those who watch a run instruction by instruction: profiles, traces, time lines. Every thread-cycle is told exactly
   once, by `issue` if the cause is TRAX_CAUSE_ISSUED and else by `charge`, so that what an observer adds up equals the
   statistics (docs/timing.md, "Accounting").

   What an engine promises:
   - issue comes after the instruction's effect, in the order of (cycle, TM, TP) over the whole chip; for an instruction
     that faults it does not come.
   - A TP's charges are stretches of cycles without gaps or overlaps, and come in the order of time: those before an
     issue come before it, those after it later. One stretch may come in several pieces. All that happened before cycle
     t has been told when trax_run_settle(run, t) returns, hence at the run's end.
   - The charges of different TPs come in any order; who wants the same from every engine acts on issues.
   - arrival comes when an atomic increment's old value is written to its register: in the order of (cycle, TM), and
     before the issues of its cycle in its TM.
   - All calls come from the thread that called trax_machine_run.

   A run that nobody observes pays nothing for this; one that is observed does not run ahead. */
#ifndef TRAX_MACHINE_OBSERVER_H
#define TRAX_MACHINE_OBSERVER_H

#include "machine/stats.h"

#include <stdint.h>

/* What became of an access to global memory: bits of trax_issue.outcome. */
enum {
  TRAX_OUTCOME_HIT = 1,     /* the line was there: of a load or a store through the data cache */
  TRAX_OUTCOME_MISS = 2,    /* the load requested its line */
  TRAX_OUTCOME_MERGED = 4,  /* the line was on its way */
  TRAX_OUTCOME_COMBINED = 8 /* the store joined the TP's earlier one */
};

struct trax_issue {
  uint64_t cycle;
  uint32_t tm, tp, pc;
  uint32_t next_pc;
  uint32_t word;
  uint32_t result;  /* the destination's new value, if it has one (of an atomic increment: see arrival); of a store what
                       is stored, of a trap its operand */
  uint32_t address; /* of a memory access */
  uint8_t outcome;
};

struct trax_arrival {
  uint64_t cycle;
  uint32_t tm, tp, rd;
  uint32_t value;
};

struct trax_observer {
  void *context;
  /* Any of them may be NULL. */
  void (*issue)(void *context, const struct trax_issue *issue);
  /* The TP was charged to `cause` in the cycles from `since` on. */
  void (*charge)(void *context, uint32_t tm, uint32_t tp, trax_cause cause, uint64_t since, uint64_t cycles);
  void (*arrival)(void *context, const struct trax_arrival *arrival);
};

#endif
