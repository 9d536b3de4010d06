/* The functional mode: what a program computes, without time. Threads take turns of TRAX_TURN instructions or a few
   more (a turn ends with a jump); within a turn every instruction takes effect at once. Caches, units, queues and the
   write-combining buffers do not exist, and the run has no length: cycles are 0, and of the counts only those made from
   the instructions executed are kept. `rdsr cycle` gives the number of instructions that the thread has executed. */
#include "fast/functional.h"

#include "core/traps.h"
#include "trax/semantics.h"

#include <string.h>

enum { TRAX_TURN = 4096 };

struct instruction {
  const void *operation; /* where function() executes it */
  int32_t imm;
  uint8_t op, rd, ra, rb;
};

struct section {
  uint32_t begin, bytes;
  struct instruction *inst; /* [bytes / 4 + 1]; the last is outside */
};

struct trax_functional {
  struct trax_chip *chip;
  struct section *sections; /* [count], in one array of instructions */
  size_t count, inst_count;
  struct instruction *inst;
  const struct instruction *outside; /* the last */
  int64_t *changes;                  /* [inst_count + 1] as in trax_fast_tm, for all TMs */
  uint64_t *executed;                /* [threads] */
};

enum stop { STOP_TURN, STOP_SLOW };

static const struct instruction *inst_at(const struct trax_functional *functional, uint32_t pc) {
  for (size_t i = 0; i < functional->count && pc % 4 == 0; i++)
    if (pc - functional->sections[i].begin < functional->sections[i].bytes)
      return functional->sections[i].inst + (pc - functional->sections[i].begin) / 4;
  return functional->outside;
}

/* Executes the TP's instructions from tp->pc on until its turn is over, or the next one is for execute_slowly. Without
   a TP: *operations receives the places of all operations. */
static enum stop function(struct trax_functional *functional, const struct trax_tm *tm, struct trax_tp *tp,
                          uint64_t *executed, const void *const **operations) {
  __extension__ static const void *const places[] = {
#define TRAX_SEMANTICS(NAME, ...) [TRAX_OP_##NAME] = &&do_##NAME,
#include "trax/semantics.inc"
#undef TRAX_SEMANTICS
      [TRAX_OP_ILLEGAL] = &&slow};
  if (!tp) {
    *operations = places;
    return STOP_TURN;
  }
  const struct trax_space *const space = &functional->chip->machine->space;
  const uint64_t accessible = space->size - TRAX_NULL_END;
  const unsigned bits = tm->config->special.precision_bits;
  const unsigned number = (unsigned)(tp - tm->tp);
  uint32_t *const reg = tp->reg;
  uint8_t *const local = tp->local;
  int64_t *const changes = functional->changes;
  const struct instruction *const base = functional->inst;
  const struct section *const first = functional->sections;
  const struct instruction *inst = inst_at(functional, tp->pc), *begin = inst;
  const uint64_t end = *executed + TRAX_TURN;
  uint64_t count = *executed;
  uint32_t address, word, pc = tp->pc;
  if (inst == functional->outside)
    return STOP_SLOW;
  changes[inst - base]++;
  __extension__({ goto * inst->operation; });

/* The pc of an instruction of the section in which the thread is; pc is that of the last jump's target. */
#define HERE (pc + (uint32_t)(inst - begin) * 4)
#define RD reg[inst->rd]
#define RA reg[inst->ra]
#define RB reg[inst->rb]
#define IMM ((uint32_t)inst->imm)
#define PC HERE
#define NEXT_PC next_pc
#define LOAD(ADDRESS, BYTES)                                                                                           \
  (__extension__({                                                                                                     \
    address = (ADDRESS);                                                                                               \
    word = 0;                                                                                                          \
    if (address & (BYTES - 1))                                                                                         \
      goto slow;                                                                                                       \
    if (address - TRAX_NULL_END < accessible)                                                                          \
      memcpy(&word, space->bytes + address, BYTES);                                                                    \
    else if (address >= TRAX_LOCAL_BASE)                                                                               \
      memcpy(&word, local + (address - TRAX_LOCAL_BASE), BYTES);                                                       \
    else                                                                                                               \
      goto slow;                                                                                                       \
    word;                                                                                                              \
  }))
#define STORE(ADDRESS, VALUE, BYTES)                                                                                   \
  do {                                                                                                                 \
    address = (ADDRESS);                                                                                               \
    word = (VALUE);                                                                                                    \
    if (address & (BYTES - 1))                                                                                         \
      goto slow;                                                                                                       \
    if (address >= TRAX_LOCAL_BASE)                                                                                    \
      memcpy(local + (address - TRAX_LOCAL_BASE), &word, BYTES);                                                       \
    else if (address - TRAX_NULL_END < accessible &&                                                                   \
             !(space->restrictions[address / TRAX_GRANULE] & TRAX_RESTRICT_WRITE))                                     \
      memcpy(space->bytes + address, &word, BYTES);                                                                    \
    else                                                                                                               \
      goto slow;                                                                                                       \
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
    goto slow;                                                                                                         \
    0u;                                                                                                                \
  }))
#define SPECIAL_REGISTER(NUMBER) trax_tp_special_register(tm, number, NUMBER, count + (uint64_t)(inst - begin))
#define TRAP(VALUE, CODE) goto slow
#define HALT() goto slow
#define FPDIV(A, B) trax_reduce_precision(trax_fdiv(A, B), bits)
#define ISQRT(A) trax_reduce_precision(trax_frsqrt(A), bits)
#define NOWHERE UINT64_MAX
#define TRAX_SEMANTICS(NAME, ...)                                                                                      \
  do_##NAME : {                                                                                                        \
    uint64_t next_pc = NOWHERE;                                                                                        \
    __VA_ARGS__                                                                                                        \
    if (next_pc != NOWHERE) {                                                                                          \
      changes[inst + 1 - base]--;                                                                                      \
      count += (uint64_t)(inst + 1 - begin);                                                                           \
      pc = (uint32_t)next_pc;                                                                                          \
      begin = inst = pc % 4 == 0 && pc - first->begin < first->bytes ? first->inst + (pc - first->begin) / 4           \
                                                                     : inst_at(functional, pc);                        \
      if (count >= end || inst == functional->outside)                                                                 \
        goto jumped;                                                                                                   \
      changes[inst - base]++;                                                                                          \
    } else {                                                                                                           \
      inst++;                                                                                                          \
    }                                                                                                                  \
    __extension__({ goto * inst->operation; });                                                                        \
  }
#include "trax/semantics.inc"
#undef TRAX_SEMANTICS

slow:
  changes[inst - base]--;
  pc = HERE;
  count += (uint64_t)(inst - begin);
  *executed = count;
  tp->pc = pc;
  return STOP_SLOW;

jumped:
  *executed = count;
  tp->pc = pc;
  return inst == functional->outside ? STOP_SLOW : STOP_TURN;
}

/* --- what function() leaves to the core --- */

static void increment(struct trax_functional *functional, struct trax_tp *tp) {
  uint8_t *const place = functional->chip->machine->space.bytes + tp->address;
  uint32_t value;
  memcpy(&value, place, sizeof value);
  tp->reg[tp->inst->rd] = value++;
  memcpy(place, &value, sizeof value);
}

/* One instruction, at tp->pc. False if it faulted. */
static bool execute_slowly(struct trax_functional *functional, struct trax_tm *tm, unsigned number,
                           uint64_t *executed) {
  struct trax_tp *tp = &tm->tp[number];
  const uint64_t index = (uint64_t)(inst_at(functional, tp->pc) - functional->inst);
  const struct trax_decoded *inst = tp->inst = trax_text_at(tm->text, tp->pc);
  trax_fault_kind kind = TRAX_FAULT_NONE;
  uint32_t address = 0;
  if (inst->ask == TRAX_ASK_OUTSIDE) {
    kind = tp->pc % 4 ? TRAX_FAULT_MISALIGNED_PC : TRAX_FAULT_EXECUTE;
    address = tp->pc;
  } else if (inst->ask == TRAX_ASK_ILLEGAL) {
    kind = TRAX_FAULT_ILLEGAL;
  } else if (inst->ask == TRAX_ASK_MEMORY) {
    address = tp->address = tp->reg[inst->ra] + (uint32_t)inst->imm;
    kind = trax_tp_check_access(tp, &functional->chip->machine->space, address);
  }
  if (kind) {
    trax_tm_fault(tm, number, *executed, kind, address);
    return false;
  }
  if (inst->is_atomic)
    increment(functional, tp);
  if (!trax_tp_execute(tm, number, *executed))
    return false;
  ++*executed;
  functional->changes[index]++;
  functional->changes[index + 1]--;
  return true;
}

/* The thread's turn. False if it faulted. */
static bool take_turn(struct trax_functional *functional, struct trax_tm *tm, unsigned number, uint64_t *executed) {
  struct trax_tp *tp = &tm->tp[number];
  const uint64_t end = *executed + TRAX_TURN;
  while (*executed < end && !(tm->ended >> number & 1)) {
    if (function(functional, tm, tp, executed, NULL) == STOP_TURN)
      return true;
    if (!execute_slowly(functional, tm, number, executed))
      return false;
  }
  return true;
}

/* --- the mode --- */

trax_status trax_functional_run(struct trax_functional *functional, uint64_t limit,
                                bool (*stop)(void *context, uint64_t instructions), void *context) {
  struct trax_chip *chip = functional->chip;
  uint64_t before = 0;
  while (trax_chip_running(chip)) {
    uint64_t instructions = 0;
    for (uint32_t i = 0; i < chip->tms; i++) {
      struct trax_tm *tm = &chip->tm[i];
      for (unsigned number = 0; number < tm->tps; number++) {
        uint64_t *executed = &functional->executed[(size_t)i * tm->tps + number];
        if (!(tm->ended >> number & 1) && !take_turn(functional, tm, number, executed))
          return TRAX_FAULT;
        if (*executed >= limit)
          return TRAX_STUCK;
        instructions += *executed;
      }
    }
    if (instructions - before >= 1000000) { /* not in every turn of a few threads */
      before = instructions;
      if (stop(context, instructions))
        return TRAX_INTERRUPTED;
    }
  }
  return TRAX_OK;
}

void trax_functional_collect(struct trax_functional *functional) {
  uint64_t *const instructions = functional->chip->tm[0].stats->instructions;
  int64_t count = 0;
  for (size_t i = 0; i < functional->inst_count; i++) {
    count += functional->changes[i];
    instructions[functional->inst[i].op] += (uint64_t)count;
  }
  memset(functional->changes, 0, functional->inst_count * sizeof *functional->changes);
}

static bool is_slow(const struct trax_decoded *decoded) {
  return decoded->is_nontemporal || decoded->is_atomic || decoded->ask == TRAX_ASK_ILLEGAL ||
         decoded->ask == TRAX_ASK_OUTSIDE || decoded->op == TRAX_OP_TRAP || decoded->op == TRAX_OP_HALT;
}

static trax_status predecode(struct trax_functional *functional, const struct trax_text *text, trax_error *error) {
  const void *const *operations;
  function(functional, NULL, NULL, NULL, &operations);
  size_t total = 1;
  for (size_t i = 0; i < text->count; i++)
    total += (text->sections[i].end - text->sections[i].begin) / 4 + 1;
  functional->inst_count = total;
  functional->sections = calloc(text->count + 1, sizeof *functional->sections);
  functional->inst = calloc(total, sizeof *functional->inst);
  functional->changes = calloc(total + 1, sizeof *functional->changes);
  if (!functional->sections || !functional->inst || !functional->changes)
    return trax_fail(error, "out of memory for %zu instructions", total);
  struct instruction *inst = functional->inst;
  for (size_t i = 0; i < text->count; i++) {
    const struct trax_text_section *section = &text->sections[i];
    const uint32_t words = (section->end - section->begin) / 4;
    functional->sections[functional->count++] = (struct section){section->begin, words * 4, inst};
    for (uint32_t word = 0; word <= words; word++) {
      const struct trax_decoded *from = &section->decoded[word];
      *inst++ = (struct instruction){
          operations[is_slow(from) ? TRAX_OP_ILLEGAL : from->op], from->imm, from->op, from->rd, from->ra, from->rb};
    }
  }
  *inst = (struct instruction){.operation = operations[TRAX_OP_ILLEGAL]};
  functional->outside = inst;
  return TRAX_OK;
}

trax_status trax_functional_create(struct trax_chip *chip, trax_error *error) {
  struct trax_functional *functional = chip->functional = calloc(1, sizeof *functional);
  if (!functional)
    return trax_fail(error, "out of memory");
  functional->chip = chip;
  functional->executed = calloc((size_t)chip->tms * chip->tm[0].tps, sizeof *functional->executed);
  if (!functional->executed)
    return trax_fail(error, "out of memory");
  return predecode(functional, &chip->text, error);
}

void trax_functional_destroy(struct trax_functional *functional) {
  if (!functional)
    return;
  free(functional->sections);
  free(functional->inst);
  free(functional->changes);
  free(functional->executed);
  free(functional);
}
