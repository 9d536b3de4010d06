/* Data cache, misses, bandwidth, write combining, the memory queue.

   With the default memory (bench_far) the first instruction line is asked for in cycle 0, takes the bus in 0..3 and
   arrives in 104: the first instruction is issued in 104. Programs stay within one line, 16 instructions, unless they
   say. */
#include "bench.h"

#define FIRST TRAX_CAUSE_ICACHE_MISS, 104

static void miss_then_hit(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 1);
  /* lui 104; lw 105 misses: bus 105..108, there in 209. Its use waits 106..208. The second load hits: 210, use 211. */
  const uint32_t program[] = {U(LUI, 1, 1), I(LW, 2, 1, 0), R(ADD, 3, 2, 2), I(LW, 4, 1, 60), R(ADD, 5, 4, 4), HALT};
  struct bench bench = bench_of(&config, program, 6);
  ISSUES(&bench, 0, 104, 105, 209, 210, 211, 212);
  CHARGES(&bench, 0, FIRST, TRAX_CAUSE_DATA_MISS, 103);
  assert_int_equal(bench_cycles(&bench), 213);
  assert_int_equal(bench.machine->stats.total.dcache_misses, 1);
  assert_int_equal(bench.machine->stats.total.dcache_hits, 1);
  assert_int_equal(bench.machine->stats.total.data_read_bytes, 64);
  bench_end(&bench);

  config.dcache.hit_latency_cycles = 3;
  bench = bench_of(&config, program, 6);
  ISSUES(&bench, 0, 104, 105, 209, 210, 213, 214);
  CHARGES(&bench, 0, FIRST, TRAX_CAUSE_DATA_MISS, 103, TRAX_CAUSE_DATA_HIT, 2);
  bench_end(&bench);
}

static void misses_merge_and_overlap(void **state) {
  (void)state;
  const struct trax_config config = bench_far(1, 1);
  /* 105 misses (there 209), 106 merges, 107 misses the next line: bus 109..112, there 213. */
  struct bench bench = BENCH(config, U(LUI, 1, 1), I(LW, 2, 1, 0), I(LW, 3, 1, 4), I(LW, 4, 1, 64), R(ADD, 5, 3, 3),
                             R(ADD, 6, 2, 2), R(ADD, 7, 4, 4), HALT);
  ISSUES(&bench, 0, 104, 105, 106, 107, 209, 210, 213, 214);
  CHARGES(&bench, 0, FIRST, TRAX_CAUSE_DATA_MISS, 101 + 2);
  assert_int_equal(bench.machine->stats.total.dcache_misses, 2);
  assert_int_equal(bench.machine->stats.total.dcache_merged, 1);
  assert_int_equal(bench.machine->stats.total.data_read_bytes, 128);
  bench_end(&bench);

  /* A load into r0 makes nobody wait, and overwriting the target does. */
  bench = BENCH(config, U(LUI, 1, 1), I(LW, 0, 1, 0), R(ADD, 2, 0, 0), I(LW, 3, 1, 4), I(ADDI, 3, 0, 1), HALT);
  ISSUES(&bench, 0, 104, 105, 106, 107, 209, 210);
  bench_end(&bench);
}

static void threads_merge(void **state) {
  (void)state;
  const struct trax_config config = bench_far(1, 4);
  /* One bank: loads of TP k in 105 + k. The first misses, the others merge, all get the line in 209. */
  struct bench bench = BENCH(config, U(LUI, 1, 1), I(LW, 2, 1, 0), R(ADD, 3, 2, 2), HALT);
  for (unsigned tp = 0; tp < 4; tp++) {
    ISSUES(&bench, tp, 104, 105 + tp, 209, 210);
    CHARGES(&bench, tp, FIRST, TRAX_CAUSE_DCACHE_BANK, tp, TRAX_CAUSE_DATA_MISS, 103 - tp);
  }
  assert_int_equal(bench.machine->stats.total.dcache_misses, 1);
  assert_int_equal(bench.machine->stats.total.dcache_merged, 3);
  bench_end(&bench);
}

static void banks_by_word(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 4);
  config.dcache.tps_per_bank = 1;
  /* Four banks. TP k loads word k: all in the same cycle; of the four the first in turn misses and the others merge. */
  const uint32_t by_word[] = {U(LUI, 1, 1),    U(RDSR, 2, TRAX_SR_TP), I(SLLI, 2, 2, 2),
                              R(ADD, 1, 1, 2), I(LW, 3, 1, 0),         HALT};
  struct bench bench = bench_of(&config, by_word, 6);
  for (unsigned tp = 0; tp < 4; tp++)
    ISSUES(&bench, tp, 104, 105, 106, 107, 108, 109);
  assert_int_equal(bench.machine->stats.total.dcache_misses, 1);
  bench_end(&bench);

  /* Words 0, 4, 8, 12 share bank 0. */
  uint32_t by_four[6];
  for (unsigned i = 0; i < 6; i++)
    by_four[i] = by_word[i];
  by_four[2] = I(SLLI, 2, 2, 4);
  bench = bench_of(&config, by_four, 6);
  for (unsigned tp = 0; tp < 4; tp++)
    ISSUES(&bench, tp, 104, 105, 106, 107, 108 + tp, 109 + tp);
  assert_int_equal(bench_total(&bench, TRAX_CAUSE_DCACHE_BANK), 6);
  bench_end(&bench);

  config.chip.tps_per_tm = 3; /* three banks: words 0, 4, 8 are in banks 0, 1, 2 */
  bench = bench_of(&config, by_four, 6);
  assert_int_equal(bench_total(&bench, TRAX_CAUSE_DCACHE_BANK), 0);
  bench_end(&bench);
}

static void eviction(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 1);
  /* DATA and DATA + 16 kB are in the same set. Loads of A, B, A, each used before the next. */
  const uint32_t program[] = {U(LUI, 1, 1),   U(LUI, 2, 1),    I(ADDI, 2, 2, 0x4000), I(LW, 3, 1, 0),  R(ADD, 4, 3, 3),
                              I(LW, 3, 2, 0), R(ADD, 4, 3, 3), I(LW, 3, 1, 4),        R(ADD, 4, 3, 3), HALT};
  struct bench bench = bench_of(&config, program, 10);
  /* lw 107 there 211; lw 212 there 316; lw 317 there 421. */
  ISSUES(&bench, 0, 104, 105, 106, 107, 211, 212, 316, 317, 421, 422);
  bench_end(&bench);
  config.dcache.ways = 2;
  bench = bench_of(&config, program, 10);
  ISSUES(&bench, 0, 104, 105, 106, 107, 211, 212, 316, 317, 318, 319);
  bench_end(&bench);
}

static void first_in_first_out(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 1);
  config.dcache.bytes = 128;
  config.dcache.ways = 2;
  /* One set of two ways: A, B, A (a hit, which does not renew A), C takes A's place, then B hits and A misses. */
  struct bench bench = BENCH(config, U(LUI, 1, 1), I(LW, 2, 1, 0), R(ADD, 0, 2, 2), I(LW, 2, 1, 64), R(ADD, 0, 2, 2),
                             I(LW, 2, 1, 4), R(ADD, 0, 2, 2), I(LW, 2, 1, 128), R(ADD, 0, 2, 2), I(LW, 2, 1, 68),
                             R(ADD, 0, 2, 2), I(LW, 2, 1, 0), R(ADD, 0, 2, 2), HALT);
  assert_int_equal(bench.machine->stats.total.dcache_misses, 4);
  assert_int_equal(bench.machine->stats.total.dcache_hits, 2);
  /* A 105-209, B 210-314, hit 315-316, C 317-421, hit 422-423, A 424-528. */
  ISSUES(&bench, 0, 104, 105, 209, 210, 314, 315, 316, 317, 421, 422, 423, 424, 528, 529);
  bench_end(&bench);
}

static void miss_registers_and_places_run_out(void **state) {
  (void)state;
  const uint32_t program[] = {U(LUI, 1, 1), I(LW, 2, 1, 0), I(LW, 3, 1, 64), R(ADD, 4, 3, 3), HALT};
  for (unsigned which = 0; which < 2; which++) {
    struct trax_config config = bench_far(1, 1);
    *(which ? &config.memory.queue_depth : &config.dcache.mshrs) = 1;
    /* The second load is refused in 106..208; the first line arrives in 209; its own in 209 + 104. */
    struct bench bench = bench_of(&config, program, 5);
    ISSUES(&bench, 0, 104, 105, 209, 313, 314);
    CHARGES(&bench, 0, FIRST, TRAX_CAUSE_MEMORY_QUEUE, 103, TRAX_CAUSE_DATA_MISS, 103);
    bench_end(&bench);
  }
}

static void past_the_cache(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 1);
  /* lwnt 105: 4 bytes are a quarter of a cycle: through before 106, there in 206. The other begins in 106. No line
   * stays. */
  struct bench bench =
      BENCH(config, U(LUI, 1, 1), I(LWNT, 2, 1, 0), I(LWNT, 3, 1, 0), R(ADD, 0, 2, 2), R(ADD, 0, 3, 3), HALT);
  ISSUES(&bench, 0, 104, 105, 106, 206, 207, 208);
  CHARGES(&bench, 0, FIRST, TRAX_CAUSE_DATA_MISS, 99);
  assert_int_equal(bench.machine->stats.total.nontemporal_read_bytes, 8);
  assert_int_equal(bench.machine->stats.total.dcache_misses, 0);
  bench_end(&bench);

  config.memory.min_transfer_bytes = 32; /* two cycles: 105..106 and 107..108: there in 207 and 209 */
  bench = BENCH(config, U(LUI, 1, 1), I(LWNT, 2, 1, 0), I(LWNT, 3, 1, 0), R(ADD, 0, 2, 2), R(ADD, 0, 3, 3), HALT);
  ISSUES(&bench, 0, 104, 105, 106, 207, 209, 210);
  assert_int_equal(bench.machine->stats.total.nontemporal_read_bytes, 64);
  bench_end(&bench);
}

struct writes {
  uint64_t requests, bytes, combined;
};

static struct writes writes_of(const struct trax_config *config, const uint32_t *program, size_t count) {
  struct bench bench = bench_of(config, program, count);
  const struct trax_tm_stats *total = &bench.machine->stats.total;
  const struct writes writes = {total->write_requests, total->written_bytes, total->combined_stores};
  bench_end(&bench);
  return writes;
}

#define WRITES(CONFIG, REQUESTS, BYTES, COMBINED, ...)                                                                 \
  do {                                                                                                                 \
    const uint32_t words[] = {U(LUI, 1, 1), __VA_ARGS__, HALT};                                                        \
    const struct writes writes = writes_of(&(CONFIG), words, sizeof words / 4);                                        \
    assert_int_equal(writes.requests, REQUESTS);                                                                       \
    assert_int_equal(writes.bytes, BYTES);                                                                             \
    assert_int_equal(writes.combined, COMBINED);                                                                       \
  } while (0)

static void stores_combine(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 1);
  WRITES(config, 1, 16, 3, S(SWNT, 1, 1, 0), S(SWNT, 1, 1, 4), S(SWNT, 1, 1, 8), S(SWNT, 1, 1, 12));
  WRITES(config, 1, 8, 1, S(SWNT, 1, 1, 4), S(SWNT, 1, 1, 0));                    /* downwards */
  WRITES(config, 1, 4, 1, S(SW, 1, 1, 0), S(SB, 1, 1, 2));                        /* within */
  WRITES(config, 1, 5, 1, S(SB, 1, 1, 4), S(SW, 1, 1, 0));                        /* bytes */
  WRITES(config, 2, 8, 0, S(SWNT, 1, 1, 0), S(SWNT, 1, 1, 8));                    /* a gap */
  WRITES(config, 2, 8, 0, S(SWNT, 1, 1, 60), S(SWNT, 1, 1, 64));                  /* the next block */
  WRITES(config, 2, 12, 1, S(SWNT, 1, 1, 0), S(SWNT, 1, 1, 8), S(SWNT, 1, 1, 4)); /* joins the latest run */
  WRITES(config, 1, 12, 2, S(SWNT, 1, 1, 0), S(SW, 1, 1, 4), S(SWNT, 1, 1, 8));   /* both kinds of store */
  config.memory.write_combining = false;
  WRITES(config, 4, 16, 0, S(SWNT, 1, 1, 0), S(SWNT, 1, 1, 4), S(SWNT, 1, 1, 8), S(SWNT, 1, 1, 12));
  config.memory.min_transfer_bytes = 32;
  WRITES(config, 1, 32, 0, S(SB, 1, 1, 0));
}

static void stores_go_around(void **state) {
  (void)state;
  const struct trax_config config = bench_far(1, 1);
  /* No line is allocated: the load after the store misses. A line that is there stays, with the new value. */
  struct bench bench = BENCH(config, U(LUI, 1, 1), S(SW, 1, 1, 0), I(LW, 2, 1, 0), R(ADD, 0, 2, 2), I(ADDI, 3, 0, 9),
                             S(SW, 3, 1, 0), I(LW, 4, 1, 0), R(ADD, 5, 4, 4), S(SW, 5, 1, 4), HALT);
  /* lw 106 there in 210: add 210, addi 211, sw 212, lw 213 hits, add 214, sw 215, halt 216. */
  ISSUES(&bench, 0, 104, 105, 106, 210, 211, 212, 213, 214, 215, 216);
  assert_int_equal(bench.machine->stats.total.store_misses, 1);
  assert_int_equal(bench.machine->stats.total.store_hits, 2);
  assert_int_equal(bench_word(&bench, DATA + 4), 18);
  bench_end(&bench);
}

static void a_full_queue_stops_stores(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 1);
  config.memory.queue_depth = 1;
  config.memory.write_combining = false;
  /* sw 105: a quarter cycle, back in 206; the second takes the place then, back in 307; so does the third, and halt
     needs none. */
  struct bench bench = BENCH(config, U(LUI, 1, 1), S(SW, 1, 1, 0), S(SW, 1, 1, 4), S(SW, 1, 1, 8), HALT);
  ISSUES(&bench, 0, 104, 105, 206, 307, 308);
  CHARGES(&bench, 0, FIRST, TRAX_CAUSE_MEMORY_QUEUE, 200);
  bench_end(&bench);

  config.memory.write_combining =
      true; /* 105 fills the buffer, 106 takes the place for it, halt waits for it until 207 */
  bench = BENCH(config, U(LUI, 1, 1), S(SW, 1, 1, 0), S(SW, 1, 1, 8), HALT);
  ISSUES(&bench, 0, 104, 105, 106, 207);
  CHARGES(&bench, 0, FIRST, TRAX_CAUSE_MEMORY_QUEUE, 100);
  bench_end(&bench);
}

static void places_go_round(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 3);
  config.memory.queue_depth = 1;
  config.dcache.tps_per_bank = 1;
  /* Three lines, three banks (words 0, 16, 32 modulo 3), one place: TPs 0, 1, 2, and TP 0 comes again before the others
     were served: it goes to the back. */
  struct bench bench = BENCH(config, U(LUI, 1, 1), U(RDSR, 2, TRAX_SR_TP), I(SLLI, 2, 2, 6), R(ADD, 1, 1, 2),
                             I(LW, 3, 1, 0), I(LW, 4, 1, 192), HALT);
  /* TP k's first in 108 + 104k; second ones after all first ones. */
  ISSUES(&bench, 0, 104, 105, 106, 107, 108, 420, 421);
  ISSUES(&bench, 1, 104, 105, 106, 107, 212, 524, 525);
  ISSUES(&bench, 2, 104, 105, 106, 107, 316, 628, 629);
  bench_end(&bench);
}

static void places_go_round_for_reads_past_the_cache(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 3);
  config.memory.queue_depth = 1;
  /* Words past the cache, two for each of three TPs, one place; each takes 101 cycles (past_the_cache). */
  struct bench bench = BENCH(config, U(LUI, 1, 1), I(LWNT, 2, 1, 0), I(LWNT, 3, 1, 0), HALT);
  ISSUES(&bench, 0, 104, 105, 408, 409);
  ISSUES(&bench, 1, 104, 206, 509, 510);
  ISSUES(&bench, 2, 104, 307, 610, 611);
  bench_end(&bench);
}

static void bandwidth_is_exact(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 1);
  config.memory.bandwidth_gbps = 1.5; /* 3 bytes a cycle */
  config.memory.write_combining = false;
  /* The instruction line is through after 21 1/3 cycles: there in 122. lui 122, stores 123..131: 36 bytes are 12 cycles
     from 123, without a gap, until 135; halt 132. */
  struct bench bench = BENCH(config, U(LUI, 1, 1), S(SW, 1, 1, 0), S(SW, 1, 1, 4), S(SW, 1, 1, 8), S(SW, 1, 1, 12),
                             S(SW, 1, 1, 16), S(SW, 1, 1, 20), S(SW, 1, 1, 24), S(SW, 1, 1, 28), S(SW, 1, 1, 32), HALT);
  ISSUES(&bench, 0, 122, 123, 124, 125, 126, 127, 128, 129, 130, 131, 132);
  assert_int_equal(bench_cycles(&bench), 135);
  bench_end(&bench);
}

static void streaming_reaches_the_bandwidth(void **state) {
  (void)state;
  static const double gbps[] = {8, 16, 1.234};
  for (unsigned i = 0; i < 3; i++) {
    struct trax_config config = bench_far(2, 8);
    config.memory.bandwidth_gbps = gbps[i];
    config.memory.size_mib = 64;
    /* Each thread reads 2000 lines of its own megabyte, eight at a time: r1 = 0x100000 * (thread + 1). */
    uint32_t program[16];
    unsigned n = 0;
    program[n++] = U(RDSR, 1, TRAX_SR_THREAD);
    program[n++] = I(ADDI, 1, 1, 1);
    program[n++] = I(SLLI, 1, 1, 20);
    program[n++] = I(ADDI, 2, 0, 250);
    for (unsigned load = 0; load < 8; load++)
      program[n++] = I(LW, 4 + load, 1, (int32_t)load * 64);
    program[n++] = I(ADDI, 1, 1, 512);
    program[n++] = I(ADDI, 2, 2, -1);
    program[n++] = B(BNE, 2, 0, -10 * 4);
    program[n++] = HALT;
    struct bench bench = bench_of(&config, program, n);
    const struct trax_stats *stats = &bench.machine->stats;
    const double moved = (double)stats->memory.bytes, possible = gbps[i] * 2 * (double)stats->cycles; /* 500 MHz */
    assert_int_equal(stats->total.data_read_bytes, 16 * 2000 * 64);
    assert_true(moved <= possible);
    assert_true(moved >= 0.99 * possible);
    bench_end(&bench);
  }
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

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(miss_then_hit),
      cmocka_unit_test(misses_merge_and_overlap),
      cmocka_unit_test(threads_merge),
      cmocka_unit_test(banks_by_word),
      cmocka_unit_test(eviction),
      cmocka_unit_test(first_in_first_out),
      cmocka_unit_test(miss_registers_and_places_run_out),
      cmocka_unit_test(past_the_cache),
      cmocka_unit_test(stores_combine),
      cmocka_unit_test(stores_go_around),
      cmocka_unit_test(a_full_queue_stops_stores),
      cmocka_unit_test(places_go_round),
      cmocka_unit_test(effects_of_one_cycle),
      cmocka_unit_test(places_go_round_for_reads_past_the_cache),
      cmocka_unit_test(bandwidth_is_exact),
      cmocka_unit_test(streaming_reaches_the_bandwidth),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
