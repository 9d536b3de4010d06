/* The functional mode: what a program computes, without time. Threads take turns of TRAX_TURN instructions or a few
   more (a turn ends with a jump); within a turn every instruction takes effect at once. Caches, units, queues and the
   write-combining buffers do not exist, and the run has no length: cycles are 0, and of the counts only those made from
   the instructions executed are kept. `rdsr cycle` gives the number of instructions that the thread has executed. */
#include "functional/functional.h"

#include "machine/traps.h"
#include "trax/semantics.h"

#include <string.h>

enum { TRAX_TURN = 4096 };

struct instruction {
  const void *operation; /* where execute_turn() executes it */
  int32_t imm;
  uint8_t op, rd, ra, rb;
};

struct section {
  uint32_t begin, bytes;
  struct instruction *inst; /* [bytes / 4 + 1]; the last is outside */
};

struct text {
  struct section *sections; /* [count], in one array of instructions */
  size_t count;
  struct instruction *inst;
  const struct instruction *outside; /* the last */
};

struct trax_functional {
  struct trax_chip *chip;
  struct text text;
  size_t inst_count;
  int64_t **changes;  /* [tms][inst_count + 1] as in trax_fast_tm */
  uint64_t *executed; /* [threads] */
  int64_t *left;      /* [threads]: of their turns */
};

enum stop { STOP_TURN, STOP_SLOW };

static const struct instruction *inst_at(const struct text *text, uint32_t pc) {
  for (size_t i = 0; i < text->count && pc % 4 == 0; i++)
    if (pc - text->sections[i].begin < text->sections[i].bytes)
      return text->sections[i].inst + (pc - text->sections[i].begin) / 4;
  return text->outside;
}

#include "functional/functional_turn.h"

/* --- what execute_turn() leaves to the core --- */

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
  const uint64_t index = (uint64_t)(inst_at(&functional->text, tp->pc) - functional->text.inst);
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
  if (inst->is_nontemporal && tp->address < TRAX_LOCAL_BASE)
    ++*(inst->is_store ? &tm->stats->nontemporal_stores : &tm->stats->nontemporal_loads);
  ++*executed;
  functional->changes[tm->number][index]++;
  functional->changes[tm->number][index + 1]--;
  return true;
}

/* The thread's turn, longer or shorter by what the one before has left. False if it faulted. */
static bool take_turn(struct trax_functional *functional, struct trax_tm *tm, unsigned number, uint64_t *executed,
                      int64_t *left) {
  struct trax_tp *tp = &tm->tp[number];
  *left += TRAX_TURN;
  while (*left > 0 && !(tm->ended >> number & 1)) {
    const uint64_t before = *executed;
    const enum stop stop = execute_turn(functional, tm, tp, *left, executed, NULL);
    if (stop == STOP_SLOW && !execute_slowly(functional, tm, number, executed))
      return false;
    *left -= (int64_t)(*executed - before);
  }
  return true;
}

/* A turn of every thread. *instructions grows by what was executed. Also stops behind a thread that has executed
   `limit` instructions. */
static trax_status take_turns(struct trax_functional *functional, uint64_t limit, uint64_t *instructions) {
  const struct trax_chip *chip = functional->chip;
  for (uint32_t i = 0; i < chip->tms; i++) {
    struct trax_tm *tm = &chip->tm[i];
    for (unsigned number = 0; number < tm->tps; number++) {
      const size_t thread = (size_t)i * tm->tps + number;
      uint64_t *executed = &functional->executed[thread];
      const uint64_t before = *executed;
      if (!(tm->ended >> number & 1) && !take_turn(functional, tm, number, executed, &functional->left[thread]))
        return TRAX_FAULT;
      if (*executed >= limit)
        return TRAX_STUCK;
      *instructions += *executed - before;
    }
  }
  return TRAX_OK;
}

/* --- the mode --- */

trax_status trax_functional_run(struct trax_functional *functional, uint64_t limit,
                                bool (*stop)(void *context, uint64_t instructions), void *context) {
  uint64_t instructions = 0, before = 0;
  while (trax_chip_running(functional->chip)) {
    const trax_status status = take_turns(functional, limit, &instructions);
    if (status)
      return status;
    if (instructions - before >= 1000000) { /* not in every turn of a few threads */
      before = instructions;
      if (stop(context, instructions))
        return TRAX_INTERRUPTED;
    }
  }
  return TRAX_OK;
}

void trax_functional_collect(struct trax_functional *functional) {
  for (uint32_t i = 0; i < functional->chip->tms; i++) {
    uint64_t *const instructions = functional->chip->tm[i].stats->instructions;
    int64_t count = 0;
    for (size_t index = 0; index < functional->inst_count; index++) {
      count += functional->changes[i][index];
      instructions[functional->text.inst[index].op] += (uint64_t)count;
    }
    memset(functional->changes[i], 0, functional->inst_count * sizeof *functional->changes[i]);
  }
}

static bool is_slow(const struct trax_decoded *decoded) {
  return decoded->is_nontemporal || decoded->is_atomic || decoded->ask == TRAX_ASK_ILLEGAL ||
         decoded->ask == TRAX_ASK_OUTSIDE || decoded->ask == TRAX_ASK_FENCE || decoded->op == TRAX_OP_TRAP ||
         decoded->op == TRAX_OP_HALT;
}

static trax_status predecode(struct text *text, size_t total, const struct trax_text *from,
                             const void *const *operations, trax_error *error) {
  text->sections = calloc(from->count + 1, sizeof *text->sections);
  text->inst = calloc(total, sizeof *text->inst);
  if (!text->sections || !text->inst)
    return trax_fail(error, "out of memory for %zu instructions", total);
  struct instruction *inst = text->inst;
  for (size_t i = 0; i < from->count; i++) {
    const struct trax_text_section *section = &from->sections[i];
    const uint32_t words = (section->end - section->begin) / 4;
    text->sections[text->count++] = (struct section){section->begin, words * 4, inst};
    for (uint32_t word = 0; word <= words; word++) {
      const struct trax_decoded *decoded = &section->decoded[word];
      *inst++ = (struct instruction){operations[is_slow(decoded) ? TRAX_OP_ILLEGAL : decoded->op],
                                     decoded->imm,
                                     decoded->op,
                                     decoded->rd,
                                     decoded->ra,
                                     decoded->rb};
    }
  }
  *inst = (struct instruction){.operation = operations[TRAX_OP_ILLEGAL]};
  text->outside = inst;
  return TRAX_OK;
}

struct trax_functional *trax_functional_create(struct trax_chip *chip, trax_error *error) {
  struct trax_functional *functional = calloc(1, sizeof *functional);
  const void *const *operations;
  execute_turn(functional, NULL, NULL, 0, NULL, &operations);
  size_t total = 1;
  for (size_t i = 0; i < chip->text.count; i++)
    total += (chip->text.sections[i].end - chip->text.sections[i].begin) / 4 + 1;
  bool complete = functional != NULL;
  if (complete) {
    functional->chip = chip;
    functional->inst_count = total;
    functional->executed = calloc((size_t)chip->tms * chip->tm[0].tps, sizeof *functional->executed);
    functional->left = calloc((size_t)chip->tms * chip->tm[0].tps, sizeof *functional->left);
    functional->changes = calloc(chip->tms, sizeof *functional->changes);
    complete = functional->executed && functional->left && functional->changes;
  }
  for (uint32_t i = 0; complete && i < chip->tms; i++)
    complete = (functional->changes[i] = calloc(total + 1, sizeof **functional->changes)) != NULL;
  if (!complete)
    trax_fail(error, "out of memory for %zu instructions", total);
  if (complete && !predecode(&functional->text, total, &chip->text, operations, error))
    return functional;
  trax_functional_destroy(functional);
  return NULL;
}

void trax_functional_destroy(struct trax_functional *functional) {
  if (!functional)
    return;
  free(functional->text.sections);
  free(functional->text.inst);
  for (uint32_t i = 0; functional->changes && i < functional->chip->tms; i++)
    free(functional->changes[i]);
  free(functional->changes);
  free(functional->executed);
  free(functional->left);
  free(functional);
}
