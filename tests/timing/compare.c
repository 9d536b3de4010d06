#define _POSIX_C_SOURCE 200809L /* open_memstream */
#include "compare.h"

#include <stdlib.h>
#include <string.h>

/* The counts between two cycles are complete: every thread is charged for all cycles before. */
static trax_status look(struct trax_watch *watch, struct trax_chip *chip) {
  struct run *run = watch->context;
  const struct trax_machine *machine = chip->machine;
  trax_chip_settle(chip, watch->next);
  for (uint64_t thread = 0; thread < machine->stats.threads; thread++) {
    uint64_t charged = 0;
    for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++) {
      charged += machine->tp_stats[thread].cycles[cause];
      run->looks[run->look_count].cycles[cause] += machine->tp_stats[thread].cycles[cause];
    }
    assert_int_equal(charged, watch->next);
  }
  for (uint32_t tm = 0; tm < chip->tms; tm++)
    for (size_t i = TRAX_CAUSE_COUNT; i < sizeof *run->looks / sizeof(uint64_t); i++)
      ((uint64_t *)&run->looks[run->look_count])[i] += ((const uint64_t *)&machine->tm_stats[tm])[i];
  watch->next = ++run->look_count < LOOKS ? watch->next + LOOK_EVERY : TRAX_NEVER;
  return TRAX_OK;
}

struct run run_watched(const struct trax_config *config, const uint32_t *program, size_t count, trax_engine engine,
                       bool traced, uint64_t max_cycles, struct trax_watch *other) {
  struct run run = {.bench = bench_begin(config, program, count)};
  struct trax_machine *machine = run.bench.machine;
  const uint64_t saved = random_state;
  random_state = 99; /* the same data for all */
  for (uint32_t i = 0; i < DATA_BYTES; i++)
    machine->space.bytes[DATA + i] = (uint8_t)any(0, 255);
  random_state = saved;
  FILE *output = open_memstream(&run.output, &run.output_bytes);
  assert_non_null(output);
  struct trax_watch watch = {.next = LOOK_EVERY, .look = look, .context = &run, .others = other};
  machine->watches = &watch;
  const trax_run_options options = {.output = output, .max_cycles = max_cycles, .engine = engine};
  if (traced)
    bench_run_observed(&run.bench, &options);
  else
    run.bench.status = trax_machine_run(machine, &options, &run.bench.error);
  machine->watches = NULL;
  fclose(output);
  return run;
}

struct run run(const struct trax_config *config, const uint32_t *program, size_t count, trax_engine engine, bool traced,
               uint64_t max_cycles) {
  return run_watched(config, program, count, engine, traced, max_cycles, NULL);
}

void end(struct run *run) {
  bench_end(&run->bench);
  free(run->output);
}

static bool has_value(uint32_t word) {
  const trax_inst inst = trax_decode(word);
  const unsigned flags = trax_op_table[inst.op].flags;
  return (flags & TRAX_WRITES_RD && inst.rd && !(flags & TRAX_IS_ATOMIC)) || flags & TRAX_IS_STORE ||
         inst.op == TRAX_OP_TRAP;
}

void expect_same_issues(const struct bench_issues *a, const struct bench_issues *b) {
  for (size_t i = 0; i < a->count && i < b->count; i++) {
    const struct trax_issue *x = &a->issue[i], *y = &b->issue[i];
    if (x->cycle != y->cycle || x->tm != y->tm || x->tp != y->tp || x->pc != y->pc || x->word != y->word ||
        x->next_pc != y->next_pc || x->address != y->address || x->outcome != y->outcome ||
        (has_value(x->word) && x->result != y->result))
      fail_msg("issue %zu: cycle %llu, TM %u, TP %u, pc 0x%x, result 0x%x, but cycle %llu, TM %u, TP %u, pc 0x%x, "
               "result 0x%x",
               i, (unsigned long long)x->cycle, x->tm, x->tp, x->pc, x->result, (unsigned long long)y->cycle, y->tm,
               y->tp, y->pc, y->result);
  }
  assert_int_equal(a->count, b->count);
}

void expect_same(const struct run *a, const struct run *b) {
  const struct trax_machine *x = a->bench.machine, *y = b->bench.machine;
  const size_t tms = x->config.chip.tms, threads = x->stats.threads;
  assert_int_equal(a->bench.status, b->bench.status);
  assert_int_not_equal(a->bench.status, TRAX_ERROR);
  if (a->bench.status != TRAX_OK)
    assert_string_equal(a->bench.error.message, b->bench.error.message);
  if (x->stats.cycles != y->stats.cycles)
    fail_msg("%llu cycles, but %llu", (unsigned long long)x->stats.cycles, (unsigned long long)y->stats.cycles);
  assert_memory_equal(&x->fault, &y->fault, sizeof x->fault);
  assert_memory_equal(x->tp_stats, y->tp_stats, threads * sizeof *x->tp_stats);
  assert_memory_equal(x->tm_stats, y->tm_stats, tms * sizeof *x->tm_stats);
  assert_memory_equal(&x->stats.total, &y->stats.total, sizeof x->stats.total);
  assert_int_equal(x->stats.instructions, y->stats.instructions);
  assert_memory_equal(x->exit_statuses, y->exit_statuses, threads * sizeof *x->exit_statuses);
  assert_true(memcmp(x->space.bytes, y->space.bytes, x->space.size) == 0);
  assert_int_equal(a->look_count, b->look_count);
  assert_memory_equal(a->looks, b->looks, sizeof a->looks);
  assert_int_equal(a->output_bytes, b->output_bytes);
  assert_true(a->output_bytes == 0 || memcmp(a->output, b->output, a->output_bytes) == 0);
}

unsigned setting(const char *name, unsigned otherwise) {
  const char *text = getenv(name);
  return text ? (unsigned)atoi(text) : otherwise;
}
