/* A thread processor: registers, scoreboard, local memory, write-combining buffer, and the effects of its instructions.
   tm.c has what it needs of the TM. */
#ifndef TRAX_FAST_TP_H
#define TRAX_FAST_TP_H

#include "fast/function/program.h"
#include "machine/machine.h"
#include "machine/section.h"
#include "machine/text.h"
#include "machine/watch.h" /* TRAX_NEVER: also of a register that becomes usable with an arrival */
#include "translate/burst.h"

/* run_begin, run_end: the run of bytes in the write-combining buffer, within one 64-byte block; equal: empty.
   asleep_...: a sleeping TP is charged when it wakes. */
#define TRAX_TP_STATE(X, S)                                                                                            \
  X(S, uint32_t, reg, [TRAX_NUM_REGISTERS + 1]) /* results for r0 go to [TRAX_NO_REGISTER] */                          \
  X(S, uint32_t, pc, )                                                                                                 \
  X(S, uint32_t, address, )                             /* of inst's access */                                         \
  X(S, uint16_t, writes, )                              /* the TP's writes in the memory queue */                      \
  X(S, uint16_t, increments, )                          /* the TP's atomic increments in the memory queue */           \
  X(S, uint64_t, usable, [TRAX_NUM_REGISTERS + 1])      /* the cycle from which the register is usable */              \
  X(S, uint8_t, usable_cause, [TRAX_NUM_REGISTERS + 1]) /* trax_cause of a wait for it */                              \
  X(S, uint8_t, asleep_cause, )                                                                                        \
  X(S, uint32_t, run_begin, )                                                                                          \
  X(S, uint32_t, run_end, )                                                                                            \
  X(S, uint64_t, asleep_since, )                                                                                       \
  X(S, uint64_t, asleep_until, ) /* if it is in the wheel */                                                           \
  X(S, uint8_t, local, [TRAX_LOCAL_SIZE])
struct trax_tp {
  TRAX_TP_STATE(TRAX_FIELD, )
  const struct trax_decoded *inst; /* the instruction at pc; trax_tm.holding: it has been fetched */
  uint8_t outcome;                 /* of its access, set when it is served: TRAX_OUTCOME_MISS ... */

  /* Its burst (docs/fast-engine.md). */
  uint32_t resume_pc;
  const struct trax_fast_inst *resume; /* the first instruction of the next burst, at resume_pc */
  uint64_t atomics;                    /* mask of registers that atomic increments under way will write */

  uint64_t issued, jumps; /* instructions and taken jumps that were issued in earlier bursts */
  bool ends_slowly;       /* the last step of the current burst is slow even if another one followed */
  bool alone;             /* the current burst has stored to global memory (trax_chip.alone) */
  bool again;             /* the issued part of the burst is executed again, after a roll back */
  uint64_t stored;        /* words of stores that take effect at their issue, as bits of trax_fast_word_bit */
  uint64_t stores[2];     /* bits of burst.access: these stores, or those that a thread that is alone has made */

  /* The state at the beginning of the burst, for a roll back (blocks.c). */
  const struct trax_fast_inst *begin;
  uint32_t begin_reg[TRAX_NUM_REGISTERS + 1];
  struct trax_burst burst; /* or the step of a head that executes at issue */
};

struct trax_tm;

/* Returns the cause of the first register that inst must wait for in cycle t, in the order ra, rb, rd, for a fence r1
   to r31, and sets *rd to it and *until to the cycle from which it is usable, TRAX_NEVER if unknown. TRAX_CAUSE_ISSUED:
   there is none. */
trax_cause trax_tp_wait(const struct trax_tp *tp, uint64_t t, uint64_t *until, unsigned *rd);

static inline void trax_tp_set_usable(struct trax_tp *tp, unsigned rd, uint64_t cycle, trax_cause cause) {
  tp->usable[rd] = cycle;
  tp->usable_cause[rd] = (uint8_t)cause;
}

/* Combines a store of `bytes` bytes with the run in the buffer. False: it does not combine. */
static inline bool trax_tp_combine(struct trax_tp *tp, uint32_t address, uint32_t bytes) {
  enum { COMBINING_BLOCK = 64 };
  if (tp->run_begin == tp->run_end || address / COMBINING_BLOCK != tp->run_begin / COMBINING_BLOCK ||
      address > tp->run_end || address + bytes < tp->run_begin)
    return false;
  tp->run_begin = address < tp->run_begin ? address : tp->run_begin;
  tp->run_end = address + bytes > tp->run_end ? address + bytes : tp->run_end;
  return true;
}

/* Whether access `load` of the TP's burst is a store that takes effect at its issue. */
static inline bool trax_tp_stores(const struct trax_tp *tp, unsigned load) {
  return tp->stored && tp->stores[load / 64] >> load % 64 & 1;
}

/* Returns special register `number` of TP `tp` in cycle t. */
uint32_t trax_tp_special_register(const struct trax_tm *tm, unsigned tp, uint32_t number, uint64_t t);

/* Performs the instruction in cycle t: registers, pc, memory, traps. False: it faulted (abort, puts), and the fault is
   recorded in the TM. Of an atomic increment it only changes the pc; the controller performs the increment. */
bool trax_tp_execute(struct trax_tm *tm, unsigned number, uint64_t t);

#endif
