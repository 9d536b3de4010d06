/* Sampled simulation: what is exact is, what is estimated lies where it is said to lie. */
#include "compare.h"

#include "fast/sampled.h"

#include <math.h>
#include <string.h>

/* Tables of the distribution: 0.975 quantiles. */
static void quantiles(void **state) {
  (void)state;
  static const struct {
    uint64_t freedom;
    double value;
  } rows[] = {{1, 12.7062}, {5, 2.5706}, {12, 2.1788}, {13, 2.1604}, {20, 2.0860}, {30, 2.0423}, {100, 1.9840}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    assert_true(fabs(trax_student_95(rows[i].freedom) - rows[i].value) < 6e-4);
}

static struct trax_config plain_config(uint32_t tms, uint32_t tps) {
  struct trax_config config = TRAX_CONFIG_DEFAULT;
  config.chip.tms = tms;
  config.chip.tps_per_tm = tps;
  config.memory.size_mib = 1;
  return config;
}

static struct run sample(const struct trax_config *config, const uint32_t *program, size_t count,
                         trax_sampling sampling) {
  return run_with(config, program, count, &(trax_run_options){.engine = TRAX_ENGINE_SAMPLED, .sampling = sampling});
}

/* What ends before the first gap is simulated as ever. */
static void short_programs(void **state) {
  (void)state;
  for (unsigned seed = 1; seed <= 10; seed++) {
    random_state = 0x9E3779B97F4A7C15u * seed;
    uint32_t program[BODY + 64];
    const size_t count = any_racing_program(program);
    const struct trax_config config = any_config(any(1, 4), any(1, 32));
    const trax_sampling late = {.hold = 1000000000};
    struct run exact = run_alone(&config, program, count, TRAX_ENGINE_FAST, 0, 1);
    struct run sampled = sample(&config, program, count, late);
    expect_same(&exact, &sampled);
    const struct trax_sampling_stats *stats = &sampled.bench.machine->stats.sampling;
    assert_true(stats->is_sampled && stats->has_interval && stats->windows == 0 && stats->low == stats->high);
    end(&sampled);
    end(&exact);
  }
}

/* Windows so close that every program has some: results are complete whatever is estimated, and the accounts balance
   (or the run would end with an error). */
static void random_programs(void **state) {
  (void)state;
  uint64_t windows = 0;
  for (unsigned seed = 1; seed <= 60; seed++) {
    random_state = 0xD1B54A32D192ED03u * seed;
    uint32_t program[BODY + 64];
    const bool racing = seed % 3 == 0;
    const size_t count = racing ? any_racing_program(program) : any_program(program);
    const struct trax_config config = any_config(any(1, 4), any(1, 32));
    const trax_sampling close = {
        .period = any(100, 2000), .window = any(1, 60), .warm_up = any(1, 60), .hold = any(1, 200), .seed = any(1, 9)};
    struct run exact = run_alone(&config, program, count, TRAX_ENGINE_FAST, 0, 1);
    struct run sampled = sample(&config, program, count, close);
    const struct trax_machine *x = exact.bench.machine, *y = sampled.bench.machine;
    assert_int_not_equal(sampled.bench.status, TRAX_ERROR);
    windows += y->stats.sampling.windows;
    if (!racing) {
      assert_int_equal(sampled.bench.status, TRAX_OK);
      assert_int_equal(x->stats.instructions, y->stats.instructions);
      assert_memory_equal(x->stats.total.instructions, y->stats.total.instructions, sizeof x->stats.total.instructions);
      assert_true(memcmp(x->space.bytes, y->space.bytes, x->space.size) == 0);
    }
    end(&sampled);
    end(&exact);
  }
  assert_true(windows > 100);
}

static void estimates(void **state) {
  (void)state;
  uint32_t program[BODY + 64];
  const size_t count = item_program(program);
  struct trax_config config = plain_config(2, 32);
  struct run exact = run_alone(&config, program, count, TRAX_ENGINE_FAST, 0, 1);
  const struct trax_stats *truth = &exact.bench.machine->stats;
  unsigned hits = 0;
  double sum = 0;
  for (uint64_t seed = 1; seed <= 10; seed++) {
    const trax_sampling sampling = {.period = 100000, .hold = 4000, .seed = seed};
    struct run sampled = sample(&config, program, count, sampling);
    const struct trax_stats *stats = &sampled.bench.machine->stats;
    assert_int_equal(sampled.bench.status, TRAX_OK);
    assert_int_equal(stats->instructions, truth->instructions);
    assert_int_equal(stats->total.atomics, truth->total.atomics);
    assert_int_equal(bench_word(&sampled.bench, ITEM_COUNTER), bench_word(&exact.bench, ITEM_COUNTER));
    assert_true(stats->sampling.windows > 5 && stats->sampling.detailed_cycles < truth->cycles / 2);
    const double error = (double)stats->cycles - (double)truth->cycles;
    sum += error / (double)truth->cycles;
    assert_true(fabs(error) < stats->sampling.high - stats->sampling.low); /* twice the interval */
    assert_true(fabs((double)stats->total.dcache_misses / (double)truth->total.dcache_misses - 1) < 0.1);
    hits += stats->sampling.low <= (double)truth->cycles && (double)truth->cycles <= stats->sampling.high;
    end(&sampled);
  }
  assert_true(hits >= 8);
  assert_true(fabs(sum / 10) < 0.015); /* no bias that ten windows' noise would not explain */
  end(&exact);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(quantiles),
      cmocka_unit_test(short_programs),
      cmocka_unit_test(random_programs),
      cmocka_unit_test(estimates),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
