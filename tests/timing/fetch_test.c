/* Instruction caches: banks, round robin, misses and merging, groups. */
#include "bench.h"

static void startup_staggers(void **state) {
  (void)state;
  const struct trax_config config = bench_near(1, 2);
  struct bench bench = BENCH(config, NOP, NOP, NOP, NOP, HALT);
  /* Cycle 0: both want bank 0; TP 0 wins and misses. Cycle 1: the line serves TP 0 without a bank, TP 1 wins bank 0;
     both issue. Cycle 2: both want bank 1, TP 0 wins. From cycle 3 on TP 1 follows one bank behind. */
  ISSUES(&bench, 0, 1, 2, 3, 4, 5);
  ISSUES(&bench, 1, 1, 3, 4, 5, 6);
  CHARGES(&bench, 0, TRAX_CAUSE_ICACHE_MISS, 1);
  CHARGES(&bench, 1, TRAX_CAUSE_ICACHE_BANK, 2);
  assert_int_equal(bench_cycles(&bench), 7);
  assert_int_equal(bench_charge(&bench, 0, TRAX_CAUSE_HALTED), 1);
  bench_end(&bench);
}

static void sixteen_start(void **state) {
  (void)state;
  const struct trax_config config = bench_near(1, 16);
  struct bench bench = BENCH(config, HALT);
  /* As above for TPs 0 and 1; then bank 0 serves one a cycle: TP k in cycle k. Conflicts: TP k waits in cycles 0..k-1.
   */
  for (unsigned tp = 0; tp < 16; tp++)
    ISSUES(&bench, tp, tp ? tp : 1);
  for (unsigned tp = 1; tp < 16; tp++)
    CHARGES(&bench, tp, TRAX_CAUSE_ICACHE_BANK, tp);
  assert_int_equal(bench_cycles(&bench), 16);
  bench_end(&bench);
}

static void one_bank_is_shared_fairly(void **state) {
  (void)state;
  const struct trax_config config = bench_near(1, 4);
  const uint32_t forever[] = {J(0, 0)};
  struct bench bench = bench_begin(&config, forever, 1);
  bench_run(&bench, 13);
  /* Cycle 1: TP 0 by the line, TP 1 by the bank, whose pointer is then at 2. */
  ISSUES(&bench, 0, 1, 4, 8, 12);
  ISSUES(&bench, 1, 1, 5, 9);
  ISSUES(&bench, 2, 2, 6, 10);
  ISSUES(&bench, 3, 3, 7, 11);
  bench_end(&bench);
}

static void two_ports(void **state) {
  (void)state;
  struct trax_config config = bench_near(1, 3);
  config.icache.ports_per_bank = 2;
  struct bench bench = BENCH(config, NOP, NOP, HALT);
  /* Cycle 0: TP 0 misses, TP 1 merges, TP 2 is refused. Cycle 1: the line serves 0 and 1, the bank serves 2. Cycle 2:
     bank 1 serves 0 and 1, TP 2 comes a cycle later. */
  ISSUES(&bench, 0, 1, 2, 3);
  ISSUES(&bench, 1, 1, 2, 3);
  ISSUES(&bench, 2, 1, 3, 4);
  CHARGES(&bench, 1, TRAX_CAUSE_ICACHE_MISS, 1);
  CHARGES(&bench, 2, TRAX_CAUSE_ICACHE_BANK, 2);
  assert_int_equal(bench.machine->stats.total.icache_misses, 1);
  assert_int_equal(bench.machine->stats.total.icache_merged, 1);
  bench_end(&bench);
}

static void groups_have_their_own_cache(void **state) {
  (void)state;
  struct trax_config config = bench_near(1, 4);
  config.icache.tps_per_cache = 2;
  struct bench bench = BENCH(config, NOP, NOP, HALT);
  /* Both groups behave like the two TPs of startup_staggers. */
  for (unsigned group = 0; group < 2; group++) {
    ISSUES(&bench, 2 * group, 1, 2, 3);
    ISSUES(&bench, 2 * group + 1, 1, 3, 4);
  }
  assert_int_equal(bench.machine->stats.total.icache_misses, 2);
  assert_int_equal(bench.machine->stats.total.instruction_read_bytes, 2048);
  bench_end(&bench);
}

static void different_banks_are_parallel(void **state) {
  (void)state;
  struct trax_config config = bench_near(1, 2);
  /* One port. Cycle 1: both issue rdsr (see startup_staggers). TP 0: beq in 2, taken (tp == 0) to index 4 in 3. TP 1:
     beq in 3, index 2 in 4, index 3 in 5. Never again in each other's way. With a single bank they always are. */
  const uint32_t program[] = {U(RDSR, 1, TRAX_SR_TP), B(BEQ, 1, 0, 12), NOP, HALT, HALT};
  struct bench bench = bench_of(&config, program, 5);
  ISSUES(&bench, 0, 1, 2, 3);
  ISSUES(&bench, 1, 1, 3, 4, 5);
  bench_end(&bench);

  config.icache.banks = 1;
  bench = bench_of(&config, program, 5);
  /* Cycle 1: TP 1 has the bank. 2: TP 0. 3: TP 1, whose turn it is. 4: TP 0's last. 5, 6: TP 1. */
  ISSUES(&bench, 0, 1, 2, 4);
  ISSUES(&bench, 1, 1, 3, 5, 6);
  CHARGES(&bench, 0, TRAX_CAUSE_ICACHE_MISS, 1, TRAX_CAUSE_ICACHE_BANK, 1);
  CHARGES(&bench, 1, TRAX_CAUSE_ICACHE_BANK, 3);
  bench_end(&bench);
}

static void lines_come_from_memory(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 1);
  uint32_t program[32];
  for (unsigned i = 0; i < 31; i++)
    program[i] = NOP;
  program[31] = HALT;
  /* Two lines of 16 instructions. Asked in 0: 4 cycles on the bus and 100: there in 104. 104..119 issue; the second
     asked in 120, there in 224; 224..239 issue. */
  struct bench bench = bench_of(&config, program, 32);
  assert_int_equal(bench_cycles(&bench), 240);
  CHARGES(&bench, 0, TRAX_CAUSE_ICACHE_MISS, 208);
  assert_int_equal(bench.machine->stats.total.instruction_read_bytes, 128);
  bench_end(&bench);
}

static void thrashing_and_ways(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 1);
  config.icache.bytes = 128;
  config.icache.line_bytes = 64;
  /* Three turns between index 0 (line 0) and index 32 (line 2 of the same set, when direct mapped). */
  uint32_t program[36] = {[0] = I(ADDI, 1, 1, 1), [1] = J(0, 31 * 4), [2] = HALT};
  program[32] = I(SLTI, 2, 1, 3);
  program[33] = B(BNE, 2, 0, -33 * 4); /* to index 0 */
  program[34] = J(0, -32 * 4);         /* to index 2 */
  /* Direct mapped: every change of line misses, 104 cycles each: lines 0, 2, 0, 2, 0, 2, 0. Issued: 3 * 4 + 1 + 1. */
  struct bench bench = bench_of(&config, program, 36);
  assert_int_equal(bench_cycles(&bench), 7 * 104 + 14);
  CHARGES(&bench, 0, TRAX_CAUSE_ICACHE_MISS, 7 * 104);
  bench_end(&bench);

  config.icache.ways = 2;
  bench = bench_of(&config, program, 36);
  assert_int_equal(bench_cycles(&bench), 2 * 104 + 14);
  bench_end(&bench);
}

static void fetches_need_a_place(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 2);
  config.icache.tps_per_cache = 1;
  config.memory.queue_depth = 1;
  /* TP 0's line has the only place in 0..103; its completion frees it in 104, TP 1 asks in 104: there in 208. */
  struct bench bench = BENCH(config, HALT);
  ISSUES(&bench, 0, 104);
  ISSUES(&bench, 1, 208);
  CHARGES(&bench, 1, TRAX_CAUSE_MEMORY_QUEUE, 104, TRAX_CAUSE_ICACHE_MISS, 104);
  bench_end(&bench);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(startup_staggers),
      cmocka_unit_test(sixteen_start),
      cmocka_unit_test(one_bank_is_shared_fairly),
      cmocka_unit_test(two_ports),
      cmocka_unit_test(groups_have_their_own_cache),
      cmocka_unit_test(different_banks_are_parallel),
      cmocka_unit_test(lines_come_from_memory),
      cmocka_unit_test(thrashing_and_ways),
      cmocka_unit_test(fetches_need_a_place),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
