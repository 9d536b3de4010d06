#define _POSIX_C_SOURCE 200809L /* open_memstream */
/* The fast engine against the reference: random programs on random configurations, to the last count and byte.

   TRAX_RANDOM_ROUNDS and TRAX_RANDOM_SEED make it longer and different. */
#include "core/chip.h"
#include "generate.h"

#include <stdlib.h>
#include <string.h>

enum { LOOKS = 64, LOOK_EVERY = 61 };

struct run {
  struct bench bench;
  char *output;
  size_t output_bytes;
  /* All counts as they were between cycles. */
  struct trax_tm_stats looks[LOOKS]; /* sums over the TMs */
  unsigned look_count;
};

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

static struct run run(const struct trax_config *config, const uint32_t *program, size_t count, trax_engine engine,
                      bool traced, uint64_t max_cycles) {
  struct run run = {.bench = bench_begin(config, program, count)};
  struct trax_machine *machine = run.bench.machine;
  const uint64_t saved = random_state;
  random_state = 99; /* the same data for all */
  for (uint32_t i = 0; i < DATA_BYTES; i++)
    machine->space.bytes[DATA + i] = (uint8_t)any(0, 255);
  random_state = saved;
  FILE *output = open_memstream(&run.output, &run.output_bytes);
  assert_non_null(output);
  struct trax_watch watch = {.next = LOOK_EVERY, .look = look, .context = &run};
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

static void end(struct run *run) {
  bench_end(&run->bench);
  free(run->output);
}

static bool has_value(uint32_t word) {
  const trax_inst inst = trax_decode(word);
  const unsigned flags = trax_op_table[inst.op].flags;
  return (flags & TRAX_WRITES_RD && inst.rd && !(flags & TRAX_IS_ATOMIC)) || flags & TRAX_IS_STORE ||
         inst.op == TRAX_OP_TRAP;
}

static void expect_same_issues(const struct bench_issues *a, const struct bench_issues *b) {
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

static void expect_same(const struct run *a, const struct run *b) {
  const struct trax_machine *x = a->bench.machine, *y = b->bench.machine;
  const size_t tms = x->config.chip.tms, threads = x->stats.threads;
  assert_int_equal(a->bench.status, b->bench.status);
  assert_int_not_equal(a->bench.status, TRAX_ERROR);
  if (a->bench.status != TRAX_OK)
    assert_string_equal(a->bench.error.message, b->bench.error.message);
  assert_int_equal(x->stats.cycles, y->stats.cycles);
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

static void compare(const struct trax_config *config, const uint32_t *program, size_t count, uint64_t max_cycles) {
  struct run reference = run(config, program, count, TRAX_ENGINE_REFERENCE, true, max_cycles);
  struct run ahead = run(config, program, count, TRAX_ENGINE_FAST, false, max_cycles);
  expect_same(&reference, &ahead);
  end(&ahead);
  struct run traced = run(config, program, count, TRAX_ENGINE_FAST, true, max_cycles);
  expect_same(&reference, &traced);
  expect_same_issues(&reference.bench.issues, &traced.bench.issues);
  end(&traced);
  end(&reference);
}

static unsigned setting(const char *name, unsigned otherwise) {
  const char *text = getenv(name);
  return text ? (unsigned)atoi(text) : otherwise;
}

static void each(const char *kind, unsigned rounds, size_t (*generate)(uint32_t *), bool plain) {
  const unsigned seed = setting("TRAX_RANDOM_SEED", 1);
  rounds = setting("TRAX_RANDOM_ROUNDS", rounds);
  for (unsigned round = 0; round < rounds; round++) {
    random_state = 0x9E3779B97F4A7C15u * (seed + round);
    if (rounds <= 1000 && round % 10 == 0)
      print_message("%s, TRAX_RANDOM_SEED=%u\n", kind, seed + round);
    uint32_t program[BODY + 64];
    const size_t count = generate(program);
    const uint32_t tms = any(1, 4), tps = any(1, MAX_THREADS / tms > 64 ? 64 : MAX_THREADS / tms);
    struct trax_config config = any_config(tms, tps);
    if (plain) { /* near the defaults, so that threads meet more often than they wait */
      const struct trax_config initial = TRAX_CONFIG_DEFAULT;
      config = initial;
      config.chip.tms = tms;
      config.chip.tps_per_tm = tps;
      config.memory.latency_cycles = any(0, 100);
      config.memory.size_mib = 1;
    }
    compare(&config, program, count, any(0, 3) ? 0 : any(1, 5000));
  }
}

static void own_words(void **state) {
  (void)state;
  each("own words", 15, any_program, false);
}

static void races(void **state) {
  (void)state;
  each("races", 40, any_racing_program, false);
}

static void races_near_the_defaults(void **state) {
  (void)state;
  each("races near the defaults", 60, any_racing_program, true);
}

/* Endless loops are possible: every run has a limit. */
static void random_words(void **state) {
  (void)state;
  const unsigned rounds = 10 * setting("TRAX_RANDOM_ROUNDS", 100), seed = setting("TRAX_RANDOM_SEED", 1);
  for (unsigned round = 0; round < rounds; round++) {
    random_state = 0xD1B54A32D192ED03u * (seed + round);
    uint32_t program[32];
    any_words(program, 32);
    const struct trax_config config = any_config(any(1, 2), any(1, 4));
    compare(&config, program, 32, 5000);
  }
}

/* What does not depend on time. */
static void expect_same_effects(const struct run *timed, const struct run *functional) {
  const struct trax_machine *x = timed->bench.machine, *y = functional->bench.machine;
  assert_int_equal(timed->bench.status, functional->bench.status);
  assert_int_equal(y->stats.cycles, 0);
  assert_int_equal(x->stats.instructions, y->stats.instructions);
  assert_memory_equal(x->stats.total.instructions, y->stats.total.instructions, sizeof x->stats.total.instructions);
  assert_int_equal(x->stats.total.rays, y->stats.total.rays);
  assert_int_equal(x->stats.total.items, y->stats.total.items);
  assert_memory_equal(x->exit_statuses, y->exit_statuses, x->stats.threads * sizeof *x->exit_statuses);
  assert_true(memcmp(x->space.bytes, y->space.bytes, x->space.size) == 0);
  assert_int_equal(x->fault.kind, y->fault.kind);
  assert_int_equal(x->fault.pc, y->fault.pc);
  assert_int_equal(x->fault.address, y->fault.address);
  assert_memory_equal(x->fault.registers, y->fault.registers, sizeof x->fault.registers);
  assert_int_equal(timed->output_bytes, functional->output_bytes);
  assert_true(timed->output_bytes == 0 || memcmp(timed->output, functional->output, timed->output_bytes) == 0);
}

static void functional_mode(void **state) {
  (void)state;
  const unsigned rounds = setting("TRAX_RANDOM_ROUNDS", 30), seed = setting("TRAX_RANDOM_SEED", 1);
  unsigned compared = 0;
  for (unsigned round = 0; round < 10 * rounds; round++) {
    random_state = 0xA24BAED4963EE407u * (seed + round);
    uint32_t program[BODY + 64];
    size_t count = 32;
    struct trax_config config;
    if (round % 10) { /* one thread, anything */
      any_words(program, count);
      config = any_config(1, 1);
    } else { /* many that do not meet */
      count = any_program(program);
      config = any_config(any(1, 4), any(1, 32));
    }
    struct run timed = run(&config, program, count, TRAX_ENGINE_FAST, false, round % 10 ? 5000 : 0);
    struct run functional = run(&config, program, count, TRAX_ENGINE_FUNCTIONAL, false, round % 10 ? 5000 : 0);
    /* Neither counts the time of an endless loop as the other does. */
    if (timed.bench.status != TRAX_STUCK && functional.bench.status != TRAX_STUCK) {
      expect_same_effects(&timed, &functional);
      compared++;
    }
    end(&timed);
    end(&functional);
  }
  assert_true(compared > 5 * rounds);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(functional_mode),         cmocka_unit_test(own_words),    cmocka_unit_test(races),
      cmocka_unit_test(races_near_the_defaults), cmocka_unit_test(random_words),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
