/* Observers: profiles, traces and time lines, which follow a run instruction by instruction. The engine notifies an
   observer of every thread-cycle exactly once, by `issue` if the cause is TRAX_CAUSE_ISSUED and by `charge` otherwise.
   So an observer's sums equal the statistics (docs/timing.md, "Accounting"). An observer of stretches (below) is
   notified of many instructions at once.

   An engine guarantees:
   - issue is called after the instruction's effect, in the order of (cycle, TM, TP) over the whole chip. It is not
     called for an instruction that faults.
   - A TP's charges are intervals of cycles without gaps or overlaps, in the order of time; those before an issue are
     reported before it. One interval may be reported in several pieces. When trax_run_settle(run, t) returns, all
     cycles before t have been reported.
   - The charges of different TPs may be reported in any order, which differs between engines.
   - arrival is called when an atomic increment's old value is written to its register, in the order of (cycle, TM),
     before the issues of the same cycle and TM.
   - All calls but those of `stretch` are made by the host thread that called trax_machine_run.

   A run without an observer pays nothing for this. With one, the fast engine executes ahead of time only if the
   observer takes stretches. */
#ifndef TRAX_MACHINE_OBSERVER_H
#define TRAX_MACHINE_OBSERVER_H

#include "machine/stats.h"
#include "trax/grow.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* The outcome of an access to global memory: bits of trax_issue.outcome. */
enum {
  TRAX_OUTCOME_HIT = 1,     /* a load or store through the data cache found its line */
  TRAX_OUTCOME_MISS = 2,    /* a load requested its line */
  TRAX_OUTCOME_MERGED = 4,  /* a load's line was already on its way */
  TRAX_OUTCOME_COMBINED = 8 /* a store was combined with the TP's earlier one */
};

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

/* --- stretches: instructions that a TP issued one after the other --- */

enum { TRAX_MOST_STRETCH = 128 /* instructions */ };

/* Neighbouring instructions of the program. `index`, here and below, is for the observer. */
struct trax_piece {
  uint32_t pc, count, index;
};

/* Charges and accesses name the instruction by its number in the stretch (`at`). A charge belongs to the instruction
   before whose issue it came. Neighbouring charges may have the same cause. They are small, since they are many. */
struct trax_charged {
  uint32_t index;
  uint32_t at : 8, cause : 5, rd : 5, cycles : 14;
};
enum { TRAX_MOST_CHARGED = (1 << 14) - 1 /* cycles */ };
_Static_assert(TRAX_CAUSE_COUNT <= 32 && TRAX_NUM_REGISTERS <= 32, "the bits of a charge suffice");

/* An access to global memory. */
struct trax_accessed {
  uint32_t address;
  uint8_t at, outcome;
};

enum { TRAX_STRETCH_ROOM = TRAX_MOST_STRETCH * (sizeof(struct trax_piece) + sizeof(struct trax_accessed)) };

/* An instruction's refusals in a byte; more are charges. */
enum { TRAX_REFUSED_SHIFT = 4, TRAX_MOST_REFUSED = (1 << TRAX_REFUSED_SHIFT) - 1 };
static inline unsigned trax_refused_fetch(uint8_t refused) {
  return refused & TRAX_MOST_REFUSED;
}
static inline unsigned trax_refused_others(uint8_t refused) {
  return refused >> TRAX_REFUSED_SHIFT;
}

/* A TP's charges since its latest stretch, except for those in trax_stretch.refused: the observer's memory, to which
   the engine adds. The observer removes the charges that belong to a stretch, and subtracts the stretch's instructions
   from the others' `at`. */
struct trax_thread_log {
  struct trax_charged *charged; /* [charged_count] */
  size_t charged_count, charged_capacity;
};

struct trax_stretch {
  uint64_t cycle;           /* not before those of the TM's earlier ones; of a single instruction: its issue */
  uint32_t tm, tp, count;   /* instructions */
  struct trax_piece *piece; /* [pieces] */
  size_t pieces;
  struct trax_accessed *accessed; /* [accessed_count] */
  size_t accessed_count;
  bool stores, misses; /* false: no access stores; all are TRAX_OUTCOME_HIT alone */
  /* [count], or NULL: cycles in which the instruction was refused the bank of the instruction cache, and then its unit
     or its bank of the data cache, as trax_refused_.... They follow the charges of the log. */
  const uint8_t *refused;
  /* After a trap, [TRAX_CAUSE_COUNT]: the thread's charges since the begin of the run, the trap included, as in
     trax_tp_stats; else NULL. */
  const uint64_t *cycles;
  uint32_t next_pc; /* of the last instruction */
  /* A trap's operand, or the value that an instruction writes to r2, the stack pointer. Such an instruction, a jalr,
     and a jal that writes a register each are a stretch of their own. */
  uint32_t result;
};

struct trax_pool;

struct trax_observer {
  void *context;
  /* Any function may be NULL. A run calls `begin` at its begin, with the threads of the host that the observer may use
     up to the last `end` (NULL: the caller's alone), and `end` whenever it stops, after the other calls. */
  void (*begin)(void *context, struct trax_pool *pool);
  void (*end)(void *context);
  void (*issue)(void *context, const struct trax_issue *issue);
  /* The TP was charged to `cause` for `cycles` cycles from `since` on. rd: the register that it waited for; 0: none. */
  void (*charge)(void *context, uint32_t tm, uint32_t tp, trax_cause cause, unsigned rd, uint64_t since,
                 uint64_t cycles);
  void (*arrival)(void *context, const struct trax_arrival *arrival);
  /* If not NULL, an engine that can calls it instead of all others, when the last instruction of a stretch issues, or
     earlier. The stretches of one TP are in order. Those that consist of one instruction that is to be alone, or of
     which `single` was set before, are in the order of issue() over the chip. At `end`, all instructions have been
     reported, and the logs have the charges since then. Several threads of the host may call it at the same time, each
     for other TMs; then the order over the chip is that of (cycle, TM). */
  void (*stretch)(void *context, const struct trax_stretch *stretch);
  /* For stretches: returns the observer's memory, TRAX_STRETCH_ROOM bytes, for the arrays of the TM's next one: its
     pieces, and its accesses directly behind them, so that they need not be copied. NULL: there is none. */
  void *(*room)(void *context, uint32_t tm);
  /* For stretches: the engine does not go back any more behind the present state. If it holds, it may come back to it,
     which it tells by `go_back`: then the stretches told since are not valid, nor what has been added to the logs. */
  void (*keep)(void *context, bool holds);
  void (*go_back)(void *context);
  struct trax_thread_log *logs; /* [threads]; for stretches */
  bool single; /* the observer wants stretches of one instruction from now on; set during `keep` or `stretch` */
  bool full;   /* it wants a call of `keep` soon; any thread may set it */
  bool lost;   /* a charge was not recorded: out of memory */
};

/* For engines: adds a charge before the instruction `at` to a log. */
static inline void trax_log_charge(struct trax_observer *observer, struct trax_thread_log *log, unsigned at,
                                   trax_cause cause, unsigned rd, uint64_t cycles) {
  for (uint64_t left = cycles, part; left; left -= part) {
    if (log->charged_count == log->charged_capacity &&
        !trax_grow((void **)&log->charged, log->charged_count, &log->charged_capacity, sizeof *log->charged)) {
      __atomic_store_n(&observer->lost, true, __ATOMIC_RELAXED);
      return;
    }
    part = left < TRAX_MOST_CHARGED ? left : TRAX_MOST_CHARGED;
    const struct trax_charged charged = {
        .at = at & 0xFF, .cause = cause & 31, .rd = rd & 31, .cycles = part & TRAX_MOST_CHARGED};
    memcpy(&log->charged[log->charged_count++], &charged, sizeof charged); /* at once, without a look at the log */
  }
}

#endif
