#define _POSIX_C_SOURCE 200809L /* open_memstream */
#include "case.h"
#include "minimise.h"

#include <stdlib.h>
#include <string.h>

enum {
  MOST_INSTRUCTIONS = 50000, /* of the model, all threads together */
  MEMORY_MIB = 1
};

void differential_case_of_seed(struct differential_case *c, unsigned seed) {
  memset(c, 0, sizeof *c);
  random_state = 0x9E3779B97F4A7C15u * (seed + 1);
  c->kind = (enum program_kind)(seed % 8 < 4 ? PROGRAM_ALONE : seed % 8 < 7 ? PROGRAM_TOGETHER : PROGRAM_WORDS);
  const uint32_t tms = c->kind == PROGRAM_TOGETHER ? any(1, 3) : 1;
  c->config = any_config(tms, c->kind == PROGRAM_TOGETHER ? any(1, MOST_PROGRAM_THREADS / tms) : 1);
  c->config.memory.size_mib = MEMORY_MIB;
  c->config.special.precision_bits = any(0, 3) ? 24 : any(1, 24);
  c->count = any_differential_program(c->kind, MEMORY_MIB << 20, c->words, &c->prologue);
  c->data_seed = random_state;
}

/* --- runs --- */

struct model_run {
  struct model_machine *machine;
  enum model_end end;
  struct model_error error;
  char *output;
  size_t output_bytes;
};

static void run_model(const struct model_isa *isa, const struct differential_case *c, const uint8_t *initial,
                      struct model_run *run) {
  const uint64_t size = (uint64_t)c->config.memory.size_mib << 20;
  uint8_t *text, *data;
  run->machine = model_create(isa, c->config.chip.tms, c->config.chip.tps_per_tm, size, &run->error);
  FILE *output = open_memstream(&run->output, &run->output_bytes);
  assert_non_null(run->machine);
  assert_non_null(output);
  assert_true(model_map(run->machine, TEXT, 4 * (uint32_t)c->count, MODEL_READ | MODEL_EXECUTE, &text, &run->error));
  assert_true(model_map(run->machine, DATA, DATA_BYTES, MODEL_READ | MODEL_WRITE, &data, &run->error));
  assert_true(model_map(run->machine, RODATA, 64, MODEL_READ, NULL, &run->error));
  memcpy(text, c->words, 4 * c->count);
  memcpy(data, initial, DATA_BYTES);
  model_set_entry(run->machine, TEXT);
  run->machine->precision = c->config.special.precision_bits;
  run->machine->output = output;
  run->end = model_run(run->machine, MOST_INSTRUCTIONS, &run->error);
  fclose(output);
}

static void run_engine(const struct differential_case *c, const uint8_t *initial, const char *engine, struct run *run) {
  *run = (struct run){.bench = bench_begin(&c->config, c->words, c->count)};
  FILE *output = open_memstream(&run->output, &run->output_bytes);
  assert_non_null(output);
  memcpy(run->bench.machine->space.bytes + DATA, initial, DATA_BYTES);
  /* Far more cycles than the model's instructions take at any latency. */
  const trax_run_options options = {
      .output = output, .engine = engine, .max_cycles = 20000 * (uint64_t)MOST_INSTRUCTIONS, .host_threads = 1};
  run->bench.status = trax_machine_run(run->bench.machine, &options, &run->bench.error);
  fclose(output);
}

/* --- differences --- */

static bool different_fault(struct difference *to, const struct trax_fault *x, const struct model_machine *model) {
  const struct model_fault *y = &model->fault;
  const struct model_thread *thread = &model->threads[y->thread];
  const char *word = trax_fault_name(x->kind);
  if (strcmp(word, model_fault_word(y->kind)) != 0)
    return differs(to, "fault: %s at pc 0x%08x, address 0x%08x, and %s at pc 0x%08x, address 0x%08x", word, x->pc,
                   x->address, model_fault_word(y->kind), y->pc, y->address);
  if (different_number(to, "pc of the fault", x->pc, y->pc) ||
      different_number(to, "address of the fault", x->address, y->address) ||
      different_number(to, "thread of the fault", x->thread, y->thread))
    return true;
  for (unsigned i = 0; i < TRAX_NUM_REGISTERS; i++)
    if (x->registers[i] != thread->registers[i])
      return differs(to, "r%u at the fault: 0x%08x and 0x%08x", i, x->registers[i], thread->registers[i]);
  return different_bytes(to, "local memory at the fault", x->local, thread->local, TRAX_LOCAL_SIZE);
}

/* Registers are in memory: the program stores them. */
static bool different_end(struct difference *to, const struct run *a, const struct model_run *b) {
  const struct trax_machine *x = a->bench.machine;
  const struct model_machine *y = b->machine;
  if (b->end == MODEL_ERROR)
    return differs(to, "the model: %s", b->error.message);
  if (a->bench.status != (b->end == MODEL_FAULTED ? TRAX_FAULT : TRAX_OK))
    return differs(to, "status %d (%s), and the model's %d (%s)", (int)a->bench.status, trax_fault_text(x->fault.kind),
                   (int)b->end, model_fault_word(y->fault.kind));
  if (b->end == MODEL_FAULTED && different_fault(to, &x->fault, y))
    return true;
  if (b->end == MODEL_ENDED && different_number(to, "instructions", x->stats.instructions, y->instructions))
    return true;
  for (uint32_t i = 0; i < y->thread_count; i++)
    if ((uint32_t)x->exit_statuses[i] != y->threads[i].status)
      return differs(to, "exit status of thread %u: 0x%x and 0x%x", i, (uint32_t)x->exit_statuses[i],
                     y->threads[i].status);
  return (memcmp(x->space.bytes, y->memory, y->size) != 0 &&
          different_bytes(to, "memory", x->space.bytes, y->memory, y->size)) ||
         different_number(to, "bytes of output", a->output_bytes, b->output_bytes) ||
         different_bytes(to, "output", a->output, b->output, a->output_bytes);
}

void differential_compare(const struct model_isa *isa, const struct differential_case *c,
                          struct differential_outcome *outcome) {
  static const struct {
    const char *engine;
    const char *name;
  } engines[] = {{"reference", "reference"}, {"fast", "fast"}, {"functional", "functional"}};
  static uint8_t initial[DATA_BYTES];
  struct model_run model = {0};
  memset(outcome, 0, sizeof *outcome);
  random_state = c->data_seed;
  program_data(initial);
  run_model(isa, c, initial, &model);
  outcome->unended = model.end == MODEL_LIMIT;
  outcome->fault = model.machine->fault.kind;
  outcome->instructions = model.machine->instructions;
  for (unsigned i = 0; i < sizeof engines / sizeof *engines && !outcome->unended && !*outcome->difference.text; i++) {
    struct run run;
    struct difference difference;
    run_engine(c, initial, engines[i].engine, &run);
    if (different_end(&difference, &run, &model))
      differs(&outcome->difference, "engine %s and the model: %.400s", engines[i].name, difference.text);
    if (i == 0)
      for (unsigned op = 0; op < TRAX_OP_COUNT; op++)
        outcome->executed[op] = run.bench.machine->stats.total.instructions[op];
    end(&run);
  }
  model_destroy(model.machine);
  free(model.output);
}

/* --- smaller cases --- */

/* Waits for the result of every ainc: otherwise later results depend on time. */
static bool waits(const struct differential_case *c) {
  for (size_t i = 0; i < c->count; i++) {
    const trax_inst inst = trax_decode(c->words[i]);
    const trax_inst next = i + 1 < c->count ? trax_decode(c->words[i + 1]) : (trax_inst){0};
    if (inst.op == TRAX_OP_AINC && inst.rd && !(trax_op_table[next.op].flags & TRAX_READS_RA && next.ra == inst.rd))
      return false;
  }
  return true;
}

static bool accept(const struct model_isa *isa, struct differential_case *c, const struct differential_case *smaller) {
  struct differential_outcome outcome;
  if (!waits(smaller))
    return false;
  differential_compare(isa, smaller, &outcome);
  if (!*outcome.difference.text)
    return false;
  *c = *smaller;
  return true;
}

static bool reduce_words(const struct model_isa *isa, struct differential_case *c) {
  const bool alone = c->config.chip.tms * c->config.chip.tps_per_tm == 1;
  const size_t first = alone ? 0 : c->prologue; /* without it threads would meet */
  bool reduced = false;
  for (size_t size = c->count / 2; size; size /= 2)
    for (size_t i = first; i + size <= c->count && c->count > size;) {
      struct differential_case candidate = *c;
      candidate.count = without_words(c->words, c->count, i, i + size, candidate.words);
      if (accept(isa, c, &candidate))
        reduced = true;
      else
        i += size;
    }
  return reduced;
}

static bool reduce_threads(const struct model_isa *isa, struct differential_case *c) {
  bool reduced = false;
  for (unsigned i = 0; i < 2; i++) {
    struct differential_case candidate = *c;
    uint32_t *threads = i ? &candidate.config.chip.tps_per_tm : &candidate.config.chip.tms;
    while (*threads > 1) {
      --*threads;
      if (trax_config_validate(&candidate.config, NULL) || !accept(isa, c, &candidate))
        break;
      reduced = true;
    }
  }
  return reduced;
}

void differential_minimise(const struct model_isa *isa, struct differential_case *c) {
  while (reduce_threads(isa, c) || reduce_words(isa, c))
    ;
}

void differential_print(const struct differential_case *c, FILE *out) {
  fprintf(out, "  %u TMs of %u TPs, FPDIV and iSQRT of %u bits\n", c->config.chip.tms, c->config.chip.tps_per_tm,
          c->config.special.precision_bits);
  for (size_t i = 0; i < c->count; i++) {
    char text[128];
    const uint32_t pc = TEXT + 4 * (uint32_t)i;
    trax_disassemble(c->words[i], pc, text, sizeof text);
    fprintf(out, "  0x%04x  %08x  %s\n", pc, c->words[i], text);
  }
}
