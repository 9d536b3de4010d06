/* The functional engine computes a program's results without simulating time. It runs one thread after the other for a
   slice of SLICE instructions or a few more, since a slice ends with a jump. Every instruction takes effect at once.
   There are no caches, units, queues and write-combining buffers. A run has 0 cycles, and only counts that follow from
   the instructions executed are kept. `rdsr cycle` returns the number of instructions that the thread has executed. */
#include "functional/functional.h"

#include "engine/run.h"
#include "machine/traps.h"
#include "translate/translate.h"
#include "trax/semantics.h"

#include <stdlib.h>
#include <string.h>

enum {
  SLICE = 4096,           /* instructions of a slice */
  INSTRUCTIONS = 1000000, /* of all threads, in one call of advance */
  COLD = 200000           /* instructions of all threads before any are translated: short runs do not pay for it */
};

struct instruction {
  const void *operation; /* the label in run_slice that executes it */
  int32_t imm;
  uint8_t op, rd, ra, rb;
};

struct segment {
  uint32_t begin, bytes;
  struct instruction *inst; /* [bytes / 4 + 1]; the last one is no text */
};

struct text {
  struct segment *segments; /* [count]; their instructions are in one array */
  size_t count;
  struct instruction *inst;           /* [inst_count] */
  const struct instruction *not_text; /* the last one, for every pc that is no text */
  size_t inst_count;
};

struct thread {
  uint32_t reg[TRAX_NUM_REGISTERS + 1]; /* results for r0 go to [TRAX_NO_REGISTER] */
  uint32_t pc;
  uint32_t number, tm, tp;
  bool ended;
  uint64_t executed; /* instructions */
  uint64_t overrun;  /* instructions executed past the end of its latest slice, which the next one is shorter by */
  uint8_t local[TRAX_LOCAL_SIZE];
};

struct chip {
  struct trax_machine *machine;
  const struct trax_text *decoded; /* the run's */
  FILE *output;
  struct text text;
  struct thread *thread; /* [threads] */
  uint32_t threads, running, next;
  uint64_t limit;                       /* instructions of a thread */
  struct trax_translation *translation; /* NULL: all is interpreted */
  uint64_t executed, translate_from;    /* instructions of all threads; the translation begins with that one */
  /* [tms][inst_count + 1]: the number of executions of each instruction since the latest collect(), as differences:
     that of instruction i is the sum of [0] to [i]. So a sequence of instructions costs two additions. */
  int64_t **deltas;
};

static const struct instruction *inst_at(const struct text *text, uint32_t pc) {
  for (size_t i = 0; i < text->count && pc % 4 == 0; i++)
    if (pc - text->segments[i].begin < text->segments[i].bytes)
      return text->segments[i].inst + (pc - text->segments[i].begin) / 4;
  return text->not_text;
}

#include "functional/interpreter.h"

/* --- instructions that run_slice does not execute --- */

static void end_thread(struct chip *chip, struct thread *thread, int32_t status) {
  thread->ended = true;
  chip->machine->exit_statuses[thread->number] = status;
  chip->running--;
}

static void fault(struct chip *chip, struct thread *thread, const struct trax_decoded *inst, trax_fault_kind kind,
                  uint32_t address) {
  trax_fault_record(&chip->machine->fault, &chip->machine->space, inst, kind, thread->pc, address);
  chip->machine->fault.thread = thread->number;
  chip->machine->fault.tm = thread->tm;
  chip->machine->fault.tp = thread->tp;
  chip->machine->fault.cycle = thread->executed;
  memcpy(chip->machine->fault.registers, thread->reg, sizeof chip->machine->fault.registers);
  memcpy(chip->machine->fault.local, thread->local, sizeof chip->machine->fault.local);
  end_thread(chip, thread, 1);
}

/* Returns the fault that the instruction causes before its execution; *address receives the address of its access. */
static trax_fault_kind check(const struct chip *chip, const struct thread *thread, const struct trax_decoded *inst,
                             uint32_t *address) {
  *address = 0;
  if (inst->resource == TRAX_RESOURCE_NO_TEXT) {
    *address = thread->pc;
    return thread->pc % 4 ? TRAX_FAULT_MISALIGNED_PC : TRAX_FAULT_EXECUTE;
  }
  if (inst->resource == TRAX_RESOURCE_ILLEGAL)
    return TRAX_FAULT_ILLEGAL;
  if (inst->resource != TRAX_RESOURCE_MEMORY)
    return TRAX_FAULT_NONE;
  *address = thread->reg[inst->ra] + (uint32_t)inst->imm;
  return trax_access_check(inst, &chip->machine->space, *address);
}

static uint8_t *place(const struct chip *chip, struct thread *thread, uint32_t address) {
  return address >= TRAX_LOCAL_BASE ? thread->local + (address - TRAX_LOCAL_BASE)
                                    : chip->machine->space.bytes + address;
}

static uint32_t load(const struct chip *chip, struct thread *thread, uint32_t address, unsigned bytes) {
  uint32_t value = 0;
  memcpy(&value, place(chip, thread, address), bytes);
  return value;
}

static uint32_t increment(const struct chip *chip, struct thread *thread, uint32_t address) {
  const uint32_t old = load(chip, thread, address, 4), value = old + 1;
  memcpy(place(chip, thread, address), &value, sizeof value);
  return old;
}

/* Executes one instruction of any kind, at thread->pc. False: it faulted. */
static bool execute(struct chip *chip, struct thread *thread) {
  const struct trax_decoded *inst = trax_text_at(chip->decoded, thread->pc);
  const size_t index = (size_t)(inst_at(&chip->text, thread->pc) - chip->text.inst);
  struct trax_tm_stats *stats = &chip->machine->tm_stats[thread->tm];
  uint32_t *const reg = thread->reg;
  uint32_t next_pc = thread->pc + 4, address, word;
  trax_fault_kind kind = check(chip, thread, inst, &address);
  if (kind) {
    fault(chip, thread, inst, kind, address);
    return false;
  }
#include "machine/semantics_begin.h"
#define PC thread->pc
#define PRECISION chip->machine->config.special.precision_bits
#define LOAD(ADDRESS, BYTES) load(chip, thread, ADDRESS, BYTES)
#define STORE(ADDRESS, VALUE, BYTES) (word = (VALUE), memcpy(place(chip, thread, ADDRESS), &word, BYTES))
#define ATOMIC_INC(ADDRESS) increment(chip, thread, ADDRESS)
#define SPECIAL_REGISTER(NUMBER) trax_special_register(&chip->machine->config, thread->number, NUMBER, thread->executed)
#define TRAP(VALUE, CODE)                                                                                              \
  do {                                                                                                                 \
    const uint32_t value_ = (VALUE);                                                                                   \
    if ((CODE) == TRAX_TRAP_EXIT)                                                                                      \
      end_thread(chip, thread, (int32_t)value_);                                                                       \
    else if ((kind = trax_trap(chip->machine, thread->local, stats, chip->output, value_, (int32_t)(CODE))))           \
      address = value_;                                                                                                \
  } while (0)
#define FENCE(KIND) ((void)(KIND))
#define HALT() end_thread(chip, thread, 0)
#include "machine/semantics_switch.h"
  if (kind) {
    fault(chip, thread, inst, kind, address);
    return false;
  }
  if (inst->is_nontemporal && address < TRAX_LOCAL_BASE)
    ++*(inst->is_store ? &stats->nontemporal_stores : &stats->nontemporal_loads);
  thread->pc = next_pc;
  thread->executed++;
  chip->deltas[thread->tm][index]++;
  chip->deltas[thread->tm][index + 1]--;
  return true;
}

/* --- slices --- */

/* Executes instructions as run_slice does, and the translation of those that have one. */
static enum stop run_translated(struct chip *chip, struct thread *thread, uint64_t end) {
  const size_t index = (size_t)(inst_at(&chip->text, thread->pc) - chip->text.inst);
  if (trax_translation_has(chip->translation, index)) {
    struct trax_translated_thread it = {thread->reg, thread->local, thread->tm, thread->pc,
                                        (int64_t)(end - thread->executed)};
    const enum trax_translated_end ended = trax_translation_run(chip->translation, index, &it);
    thread->executed = end - (uint64_t)it.left;
    thread->pc = it.pc;
    if (ended == TRAX_TRANSLATED_JUMPED)
      return STOP_SLICE;
    if (inst_at(&chip->text, thread->pc)->operation == chip->text.not_text->operation)
      return STOP_SLOW;
  }
  return run_slice(chip, thread, thread->executed + 1, NULL);
}

static void begin_translation(struct chip *chip, bool at_once) {
  const struct trax_machine *machine = chip->machine;
  chip->translation = trax_translation_create(chip->decoded, &machine->space, machine->config.special.precision_bits,
                                              machine->config.chip.tms, at_once, NULL);
  chip->translate_from = UINT64_MAX;
}

static enum trax_advance advance(void *context, uint64_t *t, uint64_t until) {
  struct chip *chip = context;
  const uint64_t stop = chip->executed + INSTRUCTIONS;
  (void)t;
  (void)until;
  while (chip->running && chip->executed < stop) {
    struct thread *thread = &chip->thread[chip->next];
    chip->next = chip->next + 1 < chip->threads ? chip->next + 1 : 0;
    const uint64_t before = thread->executed, end = before + SLICE - thread->overrun;
    if (chip->translation)
      trax_translation_extend(chip->translation);
    else if (chip->executed >= chip->translate_from)
      begin_translation(chip, false);
    while (thread->executed < end && !thread->ended)
      if ((chip->translation ? run_translated(chip, thread, end) : run_slice(chip, thread, end, NULL)) == STOP_SLOW &&
          !execute(chip, thread))
        return TRAX_HAS_FAULTED;
    thread->overrun = thread->executed - end;
    if (thread->executed >= chip->limit)
      return TRAX_AT_LIMIT;
    chip->executed += thread->executed - before;
  }
  return chip->running ? TRAX_GOES_ON : TRAX_HAS_ENDED;
}

/* --- access --- */

static void collect(void *context) {
  struct chip *chip = context;
  for (uint32_t i = 0; i < chip->machine->config.chip.tms; i++) {
    uint64_t *const instructions = chip->machine->tm_stats[i].instructions;
    if (chip->translation)
      trax_translation_collect(chip->translation, i, chip->deltas[i]);
    int64_t count = 0;
    for (size_t index = 0; index < chip->text.inst_count; index++) {
      count += chip->deltas[i][index];
      instructions[chip->text.inst[index].op] += (uint64_t)count;
    }
    memset(chip->deltas[i], 0, chip->text.inst_count * sizeof *chip->deltas[i]);
  }
}

static void settle(void *chip, uint64_t t) {
  (void)t;
  collect(chip);
}

static struct trax_thread thread(void *context, uint32_t number) {
  const struct chip *chip = context;
  struct thread *it = &chip->thread[number];
  return (struct trax_thread){it->reg, it->local, it->pc, it->ended};
}

/* --- creation and destruction --- */

static bool is_slow(const struct trax_decoded *decoded) {
  return decoded->is_nontemporal || decoded->is_atomic || decoded->resource == TRAX_RESOURCE_ILLEGAL ||
         decoded->resource == TRAX_RESOURCE_NO_TEXT || decoded->resource == TRAX_RESOURCE_FENCE ||
         decoded->op == TRAX_OP_TRAP || decoded->op == TRAX_OP_HALT;
}

static trax_status predecode(struct text *text, const struct trax_text *from, trax_error *error) {
  const void *const *operations;
  run_slice(NULL, NULL, 0, &operations);
  text->inst_count = 1;
  for (size_t i = 0; i < from->count; i++)
    text->inst_count += (from->segments[i].end - from->segments[i].begin) / 4 + 1;
  text->segments = calloc(from->count + 1, sizeof *text->segments);
  text->inst = calloc(text->inst_count, sizeof *text->inst);
  if (!text->segments || !text->inst)
    return trax_fail(error, "out of memory for %zu instructions", text->inst_count);
  struct instruction *inst = text->inst;
  for (size_t i = 0; i < from->count; i++) {
    const struct trax_text_segment *segment = &from->segments[i];
    const uint32_t words = (segment->end - segment->begin) / 4;
    text->segments[text->count++] = (struct segment){segment->begin, words * 4, inst};
    for (uint32_t word = 0; word <= words; word++) {
      const struct trax_decoded *decoded = &segment->decoded[word];
      *inst++ = (struct instruction){operations[is_slow(decoded) ? TRAX_OP_ILLEGAL : decoded->op],
                                     decoded->imm,
                                     decoded->op,
                                     decoded->rd,
                                     decoded->ra,
                                     decoded->rb};
    }
  }
  *inst = (struct instruction){.operation = operations[TRAX_OP_ILLEGAL]};
  text->not_text = inst;
  return TRAX_OK;
}

static trax_status create(struct trax_run *run, trax_error *error) {
  const struct trax_config *config = &run->machine->config;
  const uint32_t tms = config->chip.tms, tps = config->chip.tps_per_tm;
  struct chip *chip = run->chip = calloc(1, sizeof *chip);
  if (!chip)
    return trax_fail(error, "out of memory");
  chip->machine = run->machine;
  chip->decoded = &run->text;
  chip->output = run->options->output;
  chip->limit = run->options->max_cycles ? run->options->max_cycles : UINT64_MAX;
  chip->threads = chip->running = tms * tps;
  if (predecode(&chip->text, &run->text, error) != TRAX_OK)
    return TRAX_ERROR;
  chip->translate_from = run->engine == &trax_functional_interpreted_engine ? UINT64_MAX : COLD;
  if (run->engine == &trax_functional_translated_engine)
    begin_translation(chip, true);
  chip->thread = calloc(chip->threads, sizeof *chip->thread);
  chip->deltas = calloc(tms, sizeof *chip->deltas);
  bool complete = chip->thread && chip->deltas;
  for (uint32_t i = 0; complete && i < tms; i++)
    complete = (chip->deltas[i] = calloc(chip->text.inst_count + 1, sizeof **chip->deltas)) != NULL;
  if (!complete)
    return trax_fail(error, "out of memory");
  for (uint32_t i = 0; i < chip->threads; i++) {
    chip->thread[i].pc = trax_machine_entry_of(run->machine, i);
    chip->thread[i].number = i;
    chip->thread[i].tm = i / tps;
    chip->thread[i].tp = i % tps;
  }
  return TRAX_OK;
}

static void destroy(void *context) {
  struct chip *chip = context;
  if (!chip)
    return;
  for (uint32_t i = 0; chip->deltas && i < chip->machine->config.chip.tms; i++)
    free(chip->deltas[i]);
  free(chip->deltas);
  free(chip->thread);
  trax_translation_destroy(chip->translation);
  free(chip->text.segments);
  free(chip->text.inst);
  free(chip);
}

#define ENGINE(NAME, MEANING)                                                                                          \
  {.name = NAME,                                                                                                       \
   .meaning = MEANING,                                                                                                 \
   .has_warps = true,                                                                                                  \
   .create = create,                                                                                                   \
   .destroy = destroy,                                                                                                 \
   .advance = advance,                                                                                                 \
   .collect = collect,                                                                                                 \
   .settle = settle,                                                                                                   \
   .thread = thread}
const struct trax_engine trax_functional_engine = ENGINE("functional", "what the program computes, without time");
const struct trax_engine trax_functional_interpreted_engine = ENGINE("functional-interpreted", "without translation");
const struct trax_engine trax_functional_translated_engine = ENGINE("functional-translated", "translation at once");
