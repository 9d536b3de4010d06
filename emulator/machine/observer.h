/* Observers: profiles, traces and time lines, which follow a run instruction by instruction. The engine notifies an
   observer of every thread-cycle exactly once, by `issue` if the cause is TRAX_CAUSE_ISSUED and by `charge` otherwise.
   So an observer's sums equal the statistics (docs/timing.md, "Accounting").

   An engine guarantees:
   - issue is called after the instruction's effect, in the order of (cycle, TM, TP) over the whole chip. It is not
     called for an instruction that faults.
   - A TP's charges are intervals of cycles without gaps or overlaps, in the order of time; those before an issue are
     reported before it. One interval may be reported in several pieces. When trax_run_settle(run, t) returns, all
     cycles before t have been reported.
   - The charges of different TPs may be reported in any order, which differs between engines.
   - arrival is called when an atomic increment's old value is written to its register, in the order of (cycle, TM),
     before the issues of the same cycle and TM.
   - All calls are made by the host thread that called trax_machine_run.

   A run without an observer pays nothing for this. With one, the fast engine executes ahead of time only if the
   observer needs few values (`ahead`). */
#ifndef TRAX_MACHINE_OBSERVER_H
#define TRAX_MACHINE_OBSERVER_H

#include "machine/stats.h"

#include <stdbool.h>
#include <stdint.h>

/* The outcome of an access to global memory: bits of trax_issue.outcome. */
enum {
  TRAX_OUTCOME_HIT = 1,     /* a load or store through the data cache found its line */
  TRAX_OUTCOME_MISS = 2,    /* a load requested its line */
  TRAX_OUTCOME_MERGED = 4,  /* a load's line was already on its way */
  TRAX_OUTCOME_COMBINED = 8 /* a store was combined with the TP's earlier one */
};

enum { TRAX_STACK_POINTER = 2 };

struct trax_issue {
  uint64_t cycle;
  uint32_t tm, tp, pc;
  uint32_t next_pc;
  uint32_t word;
  uint32_t result;  /* the new value of the destination register (of an atomic increment: see arrival); of a store the
                       value stored, of a trap its operand */
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
  /* It needs no `result` but those of traps and of writes of r2, the stack pointer, and of an access to local memory
     only that it is one: the address may be TRAX_LOCAL_BASE. Then an engine is faster. */
  bool ahead;
  /* Any function may be NULL. */
  void (*issue)(void *context, const struct trax_issue *issue);
  /* The TP was charged to `cause` for `cycles` cycles from `since` on. rd: the register that it waited for; 0: none. */
  void (*charge)(void *context, uint32_t tm, uint32_t tp, trax_cause cause, unsigned rd, uint64_t since,
                 uint64_t cycles);
  void (*arrival)(void *context, const struct trax_arrival *arrival);
};

#endif
