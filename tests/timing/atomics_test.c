/* Atomic increments: latency, uniqueness, and the order in which the controller serves TMs. */
#include "bench.h"

static void latency(void **state) {
  (void)state;
  const struct trax_config config = bench_far(1, 1);
  /* First issue in 104 (memory_test.c). ainc 105: 8 bytes are half a cycle, there in 206; the next begins in 106, there
   * 207. */
  struct bench bench =
      BENCH(config, U(LUI, 1, 1), I(AINC, 2, 1, 0), I(AINC, 3, 1, 0), S(SW, 2, 1, 4), S(SW, 3, 1, 8), HALT);
  ISSUES(&bench, 0, 104, 105, 106, 206, 207, 208);
  CHARGES(&bench, 0, TRAX_CAUSE_ICACHE_MISS, 104, TRAX_CAUSE_DATA_ATOMIC, 99);
  assert_int_equal(bench_word(&bench, DATA), 2);
  assert_int_equal(bench_word(&bench, DATA + 4), 0);
  assert_int_equal(bench_word(&bench, DATA + 8), 1);
  assert_int_equal(bench.machine->stats.total.atomics, 2);
  assert_int_equal(bench.machine->stats.total.atomic_bytes, 16);
  bench_end(&bench);
}

static void order_with_loads_and_stores(void **state) {
  (void)state;
  const struct trax_config config = bench_far(1, 1);
  /* The increment happens at the controller, after all stores issued in or before its cycle: 5 becomes 6. The load
     issued in the next cycle sees it (values are never stale), the result register later. */
  struct bench bench = BENCH(config, U(LUI, 1, 1), I(ADDI, 2, 0, 5), S(SW, 2, 1, 0), I(AINC, 3, 1, 0), I(LW, 4, 1, 0),
                             S(SW, 3, 1, 4), S(SW, 4, 1, 8), HALT);
  assert_int_equal(bench_word(&bench, DATA), 6);
  assert_int_equal(bench_word(&bench, DATA + 4), 5);
  assert_int_equal(bench_word(&bench, DATA + 8), 6);
  bench_end(&bench);
}

static void every_value_once(void **state) {
  (void)state;
  enum { THREADS = 4 * 32, EACH = 7 };
  struct trax_config config = bench_far(4, 32);
  config.icache.ports_per_bank = 1;
  config.memory.queue_depth = 5;
  /* Each thread: i = ainc(DATA); mark[i] = thread + 1; seven times. */
  struct bench bench =
      BENCH(config, U(LUI, 1, 1), I(ADDI, 2, 0, EACH), U(RDSR, 3, TRAX_SR_THREAD), I(ADDI, 3, 3, 1), I(AINC, 4, 1, 0),
            I(SLLI, 4, 4, 2), R(ADD, 4, 4, 1), S(SWNT, 3, 4, 64), I(ADDI, 2, 2, -1), B(BNE, 2, 0, -5 * 4), HALT);
  unsigned marks[THREADS] = {0};
  assert_int_equal(bench_word(&bench, DATA), THREADS * EACH);
  for (unsigned i = 0; i < THREADS * EACH; i++) {
    const uint32_t mark = bench_word(&bench, DATA + 64 + 4 * i);
    assert_in_range(mark, 1, THREADS);
    marks[mark - 1]++;
  }
  for (unsigned thread = 0; thread < THREADS; thread++)
    assert_int_equal(marks[thread], EACH);
  bench_end(&bench);
}

static void tms_take_turns(void **state) {
  (void)state;
  struct trax_config config = bench_far(3, 2);
  config.memory.atomic_bytes = 1024; /* 64 cycles on the bus */
  /* The TMs' instruction lines arrive in 104, 108, 112; their increments are made in 105, 109, 113, by both TPs at
     once. TM 0's first begins in 105; until 169 all others wait. Then the turns: TM 1, TM 2, TM 0, TM 1, TM 2. */
  struct bench bench = BENCH(config, U(LUI, 1, 1), I(AINC, 2, 1, 0), U(RDSR, 3, TRAX_SR_THREAD), I(SLLI, 3, 3, 2),
                             R(ADD, 3, 3, 1), S(SW, 2, 3, 4), HALT);
  static const uint32_t got[6] = {0, 3, 1, 4, 2, 5}; /* by thread: TM 0: 0 and 3, TM 1: 1 and 4, TM 2: 2 and 5 */
  for (unsigned thread = 0; thread < 6; thread++)
    assert_int_equal(bench_word(&bench, DATA + 4 + 4 * thread), got[thread]);
  /* The k-th is through in 105 + 64 (k + 1) and usable 100 later; the store is the sixth instruction. */
  ISSUES(&bench, 0, 104, 105, 106, 107, 108, 269, 270);
  ISSUES(&bench, 5, 112, 113, 114, 115, 116, 105 + 64 * 6 + 100, 105 + 64 * 6 + 101);
  bench_end(&bench);
}

static void result_for_r0(void **state) {
  (void)state;
  const struct trax_config config = bench_far(1, 2);
  struct bench bench = BENCH(config, U(LUI, 1, 1), I(AINC, 0, 1, 0), R(ADD, 2, 0, 0), S(SW, 0, 1, 4), HALT);
  ISSUES(&bench, 0, 104, 105, 106, 107, 108);
  assert_int_equal(bench_word(&bench, DATA), 2);
  assert_int_equal(bench_word(&bench, DATA + 4), 0);
  bench_end(&bench);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(latency),          cmocka_unit_test(order_with_loads_and_stores),
      cmocka_unit_test(every_value_once), cmocka_unit_test(tms_take_turns),
      cmocka_unit_test(result_for_r0),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
