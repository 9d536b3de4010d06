/* A thread processor: registers, scoreboard, local memory, write-combining buffer, and the effects of its instructions.
   What it asks of others, and when, is in tm.c. */
#ifndef TRAX_FAST_TP_H
#define TRAX_FAST_TP_H

#include "machine/machine.h"
#include "machine/section.h"
#include "machine/text.h"
#include "machine/watch.h" /* TRAX_NEVER: also of a register that becomes usable with an arrival */

/* run_begin, run_end: the write-combining buffer, a run of bytes in one 64-byte block; empty if they are equal.
   asleep_...: a sleeping TP asks for nothing; it is charged when it wakes. */
#define TRAX_TP_STATE(X, S)                                                                                            \
  X(S, uint32_t, reg, [TRAX_NUM_REGISTERS + 1]) /* [TRAX_NO_REGISTER] swallows results for r0 */                       \
  X(S, uint32_t, pc, )                                                                                                 \
  X(S, uint32_t, address, )                             /* of the access that is being asked for */                    \
  X(S, uint16_t, writes, )                              /* in the memory queue */                                      \
  X(S, uint16_t, increments, )                          /* in the memory queue */                                      \
  X(S, uint64_t, usable, [TRAX_NUM_REGISTERS + 1])      /* cycle from which the register is usable */                  \
  X(S, uint8_t, usable_cause, [TRAX_NUM_REGISTERS + 1]) /* trax_cause of waiting for it */                             \
  X(S, uint8_t, asleep_cause, )                                                                                        \
  X(S, uint32_t, run_begin, )                                                                                          \
  X(S, uint32_t, run_end, )                                                                                            \
  X(S, uint64_t, asleep_since, )                                                                                       \
  X(S, uint64_t, asleep_until, ) /* of those in the wheel */                                                           \
  X(S, uint8_t, local, [TRAX_LOCAL_SIZE])
struct trax_tp {
  TRAX_TP_STATE(TRAX_FIELD, )
  const struct trax_decoded *inst; /* at pc; whether it is fetched says trax_tm.holding */
  uint8_t outcome;                 /* of the access: TRAX_OUTCOME_MISS ..., noted when it is served */
};

struct trax_tm;

/* The cause of the first register that inst must wait for in cycle t, in the order ra, rb, rd, of a fence r1 to r31,
   and in *until the cycle from which it is usable, TRAX_NEVER if unknown. TRAX_CAUSE_ISSUED if there is none. */
trax_cause trax_tp_wait(const struct trax_tp *tp, uint64_t t, uint64_t *until);

static inline void trax_tp_set_usable(struct trax_tp *tp, unsigned rd, uint64_t cycle, trax_cause cause) {
  tp->usable[rd] = cycle;
  tp->usable_cause[rd] = (uint8_t)cause;
}

/* What must be so for a store of `bytes` bytes to join the run in the buffer. */
bool trax_tp_combines(const struct trax_tp *tp, uint32_t address, uint32_t bytes);

/* What rdsr of special register `number` gives TP `tp` in cycle t. */
uint32_t trax_tp_special_register(const struct trax_tm *tm, unsigned tp, uint32_t number, uint64_t t);

/* Performs the instruction in cycle t: registers, pc, memory, host. Returns false if it faulted (abort, puts): the
   fault is recorded in the TM. Atomic increments only move on; the controller does the rest. */
bool trax_tp_execute(struct trax_tm *tm, unsigned number, uint64_t t);

#endif
