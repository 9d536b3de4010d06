/* One TP: latencies, the scoreboard, branches, start and end.

   With memory next to the chip (bench_near) the fetch of cycle 0 misses, the line arrives in cycle 1, and the first
   instruction is issued in cycle 1. From there on a TP that is not refused issues every cycle. The run's length is one
   more than the cycle of the halt. */
#include "bench.h"

#define CYCLE0 TRAX_CAUSE_ICACHE_MISS, 1

static void straight_line(void **state) {
  (void)state;
  const struct trax_config config = bench_near(1, 1);
  struct bench bench = BENCH(config, NOP, I(ADDI, 1, 0, 7), I(ADDI, 2, 1, 1), R(ADD, 3, 2, 2), HALT);
  /* Latency 1: each result is used in the next cycle. */
  ISSUES(&bench, 0, 1, 2, 3, 4, 5);
  CHARGES(&bench, 0, CYCLE0);
  assert_int_equal(bench_cycles(&bench), 6);
  assert_int_equal(bench_charge(&bench, 0, TRAX_CAUSE_ISSUED), 5);
  assert_int_equal(bench_charge(&bench, 0, TRAX_CAUSE_HALTED), 0);
  assert_int_equal(bench.machine->stats.instructions, 5);
  assert_int_equal(bench.machine->stats.total.icache_hits, 4); /* the first came with the line */
  assert_int_equal(bench.machine->stats.total.icache_misses, 1);
  bench_end(&bench);
}

static void special_unit_latency(void **state) {
  (void)state;
  const struct trax_config config = bench_near(1, 1);
  /* fdiv in 1: usable from 9. */
  struct bench bench = BENCH(config, R(FDIV, 1, 0, 0), R(ADD, 2, 1, 1), HALT);
  ISSUES(&bench, 0, 1, 9, 10);
  CHARGES(&bench, 0, CYCLE0, TRAX_CAUSE_DATA_SPECIAL, 7);
  assert_int_equal(bench_cycles(&bench), 11);
  bench_end(&bench);

  /* Stall on use: what is independent goes on. rb waits like ra. */
  bench = BENCH(config, R1(FRSQRT, 1, 0), NOP, NOP, R(ADD, 2, 0, 1), HALT);
  ISSUES(&bench, 0, 1, 2, 3, 9, 10);
  CHARGES(&bench, 0, CYCLE0, TRAX_CAUSE_DATA_SPECIAL, 5);
  bench_end(&bench);
}

static void results_do_not_overtake(void **state) {
  (void)state;
  const struct trax_config config = bench_near(1, 1);
  /* addi writes the register the divide is about to write: it waits until 9, and its value remains. */
  struct bench bench = BENCH(config, R(FDIV, 1, 0, 0), I(ADDI, 1, 0, 5), U(LUI, 2, 1), S(SW, 1, 2, 0), HALT);
  ISSUES(&bench, 0, 1, 9, 10, 11, 12);
  CHARGES(&bench, 0, CYCLE0, TRAX_CAUSE_DATA_SPECIAL, 7);
  assert_int_equal(bench_word(&bench, DATA), 5);
  bench_end(&bench);

  /* Nobody waits for the source registers of an earlier instruction, */
  bench = BENCH(config, R(FDIV, 1, 2, 3), I(ADDI, 2, 0, 1), I(ADDI, 3, 0, 1), HALT);
  ISSUES(&bench, 0, 1, 2, 3, 4);
  bench_end(&bench);
  /* nor for r0. */
  bench = BENCH(config, R(FDIV, 0, 2, 3), R(ADD, 4, 0, 0), HALT);
  ISSUES(&bench, 0, 1, 2, 3);
  bench_end(&bench);
  /* A conditional move reads its destination. */
  bench = BENCH(config, R(FDIV, 1, 2, 3), R(CMOVNZ, 1, 0, 0), HALT);
  ISSUES(&bench, 0, 1, 9, 10);
  bench_end(&bench);
}

static void first_register_is_blamed(void **state) {
  (void)state;
  struct trax_config config = bench_near(1, 1);
  config.fpu.mul_latency_cycles = 12;
  /* fdiv in 1 (usable 9), fmul in 2 (usable 14); the add waits for ra, r1, in 3..8 and for rb, r2, in 9..13. */
  struct bench bench = BENCH(config, R(FDIV, 1, 0, 0), R(FMUL, 2, 0, 0), R(ADD, 3, 1, 2), HALT);
  ISSUES(&bench, 0, 1, 2, 14, 15);
  CHARGES(&bench, 0, CYCLE0, TRAX_CAUSE_DATA_SPECIAL, 6, TRAX_CAUSE_DATA_OTHER, 5);
  bench_end(&bench);
  /* The other way round, r1's wait is hidden behind r2's: 3..13 for fmul. */
  bench = BENCH(config, R(FDIV, 1, 0, 0), R(FMUL, 2, 0, 0), R(ADD, 3, 2, 1), HALT);
  CHARGES(&bench, 0, CYCLE0, TRAX_CAUSE_DATA_OTHER, 11);
  bench_end(&bench);
}

static void special_unit_is_busy(void **state) {
  (void)state;
  struct trax_config config = bench_near(1, 1);
  config.special.pipelined = false;
  /* The unit is taken in 1..8. */
  struct bench bench = BENCH(config, R(FDIV, 1, 0, 0), R(FDIV, 2, 0, 0), HALT);
  ISSUES(&bench, 0, 1, 9, 10);
  CHARGES(&bench, 0, CYCLE0, TRAX_CAUSE_SPECIAL, 7);
  /* Refused seven times, but fetched once. */
  assert_int_equal(bench.machine->stats.total.icache_hits, 2);
  bench_end(&bench);

  config.special.pipelined = true;
  bench = BENCH(config, R(FDIV, 1, 0, 0), R(FDIV, 2, 0, 0), R(ADD, 3, 1, 2), HALT);
  ISSUES(&bench, 0, 1, 2, 10, 11);
  bench_end(&bench);

  config.special.pipelined = false;
  config.special.units_per_tm = 2;
  /* The third waits for the first unit, free again in 9. */
  bench = BENCH(config, R(FDIV, 1, 0, 0), R(FDIV, 2, 0, 0), R(FDIV, 3, 0, 0), HALT);
  ISSUES(&bench, 0, 1, 2, 9, 10);
  bench_end(&bench);
}

static void configured_latencies(void **state) {
  (void)state;
  struct trax_config config = bench_near(1, 1);
  config.fpu.add_latency_cycles = 3;
  config.fpu.mul_latency_cycles = 4;
  config.fpu.compare_latency_cycles = 2;
  config.int_mul.latency_cycles = 5;
  config.tp.int_latency_cycles = 6;
  /* fadd 1, use 4; fmul, use 8; feq, use 10; mul, use 15; add (the use of mul) has 6: next use 21. */
  struct bench bench = BENCH(config, R(FADD, 1, 0, 0), R(FMUL, 2, 1, 1), R(FEQ, 3, 2, 2), R(MUL, 4, 3, 3),
                             R(ADD, 5, 4, 4), R(ADD, 6, 5, 5), HALT);
  ISSUES(&bench, 0, 1, 4, 8, 10, 15, 21, 22);
  CHARGES(&bench, 0, CYCLE0, TRAX_CAUSE_DATA_OTHER, 2 + 3 + 1 + 4 + 5);
  bench_end(&bench);

  /* The latency of comparisons is theirs wherever they execute; pipelined units accept every cycle. */
  config.fpu.compare_units = true;
  bench = BENCH(config, R(FLT, 1, 0, 0), R(FADD, 2, 0, 0), R(FADD, 3, 0, 0), R(XOR, 4, 1, 1), R(XOR, 5, 3, 3), HALT);
  ISSUES(&bench, 0, 1, 2, 3, 4, 6, 7);
  assert_int_equal(bench.machine->stats.total.fp_add_ops, 2);
  bench_end(&bench);

  config = bench_near(1, 1);
  config.fpu.add_latency_cycles = 1000; /* beyond the reach of any small wheel of events */
  bench = BENCH(config, R(FADD, 1, 0, 0), R(ADD, 2, 1, 1), HALT);
  ISSUES(&bench, 0, 1, 1001, 1002);
  CHARGES(&bench, 0, CYCLE0, TRAX_CAUSE_DATA_OTHER, 999);
  bench_end(&bench);
}

static void local_memory(void **state) {
  (void)state;
  struct trax_config config = bench_near(1, 1);
  struct bench bench =
      BENCH(config, I(ADDI, 1, 0, 77), S(SW, 1, 0, -4), I(LW, 2, 0, -4), U(LUI, 3, 1), S(SW, 2, 3, 0), HALT);
  ISSUES(&bench, 0, 1, 2, 3, 4, 5, 6);
  CHARGES(&bench, 0, CYCLE0);
  assert_int_equal(bench_word(&bench, DATA), 77);
  assert_int_equal(bench.machine->stats.total.local_loads, 1);
  assert_int_equal(bench.machine->stats.total.local_stores, 1);
  assert_int_equal(bench.machine->stats.total.dcache_misses, 0);
  bench_end(&bench);

  config.tp.local_latency_cycles = 4; /* load 1, use 5 */
  bench = BENCH(config, I(LBU, 1, 0, -512), R(ADD, 2, 1, 1), HALT);
  ISSUES(&bench, 0, 1, 5, 6);
  CHARGES(&bench, 0, CYCLE0, TRAX_CAUSE_DATA_LOCAL, 3);
  bench_end(&bench);
}

static void branches(void **state) {
  (void)state;
  struct trax_config config = bench_near(1, 1);
  /* jal over two, a branch not taken, one taken over one. */
  const uint32_t program[] = {J(1, 12), NOP, NOP, B(BNE, 0, 0, 8), B(BEQ, 0, 0, 8), NOP, HALT};
  struct bench bench = bench_of(&config, program, 7);
  ISSUES(&bench, 0, 1, 2, 3, 4);
  assert_int_equal(bench.machine->stats.total.taken_branches, 2);
  bench_end(&bench);

  config.tp.branch_bubble_cycles = 3; /* jal 1, idle 2..4; bne 5, beq 6, idle 7..9, halt 10 */
  bench = bench_of(&config, program, 7);
  ISSUES(&bench, 0, 1, 5, 6, 10);
  CHARGES(&bench, 0, CYCLE0, TRAX_CAUSE_BRANCH, 6);
  bench_end(&bench);

  for (uint32_t bubble = 1; bubble <= 200; bubble++) { /* across the wheel's reach */
    config.tp.branch_bubble_cycles = bubble;
    bench = bench_of(&config, program, 7);
    ISSUES(&bench, 0, 1, bubble + 2, bubble + 3, 2 * bubble + 4);
    CHARGES(&bench, 0, CYCLE0, TRAX_CAUSE_BRANCH, 2 * bubble);
    bench_end(&bench);
  }

  /* A branch to the next instruction is none. */
  bench = BENCH(config, B(BEQ, 0, 0, 4), HALT);
  ISSUES(&bench, 0, 1, 2);
  assert_int_equal(bench.machine->stats.total.taken_branches, 0);
  bench_end(&bench);
}

static void special_registers(void **state) {
  (void)state;
  const struct trax_config config = bench_near(1, 1);
  struct bench bench =
      BENCH(config, U(LUI, 1, 1), NOP, U(RDSR, 2, TRAX_SR_CYCLE), S(SW, 2, 1, 0), U(RDSR, 3, TRAX_SR_THREADS),
            S(SW, 3, 1, 4), U(RDSR, 4, TRAX_SR_CYCLEH), S(SW, 4, 1, 8), HALT);
  assert_int_equal(bench_word(&bench, DATA), 3); /* the third instruction, the first in cycle 1 */
  assert_int_equal(bench_word(&bench, DATA + 4), 1);
  assert_int_equal(bench_word(&bench, DATA + 8), 0);
  bench_end(&bench);
}

static void exit_statuses(void **state) {
  (void)state;
  struct trax_config config = bench_near(2, 3);
  /* status = (thread - 2) if thread > 2, else 0: threads 3, 4, 5 give 1, 2, 3; the lowest counts. */
  struct bench bench = BENCH(config, U(RDSR, 1, TRAX_SR_THREAD), I(ADDI, 2, 1, -2), R(SLT, 3, 0, 2), R(CMOVZ, 2, 0, 3),
                             T(2, TRAX_TRAP_EXIT));
  assert_int_equal(trax_machine_exit_status(bench.machine), 1);
  assert_int_equal(bench.machine->exit_statuses[5], 3);
  bench_end(&bench);
}

static void end_waits_for_the_last_store(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 1);
  config.memory.bandwidth_gbps = 0.05; /* 0.1 bytes a cycle */
  /* The line of 64 bytes is through after 640 cycles and comes 100 later: lui 740, sw 741, halt 742, which writes the
     run of 4 bytes: 742..781. */
  struct bench bench = BENCH(config, U(LUI, 1, 1), S(SW, 1, 1, 0), HALT);
  ISSUES(&bench, 0, 740, 741, 742);
  assert_int_equal(bench_cycles(&bench), 782);
  assert_int_equal(bench_charge(&bench, 0, TRAX_CAUSE_HALTED), 39);
  bench_end(&bench);

  const uint32_t program[] = {U(LUI, 1, 1), S(SW, 1, 1, 0), HALT};
  for (uint64_t limit = 781; limit <= 782; limit++) { /* the run needs all of its length */
    bench = bench_begin(&config, program, 3);
    bench_run(&bench, limit);
    assert_int_equal(bench.status, limit == 782 ? TRAX_OK : TRAX_STUCK);
    assert_int_equal(bench_cycles(&bench), limit);
    bench_end(&bench);
  }
}

static void watchdog_and_interrupt(void **state) {
  (void)state;
  const struct trax_config config = bench_near(1, 2);
  const uint32_t forever[] = {J(0, 0)};
  struct bench bench = bench_begin(&config, forever, 1);
  bench_run(&bench, 1000);
  assert_int_equal(bench.status, TRAX_STUCK);
  assert_int_equal(bench_cycles(&bench), 1000);
  bench_end(&bench);

  bench = bench_begin(&config, forever, 1);
  const volatile int interrupt = 1;
  const trax_run_options options = {.interrupt = &interrupt};
  assert_int_equal(trax_machine_run(bench.machine, &options, &bench.error), TRAX_INTERRUPTED);
  bench_end(&bench);
}

static void a_machine_runs_once(void **state) {
  (void)state;
  const struct trax_config config = bench_near(1, 1);
  struct bench bench = BENCH(config, HALT);
  trax_error error;
  assert_int_equal(trax_machine_run(bench.machine, NULL, &error), TRAX_ERROR);
  assert_int_equal(trax_machine_map(bench.machine, 0x100000, 64, TRAX_PERMIT_READ, NULL, &error), TRAX_ERROR);
  bench_end(&bench);
  trax_machine *empty = trax_machine_create(&config, &error);
  assert_int_equal(trax_machine_run(empty, NULL, &error), TRAX_ERROR);
  trax_machine_destroy(empty);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(straight_line),
      cmocka_unit_test(special_unit_latency),
      cmocka_unit_test(results_do_not_overtake),
      cmocka_unit_test(first_register_is_blamed),
      cmocka_unit_test(special_unit_is_busy),
      cmocka_unit_test(configured_latencies),
      cmocka_unit_test(local_memory),
      cmocka_unit_test(branches),
      cmocka_unit_test(special_registers),
      cmocka_unit_test(exit_statuses),
      cmocka_unit_test(end_waits_for_the_last_store),
      cmocka_unit_test(watchdog_and_interrupt),
      cmocka_unit_test(a_machine_runs_once),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
