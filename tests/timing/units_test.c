/* Shared units: who gets them, in what order, and who is charged.

   ports_per_bank is 64, so that fetching staggers nobody: all TPs issue their first instruction in cycle 1. */
#include "bench.h"

static struct trax_config lockstep(uint32_t tps) {
  struct trax_config config = bench_near(1, tps);
  config.icache.ports_per_bank = 64;
  config.icache.tps_per_cache = 64;
  return config;
}

static void adder_of_eight(void **state) {
  (void)state;
  struct trax_config config = lockstep(9);
  /* TP k of the first cluster has the adder in cycle 1 + k; TP 8 has its own. */
  struct bench bench = BENCH(config, R(FADD, 1, 0, 0), HALT);
  for (unsigned tp = 0; tp < 8; tp++) {
    ISSUES(&bench, tp, 1 + tp, 2 + tp);
    CHARGES(&bench, tp, TRAX_CAUSE_ICACHE_MISS, 1, TRAX_CAUSE_FP_ADD, tp);
  }
  ISSUES(&bench, 8, 1, 2);
  assert_int_equal(bench_cycles(&bench), 10);
  assert_int_equal(bench_total(&bench, TRAX_CAUSE_FP_ADD), 28);
  assert_int_equal(bench.machine->stats.total.fp_add_ops, 9);
  assert_int_equal(bench.machine->stats.total.flops, 9);
  bench_end(&bench);

  config.fpu.tps_per_cluster = 4; /* 0 + 1 + 2 + 3, twice */
  bench = BENCH(config, R(FADD, 1, 0, 0), HALT);
  assert_int_equal(bench_total(&bench, TRAX_CAUSE_FP_ADD), 12);
  bench_end(&bench);
}

static void turns_go_round(void **state) {
  (void)state;
  struct trax_config config = lockstep(3);
  /* Cycle 1: all ask, TP 0 wins and asks again in 2: TP 1's turn, then TP 2's, then TP 0's. */
  struct bench bench = BENCH(config, R(FADD, 1, 0, 0), R(FSUB, 2, 0, 0), R(FADD, 3, 0, 0), HALT);
  ISSUES(&bench, 0, 1, 4, 7, 8);
  ISSUES(&bench, 1, 2, 5, 8, 9);
  ISSUES(&bench, 2, 3, 6, 9, 10);
  bench_end(&bench);
}

static void the_pointer_rests_when_nobody_asks(void **state) {
  (void)state;
  struct trax_config config = lockstep(2);
  /* fadd: TP 0 in 1, TP 1 in 2; the pointer is back at 0. TP 0 has the fmul alone in 2, TP 1 in 3. The last fadd: TP 0
     asks in 3 and wins; TP 1 in 4. */
  struct bench bench = BENCH(config, R(FADD, 1, 0, 0), R(FMUL, 2, 0, 0), R(FADD, 3, 0, 0), HALT);
  ISSUES(&bench, 0, 1, 2, 3, 4);
  ISSUES(&bench, 1, 2, 3, 4, 5);
  bench_end(&bench);

  /* TP 0 alone uses the adder in 3 (TP 1 branches past it), which moves the pointer on, past cycle 4 in which nobody
     asks. Then both ask in 5: it is TP 1's turn. */
  bench = BENCH(config, U(RDSR, 1, TRAX_SR_TP), B(BNE, 1, 0, 12), R(FADD, 2, 0, 0), J(0, 12), NOP, NOP,
                R(FADD, 3, 0, 0), HALT);
  /* rdsr 1, bne 2; TP 0: fadd 3, jal 4 to index 6, fadd; TP 1: nops 3 and 4, fadd. */
  ISSUES(&bench, 0, 1, 2, 3, 4, 6, 7);
  ISSUES(&bench, 1, 1, 2, 3, 4, 5, 6);
  bench_end(&bench);
}

static void multiplier_of_eight(void **state) {
  (void)state;
  struct trax_config config = lockstep(16);
  struct bench bench = BENCH(config, R(FMUL, 1, 0, 0), HALT);
  assert_int_equal(bench_total(&bench, TRAX_CAUSE_FP_MUL), 56); /* 28 a cluster */
  assert_int_equal(bench_cycles(&bench), 10);
  bench_end(&bench);
}

static void adder_and_multiplier_are_two(void **state) {
  (void)state;
  struct trax_config config = lockstep(8);
  /* TPs 0..3 add, 4..7 multiply, in the same cycles: rdsr 1, slti 2, bne 3, then in 4: 0 + 1 + 2 + 3 conflicts each. */
  struct bench bench = BENCH(config, U(RDSR, 1, TRAX_SR_TP), I(SLTI, 2, 1, 4), B(BNE, 2, 0, 12), R(FMUL, 3, 0, 0), HALT,
                             R(FADD, 3, 0, 0), HALT);
  for (unsigned tp = 0; tp < 8; tp++)
    ISSUES(&bench, tp, 1, 2, 3, 4 + tp % 4, 5 + tp % 4);
  assert_int_equal(bench_total(&bench, TRAX_CAUSE_FP_ADD), 6);
  assert_int_equal(bench_total(&bench, TRAX_CAUSE_FP_MUL), 6);
  bench_end(&bench);
}

static void comparisons_use_the_adder(void **state) {
  (void)state;
  const uint32_t operations[] = {R(FMIN, 1, 0, 0),    R(FMAX, 1, 0, 0),   R(FEQ, 1, 0, 0),
                                 R(FLT, 1, 0, 0),     R(FLE, 1, 0, 0),    R1(FCVT_W_S, 1, 0),
                                 R1(FCVT_WU_S, 1, 0), R1(FCVT_S_W, 1, 0), R1(FCVT_S_WU, 1, 0)};
  for (unsigned i = 0; i < sizeof operations / sizeof *operations; i++) {
    struct trax_config config = lockstep(8);
    struct bench bench = BENCH(config, operations[i], HALT);
    assert_int_equal(bench_total(&bench, TRAX_CAUSE_FP_ADD), 28);
    assert_int_equal(bench.machine->stats.total.flops, 0);
    bench_end(&bench);
    config.fpu.compare_units = true;
    bench = BENCH(config, operations[i], HALT);
    assert_int_equal(bench_total(&bench, TRAX_CAUSE_FP_ADD), 0);
    assert_int_equal(bench_cycles(&bench), 3);
    bench_end(&bench);
  }
}

static void integer_multiplier_of_sixteen(void **state) {
  (void)state;
  const struct trax_config config = lockstep(32);
  struct bench bench = BENCH(config, R(MULH, 1, 0, 0), HALT);
  /* 0 + 1 + ... + 15, twice; the last has it in cycle 16. */
  assert_int_equal(bench_total(&bench, TRAX_CAUSE_INT_MUL), 240);
  assert_int_equal(bench_cycles(&bench), 18);
  bench_end(&bench);
}

static void special_unit_queues(void **state) {
  (void)state;
  struct trax_config config = lockstep(4);
  config.special.pipelined = false;
  /* One unit, 8 cycles each: TP k in 1 + 8k. */
  struct bench bench = BENCH(config, R(FDIV, 1, 0, 0), HALT);
  for (unsigned tp = 0; tp < 4; tp++) {
    ISSUES(&bench, tp, 1 + 8 * tp, 2 + 8 * tp);
    CHARGES(&bench, tp, TRAX_CAUSE_ICACHE_MISS, 1, TRAX_CAUSE_SPECIAL, 8 * tp);
  }
  assert_int_equal(bench_cycles(&bench), 27);
  bench_end(&bench);

  config.special.units_per_tm = 2; /* pairs in 1 and 9 */
  bench = BENCH(config, R(FDIV, 1, 0, 0), HALT);
  for (unsigned tp = 0; tp < 4; tp++)
    ISSUES(&bench, tp, 1 + 8 * (tp / 2), 2 + 8 * (tp / 2));
  bench_end(&bench);

  config.special.pipelined = true; /* pairs in 1 and 2 */
  bench = BENCH(config, R(FDIV, 1, 0, 0), HALT);
  for (unsigned tp = 0; tp < 4; tp++)
    ISSUES(&bench, tp, 1 + tp / 2, 2 + tp / 2);
  bench_end(&bench);
}

static void special_unit_serves_64_in_turn(void **state) {
  (void)state;
  struct trax_config config = lockstep(64);
  config.special.pipelined = false;
  const uint32_t forever[] = {R(FDIV, 0, 0, 0), J(0, -4)};
  struct bench bench = bench_begin(&config, forever, 2);
  bench_run(&bench, 1 + 64 * 8 * 5);
  /* 5 whole rounds of 64 divides of 8 cycles. */
  for (unsigned tp = 0; tp < 64; tp++) {
    uint64_t divides = 0;
    for (size_t i = 0; i < bench.issues.count; i++)
      divides += bench.issues.issue[i].tp == tp && bench.issues.issue[i].pc == TEXT;
    assert_int_equal(divides, 5);
  }
  bench_end(&bench);
}

static void precision(void **state) {
  (void)state;
  struct trax_config config = bench_near(1, 1);
  /* 1.0f / 3.0f: lui 0x3F80, lui 0x4040. Exact: 0x3EAAAAAB; with 8 bits of significand 0x3EAB0000. */
  const uint32_t program[] = {U(LUI, 1, 0x3F80), U(LUI, 2, 0x4040), R(FDIV, 3, 1, 2),
                              U(LUI, 4, 1),      S(SW, 3, 4, 0),    HALT};
  struct bench bench = bench_of(&config, program, 6);
  assert_int_equal(bench_word(&bench, DATA), 0x3EAAAAAB);
  bench_end(&bench);
  config.special.precision_bits = 8;
  bench = bench_of(&config, program, 6);
  assert_int_equal(bench_word(&bench, DATA), 0x3EAB0000);
  bench_end(&bench);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(adder_of_eight),
      cmocka_unit_test(turns_go_round),
      cmocka_unit_test(the_pointer_rests_when_nobody_asks),
      cmocka_unit_test(multiplier_of_eight),
      cmocka_unit_test(adder_and_multiplier_are_two),
      cmocka_unit_test(comparisons_use_the_adder),
      cmocka_unit_test(integer_multiplier_of_sixteen),
      cmocka_unit_test(special_unit_queues),
      cmocka_unit_test(special_unit_serves_64_in_turn),
      cmocka_unit_test(precision),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
