/* Slot-sampled simulation: the estimator against numbers worked by hand and against populations whose total is known,
   and runs against exact ones. */
#include "compare.h"
#include "generate.h"

#include "sampling/estimate.h"
#include "sampling/plan.h"

#include <math.h>
#include <string.h>

static void assert_near(double value, double expected) {
  assert_true(fabs(value - expected) <= 1e-3 * fabs(expected));
}

/* Tables of Student's distribution: 0.975 quantiles. */
static void quantiles(void **state) {
  (void)state;
  static const struct {
    uint64_t freedom;
    double value;
  } rows[] = {{1, 12.7062}, {5, 2.5706}, {12, 2.1788}, {13, 2.1604}, {20, 2.0860}, {30, 2.0423}, {100, 1.9840}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    assert_true(fabs(trax_student_95(rows[i].freedom) - rows[i].value) < 6e-4);
}

/* Student's t with 2 degrees of freedom is 4.303. */
static void by_hand(void **state) {
  (void)state;
  const double ratios[] = {1, 2, 3};
  const struct trax_estimate three = trax_estimate_total(ratios, 3, 10);
  assert_near(three.total, 20);
  assert_near(three.deviation, 10 / sqrt(3.0));
  assert_near(three.half, 43.03 / sqrt(3.0));
  assert_true(three.has_interval);
  assert_false(trax_estimate_total(ratios, 1, 10).has_interval);
  assert_near(trax_estimate_total(ratios, 1, 10).total, 10);
  assert_true(trax_estimate_draws(ratios, 3, 10, 2) == 463); /* (4.303 * 1 / (2 * 0.1))^2 */
  assert_true(trax_estimate_draws(ratios, 3, 10, 200) == 3);
  assert_true(isinf(trax_estimate_draws(ratios, 3, 10, 0)));
  const double same[] = {2, 2, 2, 2};
  assert_true(trax_estimate_total(same, 4, 1).half == 0);
  assert_true(trax_estimate_draws(same, 4, 1, 0.02) == 4);

  const double sizes[] = {0, 1, 1, 4, 6}; /* the second unit has no size */
  const double places[] = {0, 0.99, 1, 3.99, 4, 5.99, 6};
  const uint32_t units[] = {0, 0, 2, 2, 3, 3, 3};
  for (size_t i = 0; i < sizeof places / sizeof *places; i++)
    assert_int_equal(trax_estimate_unit(sizes, 4, places[i]), units[i]);
}

static double uniform(void) {
  return any(0, 999999) * 1e-6;
}

/* Of a population whose costs are guessed to within 20 %, neighbours alike and a few units large: the interval of a
   sample holds the total about as often as it says, and the estimate has no bias. */
static void coverage(void **state) {
  (void)state;
  enum { UNITS = 2000, DRAWS = 30, SAMPLES = 4000 };
  static double sizes[UNITS + 1], truth[UNITS];
  random_state = 0x9E3779B97F4A7C15u;
  double total = 0, drift = 0;
  for (uint32_t i = 0; i < UNITS; i++) {
    const double size = any(0, 30) ? 1 + uniform() : 10 + 10 * uniform();
    drift = 0.9 * drift + 0.1 * (uniform() - 0.5);
    sizes[i + 1] = sizes[i] + size;
    truth[i] = 7 * size * (1 + drift + 0.4 * (uniform() - 0.5));
    total += truth[i];
  }
  unsigned hits = 0;
  double bias = 0;
  for (unsigned sample = 0; sample < SAMPLES; sample++) {
    double ratios[DRAWS];
    for (unsigned i = 0; i < DRAWS; i++) {
      const uint32_t unit = trax_estimate_unit(sizes, UNITS, sizes[UNITS] * (i + uniform()) / DRAWS);
      ratios[i] = truth[unit] / (sizes[unit + 1] - sizes[unit]);
    }
    const struct trax_estimate estimate = trax_estimate_total(ratios, DRAWS, sizes[UNITS]);
    hits += fabs(estimate.total - total) <= estimate.half;
    bias += estimate.total / total - 1;
  }
  assert_in_range(hits, 0.94 * SAMPLES, 0.98 * SAMPLES);
  assert_true(fabs(bias / SAMPLES) < 0.002);
}

/* --- runs --- */

static struct trax_config plain_config(void) {
  struct trax_config config = TRAX_CONFIG_DEFAULT;
  config.chip.tms = 2;
  config.chip.tps_per_tm = 32;
  config.memory.size_mib = 1;
  return config;
}

/* The program of items, the later ones longer. */
static size_t growing_items(uint32_t *words) {
  const size_t count = item_program(words);
  for (size_t i = 0; i < count; i++)
    if (words[i] == I(ANDI, 20, 10, 31))
      words[i] = I(SRLI, 20, 10, 5);
  return count;
}
static double turns(uint32_t item) {
  return 10 + (item >> 5);
}

/* The same by two queues, a TM's threads beginning with its own; items of every other tile, so of one of the queues,
   are longer. */
enum { TILE = 8, QUEUES = 2, LONGER = 64 };

static size_t queued_items(uint32_t *words) {
  static uint32_t plain[BODY + 64];
  const size_t plain_count = item_program(plain);
  size_t n = 0, from = 0;
  for (; plain[from] != I(AINC, 10, 12, 0); from++)
    words[n++] = plain[from];
  words[n++] = U(RDSR, 13, TRAX_SR_TM);
  words[n++] = I(ADDI, 14, 13, 0);
  const size_t next = n;
  words[n++] = I(SLLI, 15, 13, 2);
  words[n++] = R(ADD, 15, 15, 12);
  words[n++] = I(AINC, 10, 15, 0);
  words[n++] = I(SRLI, 16, 10, 3);
  words[n++] = I(SLLI, 16, 16, 1);
  words[n++] = R(ADD, 16, 16, 13);
  words[n++] = I(SLLI, 16, 16, 3);
  words[n++] = I(ANDI, 10, 10, TILE - 1);
  words[n++] = R(ADD, 10, 10, 16);
  const size_t leave = n++;
  for (from += 2; from < plain_count - 2; from++) {
    if (plain[from] == I(ANDI, 20, 10, 31)) {
      words[n++] = I(ANDI, 16, 10, TILE);
      words[n++] = I(SLLI, 16, 16, 3);
      words[n++] = I(SRLI, 20, 10, 5);
      words[n++] = R(ADD, 20, 20, 16);
    } else {
      words[n++] = plain[from];
    }
  }
  words[n] = B(BEQ, 0, 0, ((int32_t)next - (int32_t)n) * 4);
  n++;
  words[leave] = B(BGE, 10, 11, ((int32_t)n - (int32_t)leave) * 4);
  words[n++] = I(XORI, 13, 13, 1);
  words[n] = B(BNE, 13, 14, ((int32_t)next - (int32_t)n) * 4);
  n++;
  words[n++] = HALT;
  return n;
}
static double queued_turns(uint32_t item) {
  return turns(item) + (item & TILE ? LONGER : 0);
}

static struct run sample(const trax_slot_sampling *slots, unsigned host_threads) {
  uint32_t program[BODY + 64];
  const size_t count = growing_items(program);
  const struct trax_config config = plain_config();
  return run_with(&config, program, count, &(trax_run_options){.slots = slots, .host_threads = host_threads});
}

static struct run exact_run(void) {
  uint32_t program[BODY + 64];
  const size_t count = growing_items(program);
  const struct trax_config config = plain_config();
  return run_alone(&config, program, count, "fast", 0, 1);
}

static struct run queued(const trax_slot_sampling *slots, unsigned host_threads) {
  uint32_t program[2 * (BODY + 64)];
  const size_t count = queued_items(program);
  const struct trax_config config = plain_config();
  return run_with(&config, program, count, &(trax_run_options){.slots = slots, .host_threads = host_threads});
}

/* Guesses of what items cost, some per cent off. */
enum { BLOCK = 8 };
static double costs[ITEMS / BLOCK + 1];

static int guess(void **state) {
  (void)state;
  random_state = 0xD1B54A32D192ED03u;
  for (uint32_t item = 0; item < ITEMS; item++) {
    if (item % BLOCK == 0)
      costs[item / BLOCK + 1] = costs[item / BLOCK];
    costs[item / BLOCK + 1] += turns(item) * (0.9 + 0.2 * uniform());
  }
  return 0;
}

static const trax_slot_sampling some = {.counter = ITEM_COUNTER,
                                        .slots = ITEMS,
                                        .fraction = 0.3,
                                        .unit = 64,
                                        .warm_up = 128,
                                        .costs = costs,
                                        .block = BLOCK,
                                        .items = ITEMS};

/* All of it: the exact run, to the cycle and in every count. */
static void everything(void **state) {
  (void)state;
  trax_slot_sampling all = some;
  all.fraction = 1;
  struct run exact = exact_run(), sampled = sample(&all, 1);
  expect_same(&exact, &sampled);
  const struct trax_sampling_stats *stats = &sampled.bench.machine->stats.sampling;
  assert_true(stats->is_sampled);
  assert_true(stats->low == (double)exact.bench.machine->stats.cycles && stats->low == stats->high);
  assert_int_equal(stats->detailed_slots, ITEMS);
  end(&sampled);
  all = some;
  all.warm_up = 2000; /* too long to leave anything out */
  sampled = sample(&all, 2);
  expect_same(&exact, &sampled);
  end(&sampled);
  end(&exact);
}

/* How many seeds the intervals are counted over, and how many of them must hold the truth: 95 % are expected. */
static unsigned seeds(void) {
  return setting("TRAX_WHOLE", 0) ? 20 : 10;
}
static unsigned least_hits(void) {
  return seeds() * 17 / 20;
}

static void some_of_it(void **state) {
  (void)state;
  struct run exact = exact_run();
  const struct trax_stats *truth = &exact.bench.machine->stats;
  double widths[2];
  for (int guessed = 0; guessed < 2; guessed++) {
    unsigned hits = 0;
    double sum = 0, width = 0;
    for (uint64_t seed = 1; seed <= seeds(); seed++) {
      trax_slot_sampling asked = some;
      asked.costs = guessed ? costs : NULL;
      asked.seed = seed;
      struct run sampled = sample(&asked, 1);
      const struct trax_stats *stats = &sampled.bench.machine->stats;
      const struct trax_sampling_stats *sampling = &stats->sampling;
      assert_int_equal(sampled.bench.status, TRAX_OK);
      assert_true(sampling->windows >= 12 && sampling->detailed_cycles < 3 * truth->cycles / 4);
      assert_int_equal(stats->total.items, ITEMS);
      const double error = (double)stats->cycles / (double)truth->cycles - 1;
      sum += error;
      width += (sampling->high - sampling->low) / (double)truth->cycles;
      hits += sampling->low <= (double)truth->cycles && (double)truth->cycles <= sampling->high;
      if (guessed) { /* what is counted goes with the cycles */
        assert_true(fabs((double)stats->total.dcache_misses / (double)truth->total.dcache_misses - 1) < 0.15);
        assert_true(fabs((double)stats->instructions / (double)truth->instructions - 1) < 0.1);
      }
      end(&sampled);
    }
    assert_true(fabs(sum / seeds()) < (guessed ? 0.01 : 0.1));
    assert_in_range(hits, least_hits(), seeds());
    widths[guessed] = width / seeds();
  }
  assert_true(widths[1] < 0.2 && widths[0] > 2 * widths[1]); /* a guess is worth it */
  end(&exact);
}

/* One item in the middle takes half of the exact run, in which the others go on beside it. */
enum { LONG_ITEM = 2600, LOG2_TURNS = 13 };

static size_t items_with_a_long_one(uint32_t *words) {
  uint32_t plain[BODY + 64];
  const size_t plain_count = item_program(plain);
  size_t n = 0, next = 0;
  for (size_t from = 0; from < plain_count; from++) {
    if (plain[from] == I(AINC, 10, 12, 0))
      next = n;
    if (plain[from] == I(ANDI, 20, 10, 31)) {
      words[n++] = I(XORI, 16, 10, LONG_ITEM);
      words[n++] = I(ADDI, 16, 16, -1);
      words[n++] = I(SRLI, 16, 16, 31); /* 1: it was 0 */
      words[n++] = I(SLLI, 16, 16, LOG2_TURNS);
      words[n++] = I(SRLI, 20, 10, 5);
      words[n++] = R(ADD, 20, 20, 16);
    } else {
      words[n++] = plain[from];
    }
  }
  words[n - 2] = B(BEQ, 0, 0, ((int32_t)next - (int32_t)(n - 2)) * 4);
  words[next + 1] = B(BGE, 10, 11, ((int32_t)(n - 1) - (int32_t)(next + 1)) * 4);
  return n;
}

/* A thread that is in a long item at a jump may be the last to end. The interval includes the exact run, which has
   passed the item by then. */
static void a_long_item(void **state) {
  (void)state;
  uint32_t program[BODY + 64];
  const size_t count = items_with_a_long_one(program);
  const struct trax_config config = plain_config();
  struct run exact = run_alone(&config, program, count, "fast", 0, 1);
  const double truth = (double)exact.bench.machine->stats.cycles;
  unsigned hits = 0, late = 0;
  for (uint64_t seed = 1; seed <= seeds(); seed++) {
    trax_slot_sampling asked = some;
    asked.seed = seed;
    asked.fraction = 0.1, asked.unit = 64, asked.warm_up = 64;
    struct run sampled = run_with(&config, program, count, &(trax_run_options){.slots = &asked, .host_threads = 1});
    const struct trax_stats *stats = &sampled.bench.machine->stats;
    assert_int_equal(sampled.bench.status, TRAX_OK);
    hits += stats->sampling.low <= truth && truth <= stats->sampling.high;
    late += (double)stats->cycles - stats->sampling.low > 1.5 * (stats->sampling.high - (double)stats->cycles);
    end(&sampled);
  }
  assert_in_range(hits, least_hits(), seeds());
  assert_in_range(late, 1, seeds() - 1); /* not in runs that leave the item out */
  end(&exact);
}

/* The choice and the result depend on the seed alone. */
static void repeatable(void **state) {
  (void)state;
  struct run one = sample(&some, 1), two = sample(&some, 2);
  expect_same(&one, &two);
  trax_slot_sampling other = some;
  other.seed = 2;
  struct run three = sample(&other, 1);
  assert_int_not_equal(one.bench.machine->stats.cycles, three.bench.machine->stats.cycles);
  end(&three);
  end(&two);
  end(&one);
}

/* As many draws as an interval takes: it is as narrow as asked, or the run ends with an error. */
static void as_asked(void **state) {
  (void)state;
  const double errors[] = {0.2, 0.1, 0.08, 0.06};
  enum { ERRORS = sizeof errors / sizeof *errors };
  unsigned reached = 0, refused = 0, extended = 0;
  for (unsigned i = 0; i < ERRORS; i++)
    for (uint64_t seed = 1; seed <= 3; seed++) {
      trax_slot_sampling asked = some;
      asked.error = errors[i];
      asked.warm_up = 16;
      asked.unit = 32;
      asked.seed = seed;
      struct run sampled = sample(&asked, 1);
      const struct trax_stats *stats = &sampled.bench.machine->stats;
      if (sampled.bench.status == TRAX_ERROR) {
        assert_non_null(strstr(sampled.bench.error.message, "would take more ranges than there is work for"));
        refused++;
      } else {
        assert_int_equal(sampled.bench.status, TRAX_OK);
        assert_true(stats->sampling.high - (double)stats->cycles <= errors[i] * (double)stats->cycles + 1);
        assert_true(stats->sampling.high > (double)stats->cycles);
        extended += stats->sampling.windows > 24;
        reached++;
      }
      end(&sampled);
    }
  assert_true(reached >= 5 && refused >= 2 && extended >= 1);
}

/* Sizes near the end of 32 bits are more than all slots: everything is simulated. */
static void large_sizes(void **state) {
  (void)state;
  struct run exact = exact_run();
  const uint32_t sizes[][2] = {{UINT32_MAX, 0}, {UINT32_MAX - 7, UINT32_MAX - 7}, {64, UINT32_MAX - ITEMS}};
  for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
    trax_slot_sampling asked = some;
    asked.unit = sizes[i][0];
    asked.warm_up = sizes[i][1];
    struct run sampled = sample(&asked, 1);
    expect_same(&exact, &sampled);
    end(&sampled);
  }
  end(&exact);
}

/* Two queues that are handed out at the pace of what their items take: the longer ones' falls behind. */
static double queued_costs[ITEMS / BLOCK + 1];
static uint32_t handed_out[(ITEMS / BLOCK + 1) * QUEUES];

static void go_through_queues(void) {
  double at[QUEUES] = {0}; /* when the queue hands out its next item */
  uint32_t taken[QUEUES] = {0};
  for (uint32_t place = 0; place <= ITEMS; place++) {
    const bool none[QUEUES] = {taken[0] == ITEMS / 2, taken[1] == ITEMS / 2};
    const unsigned queue = none[0] || (!none[1] && at[1] < at[0]);
    if (place % BLOCK == 0) {
      memcpy(&handed_out[place / BLOCK * QUEUES], taken, sizeof taken);
      queued_costs[place / BLOCK] = fmax(at[queue], place ? queued_costs[place / BLOCK - 1] : 0);
    }
    const uint32_t item = (taken[queue] / TILE * QUEUES + queue) * TILE + taken[queue] % TILE;
    at[queue] += queued_turns(item) / (none[0] || none[1] ? 2 : 1); /* both TMs take those of one queue */
    taken[queue] += place < ITEMS;
  }
}

static void several_queues(void **state) {
  (void)state;
  go_through_queues();
  trax_slot_sampling asked = some;
  asked.queues = QUEUES;
  asked.tile = TILE;
  asked.costs = queued_costs;
  asked.handed_out = handed_out;
  asked.warm_up = 64;
  asked.fraction = 1;
  struct run exact = queued(NULL, 1), all = queued(&asked, 1);
  expect_same(&exact, &all);
  end(&all);
  asked.fraction = 0.2;
  const double truth = (double)exact.bench.machine->stats.cycles;
  uint32_t counters[QUEUES];
  memcpy(counters, exact.bench.machine->space.bytes + ITEM_COUNTER, sizeof counters);
  assert_true(counters[0] > ITEMS / 2 && counters[1] > ITEMS / 2); /* both are empty, and somebody has seen it */
  double sums[2] = {0};
  unsigned hits = 0;
  enum { IN_STEP = 4 };
  for (int in_step = 0; in_step < 2; in_step++)
    for (uint64_t seed = 1; seed <= (in_step ? IN_STEP : seeds()); seed++) {
      asked.handed_out = in_step ? NULL : handed_out;
      asked.seed = seed;
      struct run sampled = queued(&asked, 1);
      const struct trax_stats *stats = &sampled.bench.machine->stats;
      assert_int_equal(sampled.bench.status, TRAX_OK);
      assert_true(stats->sampling.windows >= 12 && (double)stats->sampling.detailed_cycles < 0.8 * truth);
      assert_int_equal(stats->total.items, ITEMS);
      sums[in_step] += (double)stats->cycles / truth - 1;
      hits += !in_step && stats->sampling.low <= truth && truth <= stats->sampling.high;
      end(&sampled);
    }
  assert_true(hits >= least_hits() && fabs(sums[0] / seeds()) < 0.01);
  assert_true(sums[1] / IN_STEP < -0.02); /* in step, short items would be seen too often */
  struct run one = queued(&asked, 1), two = queued(&asked, 2);
  expect_same(&one, &two);
  end(&two);
  end(&one);
  end(&exact);
}

static void refusals_of_queues(void **state) {
  (void)state;
  static uint32_t wrong[2][(ITEMS / BLOCK + 1) * QUEUES];
  go_through_queues();
  memcpy(wrong[0], handed_out, sizeof handed_out);
  memcpy(wrong[1], handed_out, sizeof handed_out);
  wrong[0][100]++;
  wrong[1][100]--, wrong[1][101]++, wrong[1][98]++, wrong[1][99]--; /* the first goes back */
  wrong[1][98] += BLOCK, wrong[1][99] -= BLOCK;
  trax_slot_sampling cases[5];
  for (size_t i = 0; i < 5; i++) {
    cases[i] = some;
    cases[i].queues = QUEUES;
    cases[i].tile = TILE;
  }
  cases[0].queues = TRAX_MAX_SLOT_QUEUES + 1;
  cases[1].tile = 0;
  cases[2].tile = 7;
  cases[3].handed_out = wrong[0];
  cases[4].handed_out = wrong[1];
  const char *const words[] = {"65 queues; allowed are 64", "not whole tiles of 0", "not whole tiles of 7",
                               "401 slots at slot 400", "cannot have handed out"};
  for (size_t i = 0; i < 5; i++) {
    struct run sampled = queued(&cases[i], 1);
    assert_int_equal(sampled.bench.status, TRAX_ERROR);
    if (!strstr(sampled.bench.error.message, words[i]))
      fail_msg("%s", sampled.bench.error.message);
    end(&sampled);
  }
}

/* A round of all queues has 2^32 slots. */
static void large_tiles(void **state) {
  (void)state;
  const trax_slot_sampling asked = {.slots = 3u << 30, .queues = 4, .tile = 1u << 30, .block = 1};
  assert_int_equal(trax_slot_plan_handed_out(&asked, 0, 5), 5);
  assert_int_equal(trax_slot_plan_handed_out(&asked, 1, 5), 0);
  assert_int_equal(trax_slot_plan_handed_out(&asked, 1, (1u << 30) + 7), 7);
  assert_int_equal(trax_slot_plan_handed_out(&asked, 0, (1u << 30) + 7), 1u << 30);
}

static void refusals(void **state) {
  (void)state;
  static double wrong[ITEMS / BLOCK + 1];
  for (size_t i = 0; i <= ITEMS / BLOCK; i++)
    wrong[i] = (double)i;
  wrong[ITEMS / BLOCK / 2] = 1e9; /* the next one costs less than nothing */
  trax_slot_sampling cases[9];
  for (size_t i = 0; i < 9; i++)
    cases[i] = some;
  cases[8].error = 0.01;
  cases[0].counter = ITEM_COUNTER + 2;
  cases[1].counter = 0x7FFFFFFC;
  cases[2].slots = 0;
  cases[3].fraction = 0;
  cases[4].fraction = 1.5;
  cases[5].error = 1;
  cases[6].block = 0;
  cases[7].costs = wrong;
  const char *const words[] = {"is not a word",
                               "is not a word",
                               "no slots",
                               "is 0; allowed",
                               "is 1.5; allowed",
                               "error wanted is 1",
                               "need the number",
                               "not a number of 0 or more",
                               "wanted is 1 %; no interval is narrower"};
  for (size_t i = 0; i < 9; i++) {
    struct run sampled = sample(&cases[i], 1);
    assert_non_null(strstr(sampled.bench.error.message, words[i]));
    end(&sampled);
  }
  trax_slot_sampling elsewhere = some;
  elsewhere.counter = ITEM_COUNTER + 4; /* which nobody increments */
  struct run sampled = sample(&elsewhere, 1);
  assert_int_equal(sampled.bench.status, TRAX_ERROR);
  assert_non_null(strstr(sampled.bench.error.message, "not taken by increments"));
  end(&sampled);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(quantiles),          cmocka_unit_test(by_hand),
      cmocka_unit_test(coverage),           cmocka_unit_test(everything),
      cmocka_unit_test(some_of_it),         cmocka_unit_test(a_long_item),
      cmocka_unit_test(repeatable),         cmocka_unit_test(as_asked),
      cmocka_unit_test(several_queues),     cmocka_unit_test(refusals),
      cmocka_unit_test(refusals_of_queues), cmocka_unit_test(large_sizes),
      cmocka_unit_test(large_tiles),
  };
  return cmocka_run_group_tests(tests, guess, NULL);
}
