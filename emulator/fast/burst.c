/* Function, ahead of time. A burst ends before an instruction whose effect others can see or whose value depends on
   time: atomic increments, stores to global memory, loads from blocks that are written during the run, loads and stores
   past the cache, reads of the cycle counter, traps, ends of threads, and everything that faults. */
#include "fast/fast.h"
#include "trax/semantics.h"

#include <string.h>

#define NOWHERE UINT64_MAX /* no pc */

static bool may_load_ahead(const struct trax_fast *fast, const struct trax_space *space, uint32_t address,
                           uint32_t bytes) {
  return address - TRAX_NULL_END < space->size - TRAX_NULL_END && !(address & (bytes - 1)) &&
         trax_fast_block_state(fast, address) != TRAX_BLOCK_WRITTEN;
}

static unsigned data_bank(const struct trax_fast_tm *ftm, uint32_t address) {
  const uint32_t banks = ftm->data_banks;
  return (banks & (banks - 1)) == 0 ? address / 4 & (banks - 1) : address / 4 % banks;
}

/* Bit line % 64 of the lines from one instruction to another. */
static uint64_t lines_of(const struct trax_fast_inst *first, const struct trax_fast_inst *last) {
  const unsigned count = (unsigned)(last->step.line - first->step.line), begin = first->step.line % 64u;
  const uint64_t lines = count < 63 ? ((uint64_t)2 << count) - 1 : ~(uint64_t)0;
  return begin ? lines << begin | lines >> (64 - begin) : lines;
}

unsigned trax_fast_burst(struct trax_fast *fast, struct trax_fast_tm *ftm, unsigned number, unsigned limit) {
  struct trax_fast_tp *const ftp = &ftm->tp[number];
  struct trax_tp *const tp = &ftm->tm->tp[number];
  uint32_t *const reg = tp->reg;
  const struct trax_fast_program *const program = &fast->program;
  const struct trax_fast_inst *inst = ftp->resume;
  const struct trax_space *const space = &fast->chip->machine->space;
  const struct trax_config *const config = ftm->tm->config;
  const uint16_t slow_local = config->tp.local_latency_cycles > 1 ? TRAX_ASKS_SLOWLY : 0;
  const uint16_t slow_jump = config->tp.branch_bubble_cycles > 0 ? TRAX_ASKS_SLOWLY : 0;
  struct trax_fast_step *step = ftp->steps;
  const struct trax_fast_step *const end = step + limit;
  uint32_t address, word, jumps = 0;
  uint64_t resume_pc = ftp->resume_pc; /* of the outside */
  int64_t *const changes = ftm->changes;
  const struct trax_fast_inst *run = inst; /* where the latest jump went */
  uint64_t lines = 0;
  ftp->undo_count = 0;
  changes[inst->step.index]++;

/* What the instructions' semantics are written in (isa/TraxInstructions.td). */
#define RD reg[inst->rd]
#define RA reg[inst->ra]
#define RB reg[inst->rb]
#define IMM ((uint32_t)inst->imm)
#define PC (program->pc[inst->step.index])
#define NEXT_PC next_pc
#define LOAD(ADDRESS, BYTES)                                                                                           \
  (__extension__({                                                                                                     \
    step->address = address = (ADDRESS);                                                                               \
    word = 0;                                                                                                          \
    if (address >= TRAX_LOCAL_BASE && !(address & (BYTES - 1))) {                                                      \
      memcpy(&word, tp->local + (address - TRAX_LOCAL_BASE), BYTES);                                                   \
      step->asks = slow_local;                                                                                         \
    } else if (may_load_ahead(fast, space, address, BYTES)) {                                                          \
      memcpy(&word, space->bytes + address, BYTES);                                                                    \
      trax_fast_block_loaded(fast, address);                                                                           \
      step->asks = (uint16_t)(step->asks | data_bank(ftm, address) << TRAX_ASKS_BANK_SHIFT);                           \
    } else {                                                                                                           \
      goto stop;                                                                                                       \
    }                                                                                                                  \
    word;                                                                                                              \
  }))
#define STORE(ADDRESS, VALUE, BYTES)                                                                                   \
  do {                                                                                                                 \
    step->address = address = (ADDRESS);                                                                               \
    if (address < TRAX_LOCAL_BASE || (address & (BYTES - 1)))                                                          \
      goto stop;                                                                                                       \
    struct trax_fast_undo *const undo = &ftp->undo[ftp->undo_count++];                                                 \
    undo->offset = (address - TRAX_LOCAL_BASE) & ~3u;                                                                  \
    memcpy(&undo->word, tp->local + undo->offset, sizeof undo->word);                                                  \
    word = (VALUE);                                                                                                    \
    memcpy(tp->local + (address - TRAX_LOCAL_BASE), &word, BYTES);                                                     \
  } while (0)
#define LOAD8(ADDRESS) LOAD(ADDRESS, 1u)
#define LOAD16(ADDRESS) LOAD(ADDRESS, 2u)
#define LOAD32(ADDRESS) LOAD(ADDRESS, 4u)
#define LOAD32_GLOBAL(ADDRESS) LOAD32(ADDRESS)
#define STORE8(ADDRESS, VALUE) STORE(ADDRESS, VALUE, 1u)
#define STORE16(ADDRESS, VALUE) STORE(ADDRESS, VALUE, 2u)
#define STORE32(ADDRESS, VALUE) STORE(ADDRESS, VALUE, 4u)
#define STORE32_GLOBAL(ADDRESS, VALUE) STORE32(ADDRESS, VALUE)
#define ATOMIC_INC(ADDRESS)                                                                                            \
  (__extension__({                                                                                                     \
    (void)(ADDRESS);                                                                                                   \
    goto stop;                                                                                                         \
    0u;                                                                                                                \
  }))
#define SPECIAL_REGISTER(NUMBER) trax_tp_special_register(ftm->tm, number, NUMBER, 0) /* the cycle ends a burst */
#define TRAP(VALUE, CODE) goto stop
#define HALT() goto stop
#define FPDIV(A, B) trax_reduce_precision(trax_fdiv(A, B), config->special.precision_bits)
#define ISQRT(A) trax_reduce_precision(trax_frsqrt(A), config->special.precision_bits)

  /* Each operation goes on to the next one by itself, which the host's branch predictor learns far better than one
     switch for all. */
  __extension__ static const void *const operations[] = {
#define TRAX_SEMANTICS(NAME, ...) [TRAX_OP_##NAME] = &&do_##NAME,
#include "trax/semantics.inc"
#undef TRAX_SEMANTICS
      [TRAX_OP_ILLEGAL] = &&stop};
#define GO_ON()                                                                                                        \
  do {                                                                                                                 \
    *step = inst->step;                                                                                                \
    __extension__({ goto *operations[inst->op]; });                                                                    \
  } while (0)

  if (step == end)
    goto stop;
  GO_ON();
#define TRAX_SEMANTICS(NAME, ...)                                                                                      \
  do_##NAME : {                                                                                                        \
    uint64_t next_pc = NOWHERE;                                                                                        \
    __VA_ARGS__                                                                                                        \
    if (next_pc != NOWHERE && (uint32_t)next_pc != PC + 4) {                                                           \
      jumps++;                                                                                                         \
      lines |= lines_of(run, inst);                                                                                    \
      changes[inst->step.index + 1]--;                                                                                 \
      step->asks |= slow_jump;                                                                                         \
      run = inst = trax_fast_inst_at(program, (uint32_t)next_pc);                                                      \
      resume_pc = next_pc;                                                                                             \
      changes[inst->step.index]++;                                                                                     \
    } else {                                                                                                           \
      inst++;                                                                                                          \
    }                                                                                                                  \
    if (++step == end)                                                                                                 \
      goto stop;                                                                                                       \
    GO_ON();                                                                                                           \
  }
#include "trax/semantics.inc"
#undef TRAX_SEMANTICS

stop:
  changes[inst->step.index]--;
  ftp->resume = inst;
  ftp->resume_pc = inst == program->outside ? (uint32_t)resume_pc : program->pc[inst->step.index];
  ftp->burst_jumps = jumps;
  ftp->burst_lines = lines | lines_of(run, inst);
  return (unsigned)(step - ftp->steps);
}
