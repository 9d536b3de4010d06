/* Runs that rules.c has no row for: loops over many programs, endless ones, ends, limits and many threads.

   With memory next to the chip (bench_near) the fetch of cycle 0 misses, the line arrives in cycle 1, and the first
   instruction is issued in cycle 1. */
#include "compare.h"

static void branch_bubbles(void **state) {
  (void)state;
  struct trax_config config = bench_near(1, 1);
  /* jal over two, a branch not taken, one taken over one. */
  const uint32_t program[] = {J(1, 12), NOP, NOP, B(BNE, 0, 0, 8), B(BEQ, 0, 0, 8), NOP, HALT};
  for (uint32_t bubble = 0; bubble <= 200; bubble++) { /* across the wheel's reach */
    config.tp.branch_bubble_cycles = bubble;
    struct bench bench = bench_of(&config, program, 7);
    ISSUES(&bench, 0, 1, bubble + 2, bubble + 3, 2 * bubble + 4);
    CHARGES(&bench, 0, TRAX_CAUSE_ICACHE_MISS, 1, TRAX_CAUSE_BRANCH, 2 * bubble);
    bench_end(&bench);
  }
}

static void comparisons_use_the_adder(void **state) {
  (void)state;
  const uint32_t operations[] = {R(FMIN, 1, 0, 0),    R(FMAX, 1, 0, 0),   R(FEQ, 1, 0, 0),
                                 R(FLT, 1, 0, 0),     R(FLE, 1, 0, 0),    R1(FCVT_W_S, 1, 0),
                                 R1(FCVT_WU_S, 1, 0), R1(FCVT_S_W, 1, 0), R1(FCVT_S_WU, 1, 0)};
  struct trax_config config = bench_near(1, 8);
  config.icache.ports_per_bank = 64;
  for (unsigned i = 0; i < sizeof operations / sizeof *operations; i++)
    for (unsigned own = 0; own < 2; own++) {
      config.fpu.compare_units = own;
      struct bench bench = BENCH(config, operations[i], HALT);
      assert_int_equal(bench_total(&bench, TRAX_CAUSE_FP_ADD), own ? 0 : 28);
      assert_int_equal(bench_cycles(&bench), own ? 3 : 10);
      assert_int_equal(bench.machine->stats.total.flops, 0);
      bench_end(&bench);
    }
}

/* An observer of stretches gets refusals with the instruction, at most 15 of a kind at once (machine/observer.h). */
static void special_unit_serves_64_in_turn(void **state) {
  (void)state;
  struct trax_config config = bench_near(1, 64);
  config.icache.ports_per_bank = 64;
  config.icache.tps_per_cache = 64;
  config.special.pipelined = false;
  const uint32_t forever[] = {R(FDIV, 0, 0, 0), J(0, -4)};
  for (unsigned stretches = 0; stretches < 2; stretches++) {
    bench_stretches = stretches;
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
  bench_stretches = false;
}

/* All fetch from the only port from cycle 0 on, and the first one's fetch brings the line. */
static void one_port_serves_64_in_turn(void **state) {
  (void)state;
  struct trax_config config = bench_near(1, 64);
  config.icache.tps_per_cache = 64;
  config.icache.banks = config.icache.ports_per_bank = 1;
  for (unsigned stretches = 0; stretches < 2; stretches++) {
    bench_stretches = stretches;
    struct bench bench = BENCH(config, NOP, HALT);
    ISSUES(&bench, 0, 1, 64);
    CHARGES(&bench, 0, TRAX_CAUSE_ICACHE_MISS, 1, TRAX_CAUSE_ICACHE_BANK, 62);
    for (unsigned tp = 1; tp < 64; tp++) {
      ISSUES(&bench, tp, tp, 64 + tp);
      CHARGES(&bench, tp, TRAX_CAUSE_ICACHE_BANK, tp + 63);
    }
    bench_end(&bench);
  }
  bench_stretches = false;
}

/* A store past the cache and a load of the same word in one cycle, 109: the effects happen in the TPs' order. */
static void effects_of_one_cycle(void **state) {
  (void)state;
  const struct trax_config config = bench_far(1, 2);
  for (int writer = 0; writer < 2; writer++)
    for (unsigned observed = 0; observed < 2; observed++) {
      const uint32_t program[] = {U(LUI, 1, 1),
                                  U(RDSR, 2, TRAX_SR_THREAD),
                                  I(ADDI, 3, 0, 7),
                                  I(ADDI, 4, 0, writer),
                                  B(BEQ, 2, 4, 6 * 4),
                                  I(LW, 5, 1, 0), /* the reader; what follows can run ahead with it */
                                  NOP,
                                  NOP,
                                  S(SW, 5, 1, 64),
                                  HALT,
                                  S(SWNT, 3, 1, 0),
                                  HALT};
      struct bench bench = bench_begin(&config, program, sizeof program / 4);
      if (observed) {
        bench_run(&bench, 0);
        assert_int_equal(bench.issues.issue[10].cycle, 109);
        assert_int_equal(bench.issues.issue[11].cycle, 109);
      } else { /* the fast engine runs further ahead when nobody looks */
        bench.status = trax_machine_run(bench.machine, NULL, &bench.error);
      }
      assert_int_equal(bench.status, TRAX_OK);
      assert_int_equal(bench_word(&bench, DATA), 7);
      assert_int_equal(bench_word(&bench, DATA + 64), writer == 0 ? 7 : 0);
      bench_end(&bench);
    }
}

/* The same for a word of a block that has been written, and whose line is in the cache, so that the load is ahead in a
   burst. Of seven distances of the two, one has both in one cycle. */
static void a_store_past_the_cache_of_a_load_ahead(void **state) {
  (void)state;
  struct trax_config config = bench_near(1, 2);
  config.icache.ports_per_bank = 64;
  unsigned in_one_cycle = 0;
  for (int distance = 0; distance < 14; distance++) {
    const int writer = distance / 7;
    const uint32_t program[] = {U(LUI, 1, 1),
                                U(RDSR, 2, TRAX_SR_THREAD),
                                I(ADDI, 3, 0, 7),
                                I(ADDI, 4, 0, writer),
                                I(LW, 5, 1, 0),
                                R(ADD, 6, 5, 5),
                                S(SW, 0, 1, 8),
                                NOP,
                                NOP,
                                B(BEQ, 2, 4, (7 + distance % 7) * 4),
                                NOP, /* the reader */
                                NOP,
                                NOP,
                                I(LW, 5, 1, 0),
                                S(SW, 5, 1, 64),
                                HALT,
                                NOP, /* the writer */
                                NOP,
                                NOP,
                                NOP,
                                NOP,
                                NOP,
                                S(SWNT, 3, 1, 0),
                                HALT};
    struct bench bench = bench_begin(&config, program, sizeof program / 4);
    bench_run(&bench, 0);
    uint64_t read = 0, written = 0;
    for (size_t i = 0; i < bench.issues.count; i++) {
      const struct trax_issue *issue = &bench.issues.issue[i];
      read = issue->pc == TEXT + 13 * 4 ? issue->cycle : read;
      written = issue->pc == TEXT + 22 * 4 ? issue->cycle : written;
    }
    in_one_cycle += read == written;
    const bool sees_it = written < read || (written == read && writer == 0);
    assert_int_equal(bench_word(&bench, DATA + 64), sees_it ? 7 : 0);
    bench_end(&bench);
    bench = bench_begin(&config, program, sizeof program / 4);
    bench.status = trax_machine_run(bench.machine, NULL, &bench.error); /* nobody looks */
    assert_int_equal(bench.status, TRAX_OK);
    assert_int_equal(bench_word(&bench, DATA + 64), sees_it ? 7 : 0);
    bench_end(&bench);
  }
  assert_int_equal(in_one_cycle, 2);
}

/* A thread that is alone runs ahead when nobody looks, but not of its own increment: the load of 106 gets 1. */
static void own_increment_before_load(void **state) {
  (void)state;
  const struct trax_config config = bench_far(1, 1);
  const uint32_t program[] = {U(LUI, 1, 1), I(AINC, 2, 1, 0), I(LW, 3, 1, 0), S(SW, 3, 1, 4), HALT};
  struct bench bench = bench_begin(&config, program, sizeof program / 4);
  bench.status = trax_machine_run(bench.machine, NULL, &bench.error);
  assert_int_equal(bench.status, TRAX_OK);
  assert_int_equal(bench_cycles(&bench), 212);
  assert_int_equal(bench_word(&bench, DATA), 1);
  assert_int_equal(bench_word(&bench, DATA + 4), 1);
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

static void the_limit_covers_the_last_store(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 1);
  config.memory.bandwidth_gbps = 0.05;
  const uint32_t program[] = {U(LUI, 1, 1), S(SW, 1, 1, 0), HALT}; /* 782 cycles: rules.c, "the last stores" */
  for (uint64_t limit = 781; limit <= 782; limit++) {
    struct bench bench = bench_begin(&config, program, 3);
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

static void expect_as_reference_until(uint64_t cycles, const struct trax_config *config, const uint32_t *words,
                                      size_t count) {
  struct run reference = run_alone(config, words, count, "reference", cycles, 1),
             run = run_alone(config, words, count, getenv("TRAX_ENGINE"), cycles, 1);
  expect_same(&reference, &run);
  end(&reference);
  end(&run);
}

static void expect_as_reference(const struct trax_config *config, const uint32_t *words, size_t count) {
  expect_as_reference_until(0, config, words, count);
}

/* Nobody observes the only TP. */
static void latencies_of_one_tp(void **state) {
  (void)state;
  struct trax_config config = bench_near(1, 1);
  for (uint32_t latency = 1; latency < 8; latency++) {
    const uint32_t program[] = {
        R(FADD, 1, 1, 2), NOP, R(FMUL, 3, 1, 1), NOP, NOP, R(FADD, 1, 3, 1), R(ADD, 4, 1, 3), NOP, NOP, NOP,
        R(FADD, 1, 1, 2), NOP, R(ADD, 4, 1, 3),  NOP, HALT};
    config.fpu.add_latency_cycles = config.fpu.mul_latency_cycles = latency;
    expect_as_reference(&config, program, sizeof program / 4);
  }
}

/* A TP waits for a word while another one runs through its loop, alone. Then the first one jumps to an instruction in
   the bank that it has used last, and the round robin of this bank is where the loop has left it. */
static void a_bank_after_one_was_awake(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 2);
  config.icache.line_bytes = 1024;
  config.icache.ports_per_bank = 1;
  config.icache.banks = 4;
  for (unsigned i = 0; i < 32; i++) {
    uint32_t words[40] = {U(LUI, 1, 1), U(RDSR, 2, TRAX_SR_THREAD), B(BNE, 2, 0, 4 * 22), I(LW, 5, 1, 0),
                          B(BEQ, 5, 5, 4 * 16)};
    size_t count = 5;
    while (count < 23)
      words[count++] = NOP;
    words[count++] = HALT;
    words[count++] = I(ADDI, 3, 0, 70);
    for (unsigned pad = 0; pad < i % 8; pad++)
      words[count++] = NOP;
    words[count++] = I(ADDI, 3, 3, -1);
    words[count++] = B(BNE, 3, 0, -4);
    words[count++] = HALT;
    config.memory.latency_cycles = 100 + i / 8;
    expect_as_reference(&config, words, count);
  }
}

/* The same for the adder: the second TP has used it last when it waits, and wants it when it has its word. */
static void an_adder_after_one_was_awake(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 2);
  config.icache.line_bytes = 1024;
  for (unsigned i = 0; i < 30; i++) {
    const int32_t pad = 13 + (int32_t)i / 10 * 3;
    uint32_t words[48] = {U(LUI, 1, 1), U(RDSR, 2, TRAX_SR_THREAD), B(BEQ, 2, 0, 4 * (pad + 5))};
    size_t count = 3;
    for (int32_t k = 0; k < pad; k++)
      words[count++] = NOP;
    words[count++] = R(FADD, 8, 8, 8);
    words[count++] = I(LW, 5, 1, 0);
    words[count++] = R(FADD, 7, 5, 5);
    words[count++] = HALT;
    words[count++] = I(ADDI, 3, 0, 70);
    words[count++] = R(FADD, 6, 6, 6); /* once in ten instructions */
    for (int32_t k = 0; k < 7; k++)
      words[count++] = NOP;
    words[count++] = I(ADDI, 3, 3, -1);
    words[count++] = B(BNE, 3, 0, -36);
    words[count++] = HALT;
    config.memory.latency_cycles = 100 + i % 10;
    expect_as_reference(&config, words, count);
  }
}

/* The second burst of the only TP stores ahead, but not there. */
static void a_store_that_faults(void **state) {
  (void)state;
  const struct trax_config config = bench_near(1, 1);
  const uint32_t program[] = {U(LUI, 1, RODATA >> 16), U(RDSR, 2, TRAX_SR_CYCLE), NOP, S(SW, 1, 1, 0), HALT};
  expect_as_reference(&config, program, sizeof program / 4);
}

/* The only TP has stored ahead when the run stops: once in an iteration, or with each instruction. */
static void a_stop_behind_stores(void **state) {
  (void)state;
  const struct trax_config config = bench_near(1, 1);
  const uint32_t loop[] = {U(LUI, 1, 1),   U(RDSR, 2, TRAX_SR_CYCLE), I(ADDI, 3, 3, 1),
                           S(SW, 3, 1, 0), I(ADDI, 1, 1, 4),          J(0, -12)};
  uint32_t stores[200] = {U(LUI, 1, 1), U(RDSR, 2, TRAX_SR_CYCLE)};
  const size_t count = sizeof stores / sizeof *stores;
  for (size_t i = 2; i < count - 1; i++)
    stores[i] = S(SW, 1, 1, (int32_t)(4 * (i * 7 % count)));
  stores[count - 1] = HALT;
  for (uint64_t cycles = 20; cycles < 200; cycles += 6) {
    expect_as_reference_until(cycles, &config, loop, sizeof loop / sizeof *loop);
    expect_as_reference_until(cycles, &config, stores, count);
  }
  expect_as_reference(&config, stores, count);
}

/* A burst that has stored a byte does not load its word, from a block that has been written before. */
static void a_byte_before_its_word(void **state) {
  (void)state;
  const struct trax_config config = bench_near(1, 2);
  const uint32_t program[] = {U(LUI, 1, 1),
                              U(RDSR, 2, TRAX_SR_THREAD),
                              I(SLLI, 2, 2, 6),
                              R(ADD, 1, 1, 2),
                              I(ADDI, 3, 0, 9),
                              I(ADDI, 3, 3, -1),
                              S(SB, 3, 1, 1),
                              I(LW, 4, 1, 0),
                              R(ADD, 5, 5, 4),
                              S(SW, 5, 1, 4),
                              NOP,
                              B(BNE, 3, 0, -6 * 4),
                              HALT};
  expect_as_reference(&config, program, sizeof program / 4);
}

/* A TP's burst has loaded a word ahead when the other TP has it written: by the host, which answers a call there, also
   after a store to its block, or by a store to what the host has filled (compare.c). */
static void a_write_behind_a_load_ahead(void **state) {
  (void)state;
  struct trax_config config = bench_near(1, 2);
  config.icache.ports_per_bank = 64;
  for (int kind = 0; kind < 3; kind++) {
    const bool filled = kind == 1;
    const int32_t place = filled ? DATA_BYTES / 4 : 0;
    uint32_t words[34] = {U(LUI, 1, 1),
                          kind == 2 ? S(SW, 0, 1, 12) : NOP,
                          U(RDSR, 2, TRAX_SR_THREAD),
                          B(BNE, 2, 0, 16),
                          NOP,
                          filled ? S(SW, 1, 1, place) : T(1, TRAX_TRAP_HOST),
                          HALT};
    size_t count = 7;
    while (count < 31)
      words[count++] = NOP;
    words[count++] = I(LW, 5, 1, place);
    words[count++] = S(SW, 5, 1, 64);
    words[count++] = HALT;
    expect_as_reference(&config, words, count);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(branch_bubbles),
      cmocka_unit_test(comparisons_use_the_adder),
      cmocka_unit_test(special_unit_serves_64_in_turn),
      cmocka_unit_test(one_port_serves_64_in_turn),
      cmocka_unit_test(effects_of_one_cycle),
      cmocka_unit_test(a_store_past_the_cache_of_a_load_ahead),
      cmocka_unit_test(own_increment_before_load),
      cmocka_unit_test(every_value_once),
      cmocka_unit_test(latencies_of_one_tp),
      cmocka_unit_test(a_store_that_faults),
      cmocka_unit_test(a_stop_behind_stores),
      cmocka_unit_test(a_write_behind_a_load_ahead),
      cmocka_unit_test(a_byte_before_its_word),
      cmocka_unit_test(a_bank_after_one_was_awake),
      cmocka_unit_test(an_adder_after_one_was_awake),
      cmocka_unit_test(exit_statuses),
      cmocka_unit_test(the_limit_covers_the_last_store),
      cmocka_unit_test(watchdog_and_interrupt),
      cmocka_unit_test(a_machine_runs_once),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
