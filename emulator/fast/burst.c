/* Function, ahead of time. A burst ends before an instruction whose effect others can see or whose value depends on
   time: atomic increments, stores to global memory, loads from blocks that are written during the run, loads and stores
   past the cache, reads of the cycle counter, traps, ends of threads, and everything that faults. */
#include "fast/fast.h"
#include "trax/semantics.h"

#include <string.h>

static bool may_load_ahead(const struct trax_fast *fast, const struct trax_space *space, uint32_t address,
                           uint32_t bytes) {
  return address - TRAX_NULL_END < space->size - TRAX_NULL_END && !(address & (bytes - 1)) &&
         fast->blocks.state[address >> TRAX_BLOCK_SHIFT] != TRAX_BLOCK_WRITTEN;
}

static uint32_t special_register(const struct trax_tm *tm, unsigned tp, uint32_t number) {
  switch (number) {
  case TRAX_SR_THREAD:
    return tm->number * tm->tps + tp;
  case TRAX_SR_TM:
    return tm->number;
  case TRAX_SR_TP:
    return tp;
  case TRAX_SR_THREADS:
    return tm->config->chip.tms * tm->tps;
  }
  return 0; /* those that depend on time end a burst */
}

unsigned trax_fast_burst(struct trax_fast *fast, struct trax_fast_tm *ftm, unsigned number, unsigned limit) {
  struct trax_fast_tp *const ftp = &ftm->tp[number];
  struct trax_tp *const tp = &ftm->tm->tp[number];
  uint32_t *const reg = tp->reg;
  const struct trax_fast_inst *inst = ftp->resume;
  const struct trax_space *const space = &fast->chip->machine->space;
  const struct trax_config *const config = ftm->tm->config;
  uint32_t address, word;
  uint32_t pc = ftp->resume_pc;
  unsigned count = 0;
  ftp->undo_count = 0;

/* What the instructions' semantics are written in (isa/TraxInstructions.td). */
#define RD reg[inst->rd]
#define RA reg[inst->ra]
#define RB reg[inst->rb]
#define IMM ((uint32_t)inst->imm)
#define PC pc
#define NEXT_PC next_pc
#define LOAD(ADDRESS, BYTES)                                                                                           \
  (__extension__({                                                                                                     \
    address = (ADDRESS);                                                                                               \
    word = 0;                                                                                                          \
    if (address >= TRAX_LOCAL_BASE && !(address & (BYTES - 1))) {                                                      \
      memcpy(&word, tp->local + (address - TRAX_LOCAL_BASE), BYTES);                                                   \
      step->class = TRAX_CLASS_LOCAL_LOAD;                                                                             \
    } else if (may_load_ahead(fast, space, address, BYTES)) {                                                          \
      memcpy(&word, space->bytes + address, BYTES);                                                                    \
      fast->blocks.state[address >> TRAX_BLOCK_SHIFT] = TRAX_BLOCK_LOADED;                                             \
      step->rd = TRAX_NO_REGISTER;                                                                                     \
    } else {                                                                                                           \
      goto stop;                                                                                                       \
    }                                                                                                                  \
    step->address = address;                                                                                           \
    word;                                                                                                              \
  }))
#define STORE(ADDRESS, VALUE, BYTES)                                                                                   \
  do {                                                                                                                 \
    address = (ADDRESS);                                                                                               \
    if (address < TRAX_LOCAL_BASE || (address & (BYTES - 1)))                                                          \
      goto stop;                                                                                                       \
    struct trax_fast_undo *const undo = &ftp->undo[ftp->undo_count++];                                                 \
    undo->offset = (address - TRAX_LOCAL_BASE) & ~3u;                                                                  \
    memcpy(&undo->word, tp->local + undo->offset, sizeof undo->word);                                                  \
    word = (VALUE);                                                                                                    \
    memcpy(tp->local + (address - TRAX_LOCAL_BASE), &word, BYTES);                                                     \
    step->address = address;                                                                                           \
  } while (0)
#define LOAD8(ADDRESS) LOAD(ADDRESS, 1u)
#define LOAD16(ADDRESS) LOAD(ADDRESS, 2u)
#define LOAD32(ADDRESS) LOAD(ADDRESS, 4u)
#define STORE8(ADDRESS, VALUE) STORE(ADDRESS, VALUE, 1u)
#define STORE16(ADDRESS, VALUE) STORE(ADDRESS, VALUE, 2u)
#define STORE32(ADDRESS, VALUE) STORE(ADDRESS, VALUE, 4u)
#define ATOMIC_INC(ADDRESS)                                                                                            \
  (__extension__({                                                                                                     \
    (void)(ADDRESS);                                                                                                   \
    goto stop;                                                                                                         \
    0u;                                                                                                                \
  }))
#define SPECIAL_REGISTER(NUMBER) special_register(ftm->tm, number, NUMBER)
#define TRAP(VALUE, CODE) goto stop
#define HALT() goto stop
#define FPDIV(A, B) trax_reduce_precision(trax_fdiv(A, B), config->special.precision_bits)
#define ISQRT(A) trax_reduce_precision(trax_frsqrt(A), config->special.precision_bits)
  while (count < limit) {
    uint32_t next_pc = pc + 4;
    struct trax_fast_step *const step = &ftp->steps[count];
    *step = (struct trax_fast_step){.inst = inst, .class = inst->class, .rd = inst->rd};
    switch ((trax_op)inst->op) {
#define TRAX_SEMANTICS(NAME, ...)                                                                                      \
  case TRAX_OP_##NAME:                                                                                                 \
    __VA_ARGS__                                                                                                        \
    break;
#include "trax/semantics.inc"
#undef TRAX_SEMANTICS
    case TRAX_OP_ILLEGAL:
    case TRAX_OP_COUNT:
      goto stop;
    }
    count++;
    if (next_pc == pc + 4)
      inst++;
    else
      inst = trax_fast_inst_at(&fast->program, next_pc);
    pc = next_pc;
  }
stop:
  ftp->resume = inst;
  ftp->resume_pc = pc;
  return count;
}
