/* The fast engine against the reference: random programs on random configurations, to the last count and byte.

   TRAX_RANDOM_ROUNDS and TRAX_RANDOM_SEED make it longer and different. */
#include "compare.h"

#include <stdlib.h>
#include <string.h>

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
