#define _POSIX_C_SOURCE 200809L /* open_memstream */
#include "compare.h"

#include <stdlib.h>
#include <string.h>

/* The counts between two cycles are complete: every thread is charged for all cycles before. */
static trax_status inspect(struct trax_watch *watch, struct trax_run *it, uint64_t t) {
  struct run *run = watch->context;
  const struct trax_machine *machine = it->machine;
  trax_run_settle(it, t);
  for (uint64_t thread = 0; thread < machine->stats.threads; thread++) {
    uint64_t charged = 0;
    for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++) {
      charged += machine->tp_stats[thread].cycles[cause];
      run->looks[run->look_count].cycles[cause] += machine->tp_stats[thread].cycles[cause];
    }
    assert_int_equal(charged, t);
  }
  for (uint32_t tm = 0; tm < machine->config.chip.tms; tm++)
    for (size_t i = TRAX_CAUSE_COUNT; i < sizeof *run->looks / sizeof(uint64_t); i++)
      ((uint64_t *)&run->looks[run->look_count])[i] += ((const uint64_t *)&machine->tm_stats[tm])[i];
  watch->next = ++run->look_count < LOOKS ? t + LOOK_EVERY : TRAX_NEVER;
  return TRAX_OK;
}

static void add_transfer(void *context, const struct trax_transfer *transfer) {
  struct transfers *to = context;
  const uint64_t words[] = {transfer->cycle, transfer->address, transfer->bytes,
                            (uint64_t)(uint16_t)transfer->tm << 16 | (uint64_t)transfer->kind << 8 | transfer->channel};
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    to->hash = (to->hash ^ words[i]) * 0x9E3779B97F4A7C15u >> 3;
  assert_true(transfer->cycle > to->last_cycle ||
              (transfer->cycle == to->last_cycle && transfer->channel >= to->last_channel));
  to->last_cycle = transfer->cycle;
  to->last_channel = transfer->channel;
  to->count++;
  to->bytes += transfer->bytes;
}

/* Loaded, on the same data for all. */
static struct run begin(const struct trax_config *config, const uint32_t *program, size_t count) {
  struct run run = {.bench = bench_begin(config, program, count)};
  const uint64_t saved = random_state;
  random_state = 99;
  for (uint32_t i = 0; i < DATA_BYTES; i++)
    run.bench.machine->space.bytes[DATA + i] = (uint8_t)any(0, 255);
  random_state = saved;
  if (count % 2) { /* half of it is what the host has filled, as far as the engine knows: nobody may notice */
    run.bench.machine->space.input = DATA + DATA_BYTES / 4;
    run.bench.machine->space.input_bytes = DATA_BYTES / 2;
  }
  return run;
}

static struct run run_options(const struct trax_config *config, const uint32_t *program, size_t count,
                              trax_run_options options, bool traced, bool looked, struct trax_watch *other) {
  struct run run = begin(config, program, count);
  struct trax_machine *machine = run.bench.machine;
  FILE *output = open_memstream(&run.output, &run.output_bytes);
  assert_non_null(output);
  struct trax_watch watch = {.next = LOOK_EVERY, .inspect = inspect, .context = &run, .others = other};
  run.looked = looked;
  machine->watches = looked ? &watch : other;
  struct trax_transfers transfers = {.context = &run.transfers, .transfer = add_transfer};
  machine->transfers = &transfers;
  options.output = output;
  if (traced)
    bench_run_observed(&run.bench, &options);
  else
    run.bench.status = trax_machine_run(machine, &options, &run.bench.error);
  machine->watches = NULL;
  machine->transfers = NULL;
  assert_false(transfers.lost);
  fclose(output);
  return run;
}

struct run run_watched(const struct trax_config *config, const uint32_t *program, size_t count, const char *engine,
                       bool traced, uint64_t max_cycles, struct trax_watch *other) {
  const trax_run_options options = {
      .max_cycles = max_cycles, .engine = engine, .host_threads = setting("TRAX_HOST_THREADS", 1)};
  return run_options(config, program, count, options, traced, true, other);
}

struct run run_prepared(const struct trax_config *config, const uint32_t *program, size_t count,
                        const trax_run_options *options, void (*prepare)(void *context, struct trax_machine *machine),
                        void *context) {
  struct run run = begin(config, program, count);
  trax_run_options with_output = *options;
  with_output.output = open_memstream(&run.output, &run.output_bytes);
  assert_non_null(with_output.output);
  prepare(context, run.bench.machine);
  run.bench.status = trax_machine_run(run.bench.machine, &with_output, &run.bench.error);
  fclose(with_output.output);
  return run;
}

struct run run_with(const struct trax_config *config, const uint32_t *program, size_t count,
                    const trax_run_options *options) {
  return run_options(config, program, count, *options, false, false, NULL);
}

struct run run_alone(const struct trax_config *config, const uint32_t *program, size_t count, const char *engine,
                     uint64_t max_cycles, unsigned host_threads) {
  const trax_run_options options = {.max_cycles = max_cycles, .engine = engine, .host_threads = host_threads};
  return run_options(config, program, count, options, false, false, NULL);
}

struct run run(const struct trax_config *config, const uint32_t *program, size_t count, const char *engine, bool traced,
               uint64_t max_cycles) {
  return run_watched(config, program, count, engine, traced, max_cycles, NULL);
}

void end(struct run *run) {
  bench_end(&run->bench);
  free(run->output);
}

/* --- differences: a function returns true if it has found and described one --- */

bool differs(struct difference *to, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(to->text, sizeof to->text, format, arguments);
  va_end(arguments);
  return true;
}

bool different_number(struct difference *to, const char *name, uint64_t x, uint64_t y) {
  return x != y && differs(to, "%s: %llu and %llu", name, (unsigned long long)x, (unsigned long long)y);
}

bool different_bytes(struct difference *to, const char *name, const void *x, const void *y, size_t size) {
  for (size_t i = 0; i < size; i++)
    if (((const uint8_t *)x)[i] != ((const uint8_t *)y)[i])
      return differs(to, "%s: byte 0x%zx is 0x%02x and 0x%02x", name, i, ((const uint8_t *)x)[i],
                     ((const uint8_t *)y)[i]);
  return false;
}

static bool different_causes(struct difference *to, const char *where, size_t number, const uint64_t *x,
                             const uint64_t *y) {
  static const char *const names[] = {
#define NAME(ID, JSON, ...) JSON,
      TRAX_CAUSES(NAME)
#undef NAME
  };
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    if (x[cause] != y[cause])
      return differs(to, "%s %zu: %s is %llu and %llu", where, number, names[cause], (unsigned long long)x[cause],
                     (unsigned long long)y[cause]);
  return false;
}

static bool different_tm(struct difference *to, size_t number, const struct trax_tm_stats *x,
                         const struct trax_tm_stats *y) {
#define COMPARE(ID, NAME, UNIT, MEANING)                                                                               \
  if (x->ID != y->ID)                                                                                                  \
    return differs(to, "TM %zu: " NAME " is %llu and %llu", number, (unsigned long long)x->ID,                         \
                   (unsigned long long)y->ID);
  TRAX_TM_COUNTERS(COMPARE)
#undef COMPARE
  for (unsigned op = 0; op < TRAX_OP_COUNT; op++)
    if (x->instructions[op] != y->instructions[op])
      return differs(to, "TM %zu: %s was issued %llu and %llu times", number, trax_op_table[op].mnemonic,
                     (unsigned long long)x->instructions[op], (unsigned long long)y->instructions[op]);
  return different_causes(to, "TM", number, x->cycles, y->cycles) ||
         different_bytes(to, "statistics of a TM", x, y, sizeof *x);
}

static bool different_fault(struct difference *to, const struct trax_fault *x, const struct trax_fault *y) {
  return different_number(to, "kind of fault", x->kind, y->kind) ||
         different_number(to, "pc of the fault", x->pc, y->pc) ||
         different_number(to, "thread of the fault", x->thread, y->thread) ||
         different_number(to, "cycle of the fault", x->cycle, y->cycle) ||
         different_number(to, "address of the fault", x->address, y->address) ||
         different_bytes(to, "registers of the fault", x->registers, y->registers, sizeof x->registers) ||
         different_bytes(to, "fault", x, y, sizeof *x);
}

bool different_effects(struct difference *to, const struct run *a, const struct run *b) {
  const struct trax_machine *x = a->bench.machine, *y = b->bench.machine;
  return different_number(to, "instructions", x->stats.instructions, y->stats.instructions) ||
         different_bytes(to, "exit statuses", x->exit_statuses, y->exit_statuses,
                         x->stats.threads * sizeof *x->exit_statuses) ||
         (memcmp(x->space.bytes, y->space.bytes, x->space.size) != 0 &&
          different_bytes(to, "memory", x->space.bytes, y->space.bytes, x->space.size)) ||
         different_number(to, "bytes of output", a->output_bytes, b->output_bytes) ||
         different_bytes(to, "output", a->output, b->output, a->output_bytes);
}

static bool different_looks(struct difference *to, const struct run *a, const struct run *b) {
  if (!a->looked || !b->looked)
    return false;
  for (unsigned i = 0; i < a->look_count && i < b->look_count; i++)
    if (different_tm(to, i, &a->looks[i], &b->looks[i])) {
      char what[sizeof to->text];
      memcpy(what, to->text, sizeof what);
      return differs(to, "before cycle %u, sums of all TMs for one: %.400s", LOOK_EVERY * (i + 1), what);
    }
  return different_number(to, "looks between cycles", a->look_count, b->look_count);
}

bool different_runs(struct difference *to, const struct run *a, const struct run *b) {
  const struct trax_machine *x = a->bench.machine, *y = b->bench.machine;
  if (different_number(to, "status", a->bench.status, b->bench.status) ||
      (a->bench.status != TRAX_OK && strcmp(a->bench.error.message, b->bench.error.message) != 0 &&
       differs(to, "message: \"%s\" and \"%s\"", a->bench.error.message, b->bench.error.message)) ||
      different_number(to, "cycles", x->stats.cycles, y->stats.cycles) || different_fault(to, &x->fault, &y->fault))
    return true;
  for (size_t i = 0; i < x->stats.threads; i++)
    if (different_causes(to, "thread", i, x->tp_stats[i].cycles, y->tp_stats[i].cycles))
      return true;
  for (size_t i = 0; i < x->config.chip.tms; i++)
    if (different_tm(to, i, &x->tm_stats[i], &y->tm_stats[i]))
      return true;
  return different_bytes(to, "statistics of the chip", &x->stats.total, &y->stats.total, sizeof x->stats.total) ||
         different_bytes(to, "statistics of the memory", &x->stats.memory, &y->stats.memory, sizeof x->stats.memory) ||
         different_effects(to, a, b) || different_looks(to, a, b);
}

bool different_transfers(struct difference *to, const struct run *a, const struct run *b) {
  const struct trax_memory_stats *stats = &a->bench.machine->stats.memory;
  return different_number(to, "transfers heard of", a->transfers.count, b->transfers.count) ||
         different_number(to, "their bytes", a->transfers.bytes, b->transfers.bytes) ||
         different_number(to, "their hash", a->transfers.hash, b->transfers.hash) ||
         (a->bench.status == TRAX_OK &&
          (different_number(to, "transfers heard of and counted", a->transfers.count, stats->transfers) ||
           different_number(to, "bytes heard of and counted", a->transfers.bytes, stats->bytes)));
}

static bool has_value(uint32_t word) {
  const trax_inst inst = trax_decode(word);
  const unsigned flags = trax_op_table[inst.op].flags;
  return (flags & TRAX_WRITES_RD && inst.rd && !(flags & TRAX_IS_ATOMIC)) || flags & TRAX_IS_STORE ||
         inst.op == TRAX_OP_TRAP;
}

bool different_charges(struct difference *to, const struct bench *a, const struct bench *b) {
  for (uint32_t thread = 0; thread < a->machine->stats.threads; thread++) {
    if (a->told[thread].causes != b->told[thread].causes)
      return differs(to, "thread %u has other causes, or the same in another order", thread);
    for (unsigned rd = 0; rd < TRAX_NUM_REGISTERS; rd++)
      if (a->told[thread].waits[rd] != b->told[thread].waits[rd])
        return differs(to, "thread %u waits %llu and %llu cycles for r%u", thread,
                       (unsigned long long)a->told[thread].waits[rd], (unsigned long long)b->told[thread].waits[rd],
                       rd);
  }
  return false;
}

/* Leaves what a stretch has. */
static void reduce(struct trax_issue *issue) {
  const trax_inst inst = trax_decode(issue->word);
  const unsigned flags = trax_op_table[inst.op].flags;
  if (trax_op_table[inst.op].access_bytes && issue->address >= TRAX_LOCAL_BASE)
    issue->address = TRAX_LOCAL_BASE;
  if (inst.op != TRAX_OP_TRAP && !(flags & TRAX_WRITES_RD && inst.rd == TRAX_STACK_POINTER))
    issue->result = 0;
}

void reduce_issues(struct bench_issues *issues) {
  for (size_t i = 0; i < issues->count; i++)
    reduce(&issues->issue[i]);
}

bool different_issues(struct difference *to, const struct bench_issues *a, const struct bench_issues *b) {
  for (size_t i = 0; i < a->count && i < b->count; i++) {
    const struct trax_issue *x = &a->issue[i], *y = &b->issue[i];
    if (x->cycle != y->cycle || x->tm != y->tm || x->tp != y->tp || x->pc != y->pc || x->word != y->word ||
        x->next_pc != y->next_pc || x->address != y->address || x->outcome != y->outcome ||
        (has_value(x->word) && x->result != y->result))
      return differs(to,
                     "issue %zu: cycle %llu, TM %u, TP %u, pc 0x%x, result 0x%x, and cycle %llu, TM %u, TP %u, "
                     "pc 0x%x, result 0x%x",
                     i, (unsigned long long)x->cycle, x->tm, x->tp, x->pc, x->result, (unsigned long long)y->cycle,
                     y->tm, y->tp, y->pc, y->result);
  }
  return different_number(to, "issues", a->count, b->count);
}

void expect_same(const struct run *a, const struct run *b) {
  struct difference difference;
  assert_int_not_equal(a->bench.status, TRAX_ERROR);
  if (different_runs(&difference, a, b))
    fail_msg("%s", difference.text);
}

unsigned setting(const char *name, unsigned otherwise) {
  const char *text = getenv(name);
  return text ? (unsigned)atoi(text) : otherwise;
}
