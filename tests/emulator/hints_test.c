/* The hints of --report: each rule fires at its bounds, and does not below them. */
#define _POSIX_C_SOURCE 200809L /* open_memstream */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "report/statistics.h"

enum { CYCLES = 1000000, TMS = 4, TPS = 32, CLUSTERS = 4 };

/* A run without hints. */
static struct trax_stats quiet_run(struct trax_config *config) {
  *config = (struct trax_config)TRAX_CONFIG_DEFAULT;
  config->chip.tms = TMS;
  config->chip.tps_per_tm = TPS;
  return (struct trax_stats){.cycles = CYCLES, .threads = TMS * TPS};
}

/* The number of hints, and whether one of them has the words. */
static unsigned hints(const struct trax_stats *stats, const struct trax_config *config, const char *words) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  trax_hints_print(stats, config, out);
  fclose(out);
  unsigned count = 0;
  for (const char *at = text; (at = strstr(at, "\n  - ")); at++)
    count++;
  assert_int_equal(count > 0, size > 0);
  assert_true(!count || (strncmp(text, "\nHints\n", 7) == 0 && strstr(text, words)));
  free(text);
  return count;
}

static uint64_t busy(double share) {
  return (uint64_t)(share * CYCLES * TMS * CLUSTERS + 0.5);
}

static void test_adders(void **state) {
  (void)state;
  struct trax_config config;
  struct trax_stats stats = quiet_run(&config);
  stats.total.fp_add_ops = busy(0.9);
  stats.total.fp_mul_ops = busy(0.65);
  assert_int_equal(hints(&stats, &config, "adders are 90 % busy, the multipliers 65 %: fpu.adders_per_cluster"), 1);
  stats.total.instructions[TRAX_OP_FLT] = busy(0.9) / 4;
  assert_int_equal(hints(&stats, &config, "25 % of the adders' operations are comparisons"), 1);
  stats.total.instructions[TRAX_OP_FLT]--;
  assert_int_equal(hints(&stats, &config, "fpu.adders_per_cluster"), 1);
  stats.total.instructions[TRAX_OP_FLT] = busy(0.5);
  config.fpu.compare_units = true; /* they are not the adders' */
  assert_int_equal(hints(&stats, &config, "fpu.adders_per_cluster"), 1);
  config.fpu.adders_per_cluster = 2; /* half as busy */
  assert_int_equal(hints(&stats, &config, ""), 0);
  config.fpu.adders_per_cluster = 1;
  for (unsigned comparisons = 0; comparisons < 2; comparisons++) { /* of either rule */
    config.fpu.compare_units = comparisons == 0;
    stats.total.fp_add_ops = busy(0.9);
    stats.total.fp_mul_ops = busy(0.65) + 1;
    assert_int_equal(hints(&stats, &config, ""), 0);
    stats.total.fp_mul_ops = 0;
    stats.total.fp_add_ops = busy(0.9) - 1;
    assert_int_equal(hints(&stats, &config, ""), 0);
  }
}

static void test_multipliers(void **state) {
  (void)state;
  struct trax_config config;
  struct trax_stats stats = quiet_run(&config);
  stats.total.fp_mul_ops = busy(0.9);
  stats.total.fp_add_ops = busy(0.65);
  assert_int_equal(hints(&stats, &config, "multipliers are 90 % busy, the adders 65 %"), 1);
  stats.total.fp_add_ops++;
  assert_int_equal(hints(&stats, &config, ""), 0);
  stats.total.fp_add_ops = 0;
  stats.total.fp_mul_ops = busy(0.9) - 1;
  assert_int_equal(hints(&stats, &config, ""), 0);
}

static void test_special(void **state) {
  (void)state;
  struct trax_config config;
  struct trax_stats stats = quiet_run(&config);
  stats.total.special_ops = stats.total.instructions[TRAX_OP_FDIV] = (uint64_t)(0.9 * CYCLES * TMS);
  assert_int_equal(hints(&stats, &config, "FPDIV/iSQRT units are 90 % busy"), 1);
  config.special.units_per_tm = 2;
  assert_int_equal(hints(&stats, &config, ""), 0);
  config.special.units_per_tm = 1;
  stats.total.special_ops = --stats.total.instructions[TRAX_OP_FDIV];
  assert_int_equal(hints(&stats, &config, ""), 0);
}

static void test_memory(void **state) {
  (void)state;
  struct trax_config config;
  struct trax_stats stats = quiet_run(&config);
  const double most = trax_memory_gbps(&config) * 1e9 * CYCLES / (config.chip.clock_mhz * 1e6);
  stats.memory.bytes = (uint64_t)(0.9 * most + 1);
  assert_int_equal(hints(&stats, &config, "Off-chip memory is busy for 90 %"), 1);
  stats.memory.bytes = (uint64_t)(0.9 * most - 1);
  assert_int_equal(hints(&stats, &config, ""), 0);
}

static void test_causes(void **state) {
  (void)state;
  static const struct {
    trax_cause cause;
    double least;
    const char *words;
  } rules[] = {{TRAX_CAUSE_MEMORY_QUEUE, 0.1, "10 % of the thread-cycles no miss register"},
               {TRAX_CAUSE_ICACHE_MISS, 0.1, "instruction\n    caches of 4096 bytes"},
               {TRAX_CAUSE_DATA_ATOMIC, 0.1, "wait for atomic increments"},
               {TRAX_CAUSE_HALTED, 0.25, "25 % of the thread-cycles threads have ended"}};
  for (size_t i = 0; i < sizeof rules / sizeof *rules; i++) {
    struct trax_config config;
    struct trax_stats stats = quiet_run(&config);
    uint64_t *cycles = &stats.total.cycles[rules[i].cause];
    *cycles = (uint64_t)(rules[i].least * CYCLES * TMS * TPS);
    assert_int_equal(hints(&stats, &config, rules[i].words), 1);
    --*cycles;
    assert_int_equal(hints(&stats, &config, ""), 0);
  }
}

/* All causes but those four, all units below 0.9, and runs that are short say nothing. */
static void test_unsure(void **state) {
  (void)state;
  struct trax_config config;
  struct trax_stats stats = quiet_run(&config);
  assert_int_equal(hints(&stats, &config, ""), 0);
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++) {
    const bool has_rule = cause == TRAX_CAUSE_MEMORY_QUEUE || cause == TRAX_CAUSE_ICACHE_MISS ||
                          cause == TRAX_CAUSE_DATA_ATOMIC || cause == TRAX_CAUSE_HALTED;
    stats = quiet_run(&config);
    stats.total.cycles[cause] = (uint64_t)CYCLES * TMS * TPS;
    assert_int_equal(hints(&stats, &config, "100 %"), has_rule);
  }
  stats = quiet_run(&config);
  stats.total.fp_add_ops = busy(1);
  stats.total.cycles[TRAX_CAUSE_HALTED] = (uint64_t)CYCLES * TMS * TPS;
  assert_int_equal(hints(&stats, &config, "adders"), 2);
  stats.cycles = 9999;
  assert_int_equal(hints(&stats, &config, ""), 0);
  stats = (struct trax_stats){.threads = 1}; /* the functional engine */
  assert_int_equal(hints(&stats, &config, ""), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_adders), cmocka_unit_test(test_multipliers), cmocka_unit_test(test_special),
      cmocka_unit_test(test_memory), cmocka_unit_test(test_causes),      cmocka_unit_test(test_unsure),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
