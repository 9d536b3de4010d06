/* What goes beyond the paper: a second-level cache, several channels, the least recently used line, units that are
   shared in other ways, and latencies of their own.

   With bench_far and the second-level cache of `far_l2`, the first instruction line misses in both caches in cycle 0,
   takes the bus in 0..3, arrives at the second level in 104 and at the TM in 124: the first instruction is issued in
   124. DATA and the program's line have even line numbers, both of bank 0. */
#include "compare.h"

#include "fast/memory.h"

#include <stdlib.h>
#include <string.h>

enum { LINE_A = 0, LINE_B = 64, LINE_C = 128 }; /* lines of DATA */

static struct trax_config far_l2(uint32_t tms) {
  struct trax_config config = bench_far(tms, 1);
  config.dcache.bytes = 64; /* one line */
  config.l2.bytes = 4096;
  return config;
}

static const struct trax_memory_stats *beyond(const struct bench *bench) {
  return &bench->machine->stats.memory;
}

/* A load, and an addition that waits for it. */
#define USE(RD, OFFSET) I(LW, RD, 1, OFFSET), R(ADD, 0, RD, RD)

static void second_level_misses_and_hits(void **state) {
  (void)state;
  const struct trax_config config = far_l2(1);
  /* A: looked up in 125, bus 125..128, second level 229, here 249. B likewise from 250: 374. A is no longer in the data
     cache, but in the second level: looked up in 375, here 395. */
  struct bench bench = BENCH(config, U(LUI, 1, 1), USE(2, LINE_A), USE(2, LINE_B), USE(2, LINE_A), HALT);
  ISSUES(&bench, 0, 124, 125, 249, 250, 374, 375, 395, 396);
  CHARGES(&bench, 0, TRAX_CAUSE_ICACHE_MISS, 124, TRAX_CAUSE_DATA_MISS, 123 + 123 + 19);
  assert_int_equal(bench_cycles(&bench), 397);
  assert_int_equal(beyond(&bench)->l2_misses, 3);
  assert_int_equal(beyond(&bench)->l2_hits, 1);
  assert_int_equal(beyond(&bench)->l2_served_bytes, 64);
  assert_int_equal(beyond(&bench)->bytes, 3 * 64); /* the bandwidth behind it is saved */
  assert_int_equal(bench.machine->stats.total.data_read_bytes, 3 * 64);
  bench_end(&bench);
}

static void second_level_lines_are_longer(void **state) {
  (void)state;
  struct trax_config config = far_l2(1);
  config.l2.line_bytes = 256; /* 16 cycles of the bus */
  /* The program's line in 0..15: 116, here 136. A with B: looked up in 137, bus 137..152, 253, here 273. */
  struct bench bench = BENCH(config, U(LUI, 1, 1), USE(2, LINE_A), USE(2, LINE_B), HALT);
  ISSUES(&bench, 0, 136, 137, 273, 274, 294, 295);
  assert_int_equal(beyond(&bench)->l2_read_bytes, 2 * 256);
  bench_end(&bench);
}

static void a_bank_takes_one_request(void **state) {
  (void)state;
  const struct trax_config config = far_l2(2);
  /* The program's line: TM 0 misses in 0, TM 1 merges in 1, both have it in 124. A: the same in 125 and 126. B is in
     bank 1: TM 0 misses in 250, TM 1 merges. A again: TM 0 hits in 375, TM 1 in 376. */
  struct bench bench = BENCH(config, U(LUI, 1, 1), USE(2, LINE_A), USE(2, LINE_B), USE(2, LINE_A), HALT);
  ISSUES(&bench, 0, 124, 125, 249, 250, 374, 375, 395, 396);
  ISSUES(&bench, 1, 124, 125, 249, 250, 374, 375, 396, 397);
  assert_int_equal(beyond(&bench)->l2_misses, 3);
  assert_int_equal(beyond(&bench)->l2_merged, 3);
  assert_int_equal(beyond(&bench)->l2_hits, 2);
  assert_int_equal(beyond(&bench)->bytes, 3 * 64);
  bench_end(&bench);
}

static void second_level_miss_registers_run_out(void **state) {
  (void)state;
  struct trax_config config = far_l2(1);
  config.l2.mshrs = 1;
  config.dcache.bytes = 128;
  /* A has the register from 125 until it arrives in 229. B, asked for in 126, is refused in 126..228 and misses in 229,
     after A has freed the register: bus 229..232, 333, here 353. */
  struct bench bench =
      BENCH(config, U(LUI, 1, 1), I(LW, 2, 1, LINE_A), I(LW, 3, 1, LINE_B), R(ADD, 0, 2, 2), R(ADD, 0, 3, 3), HALT);
  ISSUES(&bench, 0, 124, 125, 126, 249, 353, 354);
  assert_int_equal(beyond(&bench)->l2_refused, 103);
  bench_end(&bench);

  /* A refused request lets the other TM pass: its pointer has moved. TM 1 merges with TM 0's A in 126. */
  config = far_l2(2);
  config.l2.mshrs = 1;
  config.l2.banks = 1;
  config.dcache.bytes = 128;
  /* TM 0: A 125, B 127 (an addition in between); TM 1: B 125, A 126. In 125 both wait; TM 0's A misses, in 126 it is TM
     1's turn: B is refused. 127: TM 0's B is refused; 128: TM 1's B; and so on until 228, which is TM 1's. In 229 A is
     there: TM 0's B misses, here 353; in 230 TM 1's B merges, in 231 its A hits. */
  bench = BENCH(config, U(LUI, 1, 1), U(RDSR, 4, TRAX_SR_TM), B(BNE, 4, 0, 6 * 4), I(LW, 2, 1, LINE_A), NOP,
                I(LW, 3, 1, LINE_B), R(ADD, 0, 2, 2), J(0, 4 * 4), I(LW, 3, 1, LINE_B), I(LW, 2, 1, LINE_A),
                R(ADD, 0, 2, 2), R(ADD, 0, 3, 3), HALT);
  ISSUES(&bench, 0, 124, 125, 126, 127, 128, 129, 251, 252, 355, 356);
  ISSUES(&bench, 1, 124, 125, 126, 127, 128, 253, 355, 356);
  bench_end(&bench);
}

static void loads_past_the_data_cache_pass(void **state) {
  (void)state;
  const struct trax_config config = far_l2(1);
  /* The first lwnt finds no line: 4 bytes in 125, 226, here 246; it leaves none. lw misses in 247, here 371. The second
     lwnt hits in 372. */
  struct bench bench = BENCH(config, U(LUI, 1, 1), I(LWNT, 2, 1, LINE_A), R(ADD, 0, 2, 2), USE(3, LINE_A),
                             I(LWNT, 4, 1, LINE_A), R(ADD, 0, 4, 4), HALT);
  ISSUES(&bench, 0, 124, 125, 246, 247, 371, 372, 392, 393);
  assert_int_equal(beyond(&bench)->l2_passed, 1);
  assert_int_equal(beyond(&bench)->l2_misses, 2);
  assert_int_equal(beyond(&bench)->l2_hits, 1);
  assert_int_equal(beyond(&bench)->bytes, 2 * 64 + 4);
  bench_end(&bench);
}

static void writes_and_increments_pass(void **state) {
  (void)state;
  struct trax_config config = far_l2(1);
  config.memory.write_combining = false;
  config.memory.queue_depth = 1;
  /* sw: taken in 125, a quarter of a cycle of the bus, its place is free in 126 + 100 + 20 = 246. lw: from 246, 370. It
     found no line; the store after the load does, and is written through all the same: 371, 492. */
  struct bench bench = BENCH(config, U(LUI, 1, 1), S(SW, 1, 1, LINE_A), USE(2, LINE_A), S(SW, 1, 1, LINE_A),
                             I(LW, 3, 1, LINE_B), R(ADD, 0, 3, 3), HALT);
  ISSUES(&bench, 0, 124, 125, 246, 370, 371, 492, 616, 617);
  assert_int_equal(beyond(&bench)->l2_store_misses, 1);
  assert_int_equal(beyond(&bench)->l2_store_hits, 1);
  assert_int_equal(beyond(&bench)->bytes, 3 * 64 + 2 * 4);
  bench_end(&bench);

  /* An increment: 8 bytes, half a cycle; the next line in 127. */
  config = far_l2(1);
  config.memory.atomic_latency_cycles = 7;
  bench = BENCH(config, U(LUI, 1, 1), I(AINC, 2, 1, LINE_A), R(ADD, 0, 2, 2), HALT);
  ISSUES(&bench, 0, 124, 125, 126 + 100 + 20 + 7, 254);
  assert_int_equal(bench_word(&bench, DATA), 1);
  assert_int_equal(beyond(&bench)->l2_store_misses, 1);
  bench_end(&bench);
}

static void second_level_replacement(void **state) {
  (void)state;
  struct trax_config config = far_l2(1);
  config.l2.bytes = 128;
  config.l2.ways = 2;
  /* One set: the program's line P, then A, then B in P's place. A hits, which makes B the least recently used: C takes
     its place, and A hits again. First in, first out: C takes A's place. */
  const uint32_t program[] = {
      U(LUI, 1, 1), USE(2, LINE_A), USE(2, LINE_B), USE(2, LINE_A), USE(2, LINE_C), USE(2, LINE_A), HALT};
  struct bench bench = bench_of(&config, program, sizeof program / 4);
  ISSUES(&bench, 0, 124, 125, 249, 250, 374, 375, 395, 396, 520, 521, 541, 542);
  bench_end(&bench);
  config.l2.replacement = TRAX_REPLACE_FIFO;
  bench = bench_of(&config, program, sizeof program / 4);
  ISSUES(&bench, 0, 124, 125, 249, 250, 374, 375, 395, 396, 520, 521, 645, 646);
  bench_end(&bench);

  /* A write uses the line it finds, as the second load of A did. */
  config.l2.replacement = TRAX_REPLACE_LRU;
  config.memory.write_combining = false;
  const uint32_t written[] = {
      U(LUI, 1, 1), USE(2, LINE_A), USE(2, LINE_B), S(SWNT, 1, 1, LINE_A), USE(2, LINE_C), USE(2, LINE_A), HALT};
  bench = bench_of(&config, written, sizeof written / 4);
  ISSUES(&bench, 0, 124, 125, 249, 250, 374, 375, 376, 500, 501, 521, 522);
  bench_end(&bench);
}

static void data_cache_replacement(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 1);
  config.dcache.bytes = 128;
  config.dcache.ways = 2;
  config.dcache.replacement = TRAX_REPLACE_LRU;
  /* One set: A, B, A hits, C takes B's place, A hits, B misses. */
  struct bench bench = BENCH(config, U(LUI, 1, 1), USE(2, LINE_A), USE(2, LINE_B), USE(2, LINE_A), USE(2, LINE_C),
                             USE(2, LINE_A), USE(2, LINE_B), HALT);
  ISSUES(&bench, 0, 104, 105, 209, 210, 314, 315, 316, 317, 421, 422, 423, 424, 528, 529);
  bench_end(&bench);
  /* A store that finds A uses it as well. */
  bench = BENCH(config, U(LUI, 1, 1), USE(2, LINE_A), USE(2, LINE_B), S(SW, 1, 1, LINE_A), USE(2, LINE_C),
                USE(2, LINE_A), USE(2, LINE_B), HALT);
  ISSUES(&bench, 0, 104, 105, 209, 210, 314, 315, 316, 420, 421, 422, 423, 527, 528);
  bench_end(&bench);
}

static void channels_work_side_by_side(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 1);
  const uint32_t program[] = {
      U(LUI, 1, 1), I(LW, 2, 1, LINE_A), I(LW, 3, 1, LINE_C), I(LW, 4, 1, LINE_B), R(ADD, 0, 4, 4), R(ADD, 0, 3, 3),
      HALT};
  /* One bus: A 105..108, C 109..112, B 113..116: B is there in 217. */
  struct bench bench = bench_of(&config, program, sizeof program / 4);
  ISSUES(&bench, 0, 104, 105, 106, 107, 217, 218, 219);
  bench_end(&bench);
  /* Two of the same width: A and C on the first as before, B on the second, 107..110: it overtakes C. */
  config.memory.channels = 2;
  config.memory.bandwidth_gbps = 16;
  config.memory.interleave_bytes = 64;
  bench = bench_of(&config, program, sizeof program / 4);
  ISSUES(&bench, 0, 104, 105, 106, 107, 211, 213, 214);
  assert_int_equal(beyond(&bench)->channel[0].bytes, 3 * 64);
  assert_int_equal(beyond(&bench)->channel[1].bytes, 64);
  assert_int_equal(beyond(&bench)->channel[1].transfers, 1);
  bench_end(&bench);
  /* Half the width each: the program's line 0..7, 108. A 109..116, there in 217; C 117..124; B 111..118, there in 219.
   */
  config.memory.bandwidth_gbps = 8;
  bench = bench_of(&config, program, sizeof program / 4);
  ISSUES(&bench, 0, 108, 109, 110, 111, 219, 225, 226);
  bench_end(&bench);
  /* All in one block of the first channel. */
  config.memory.interleave_bytes = 256;
  bench = bench_of(&config, program, sizeof program / 4);
  assert_int_equal(beyond(&bench)->channel[0].bytes, 4 * 64);
  bench_end(&bench);
}

static void the_run_ends_with_the_last_bus(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 1);
  config.memory.channels = 2;
  config.memory.bandwidth_gbps = 0.5; /* half a byte a cycle and bus */
  config.memory.interleave_bytes = 64;
  config.memory.write_combining = false;
  /* The program's line: 128 cycles, 228. The store in 229 goes to channel 1: 8 cycles, until 237; halt in 230. */
  struct bench bench = BENCH(config, U(LUI, 1, 1), S(SW, 1, 1, LINE_B), HALT);
  ISSUES(&bench, 0, 228, 229, 230);
  assert_int_equal(bench_cycles(&bench), 237);
  bench_end(&bench);
}

static void increments_take_longer(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 1);
  config.memory.atomic_latency_cycles = 50;
  /* ainc 105: half a cycle of the bus, 106 + 100 + 50. The load after it overtakes it: 107 + 100. */
  struct bench bench =
      BENCH(config, U(LUI, 1, 1), I(AINC, 2, 1, 0), I(LWNT, 3, 1, 4), R(ADD, 0, 3, 3), R(ADD, 0, 2, 2), HALT);
  ISSUES(&bench, 0, 104, 105, 106, 207, 256, 257);
  bench_end(&bench);
  /* Of two places it frees the second first: the third request is made in 207. */
  config.memory.queue_depth = 2;
  bench = BENCH(config, U(LUI, 1, 1), I(AINC, 2, 1, 0), I(LWNT, 3, 1, 4), I(LWNT, 4, 1, 8), R(ADD, 0, 4, 4), HALT);
  ISSUES(&bench, 0, 104, 105, 106, 207, 308, 309);
  CHARGES(&bench, 0, TRAX_CAUSE_ICACHE_MISS, 104, TRAX_CAUSE_MEMORY_QUEUE, 100, TRAX_CAUSE_DATA_MISS, 100);
  bench_end(&bench);
}

static void least_latency(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 1);
  assert_int_equal(trax_memory_least_latency(&config), 101);
  config.memory.min_transfer_bytes = 64; /* 4 cycles, 16 on one bus of four */
  assert_int_equal(trax_memory_least_latency(&config), 104);
  config.memory.channels = 4;
  assert_int_equal(trax_memory_least_latency(&config), 116);
  config.memory.latency_cycles = 0;
  config.memory.min_transfer_bytes = 1;
  assert_int_equal(trax_memory_least_latency(&config), 1);
  config.l2.bytes = 4096;
  assert_int_equal(trax_memory_least_latency(&config), 20);
  config = bench_far(1, 1); /* 6,553,600,000 cycles are more than anybody can use */
  config.memory.bandwidth_gbps = 0.001;
  config.memory.channels = 16;
  config.memory.min_transfer_bytes = 4096;
  config.chip.clock_mhz = 100000;
  assert_int_equal(trax_memory_least_latency(&config), 1000100);
}

/* --- units --- */

static struct trax_config lockstep(uint32_t tps) { /* all issue their first instruction in cycle 1 */
  struct trax_config config = bench_near(1, tps);
  config.icache.ports_per_bank = 64;
  config.icache.tps_per_cache = 64;
  return config;
}

static void several_units_of_a_group(void **state) {
  (void)state;
  struct trax_config config = lockstep(16);
  config.fpu.adders_per_cluster = 2;
  config.fpu.multipliers_per_cluster = 3;
  config.int_mul.units_per_group = 4;
  struct bench bench = BENCH(config, R(FADD, 1, 0, 0), HALT); /* 8 TPs, two at a time */
  for (unsigned tp = 0; tp < 16; tp++)
    ISSUES(&bench, tp, 1 + tp % 8 / 2, 2 + tp % 8 / 2);
  assert_int_equal(bench_total(&bench, TRAX_CAUSE_FP_ADD), 2 * 2 * (0 + 1 + 2 + 3));
  bench_end(&bench);
  bench = BENCH(config, R(FMUL, 1, 0, 0), HALT);
  for (unsigned tp = 0; tp < 16; tp++)
    ISSUES(&bench, tp, 1 + tp % 8 / 3, 2 + tp % 8 / 3);
  bench_end(&bench);
  bench = BENCH(config, R(MUL, 1, 0, 0), HALT);
  for (unsigned tp = 0; tp < 16; tp++)
    ISSUES(&bench, tp, 1 + tp / 4, 2 + tp / 4);
  bench_end(&bench);

  config.fpu.multipliers_per_cluster = 1; /* adders alone */
  bench = BENCH(config, R(FADD, 1, 0, 0), HALT);
  assert_int_equal(bench_total(&bench, TRAX_CAUSE_FP_ADD), 2 * 2 * (0 + 1 + 2 + 3));
  bench_end(&bench);

  /* The winners go to the back: of three TPs with two adders, 0 and 1 in cycle 1; 2 and 0 in 2; 1 and 2 in 3. */
  config.chip.tps_per_tm = 3;
  bench = BENCH(config, R(FADD, 1, 0, 0), R(FADD, 2, 0, 0), HALT);
  ISSUES(&bench, 0, 1, 2, 3);
  ISSUES(&bench, 1, 1, 3, 4);
  ISSUES(&bench, 2, 2, 3, 4);
  bench_end(&bench);
}

static void adders_and_multipliers_grouped_differently(void **state) {
  (void)state;
  struct trax_config config = lockstep(8);
  config.fpu.mul_tps_per_cluster = 4;
  struct bench bench = BENCH(config, R(FMUL, 1, 0, 0), HALT);
  for (unsigned tp = 0; tp < 8; tp++)
    ISSUES(&bench, tp, 1 + tp % 4, 2 + tp % 4);
  bench_end(&bench);
  bench = BENCH(config, R(FADD, 1, 0, 0), HALT);
  for (unsigned tp = 0; tp < 8; tp++)
    ISSUES(&bench, tp, 1 + tp, 2 + tp);
  bench_end(&bench);
}

static void roots_have_a_latency_of_their_own(void **state) {
  (void)state;
  struct trax_config config = lockstep(1);
  config.special.pipelined = false;
  config.special.rsqrt_latency_cycles = 3;
  /* frsqrt 1: the unit is free in 4, when its result is usable; fdiv 4, use 12. */
  struct bench bench = BENCH(config, R1(FRSQRT, 1, 0), R(FDIV, 2, 0, 0), R(ADD, 0, 1, 1), R(ADD, 0, 2, 2), HALT);
  ISSUES(&bench, 0, 1, 4, 5, 12, 13);
  CHARGES(&bench, 0, TRAX_CAUSE_ICACHE_MISS, 1, TRAX_CAUSE_SPECIAL, 2, TRAX_CAUSE_DATA_SPECIAL, 6);
  bench_end(&bench);
  /* Of two units the one that divides is taken for 8 cycles, the other for 3. */
  config.special.units_per_tm = 2;
  bench = BENCH(config, R(FDIV, 1, 0, 0), R1(FRSQRT, 2, 0), R1(FRSQRT, 3, 0), R1(FRSQRT, 4, 0), R(FDIV, 5, 0, 0), HALT);
  ISSUES(&bench, 0, 1, 2, 5, 8, 9, 10);
  bench_end(&bench);
  config.special.pipelined = true;
  bench = BENCH(config, R1(FRSQRT, 1, 0), R(FDIV, 2, 0, 0), R(ADD, 0, 1, 1), R(ADD, 0, 2, 2), HALT);
  ISSUES(&bench, 0, 1, 2, 4, 10, 11);
  bench_end(&bench);
}

static void conversions_have_a_latency_of_their_own(void **state) {
  (void)state;
  struct trax_config config = bench_near(1, 1);
  config.fpu.convert_latency_cycles = 3;
  config.fpu.compare_latency_cycles = 5;
  for (unsigned own = 0; own < 2; own++) {
    config.fpu.compare_units = own;
    struct bench bench = BENCH(config, R1(FCVT_S_W, 1, 0), R(ADD, 0, 1, 1), R(FMAX, 2, 0, 0), R(ADD, 0, 2, 2), HALT);
    ISSUES(&bench, 0, 1, 4, 5, 10, 11);
    bench_end(&bench);
  }
}

/* --- bandwidth --- */

/* 64 threads of two TMs read so many lines each, eight at a time; where there are several channels, from several of
   them at once. */
static void stream(const struct trax_config *config, uint32_t lines, uint32_t line_cost) {
  enum { THREADS = 64 };
  uint32_t program[24];
  unsigned n = 0;
  program[n++] = U(RDSR, 1, TRAX_SR_THREAD);
  program[n++] = I(SLLI, 2, 1, 9);
  program[n++] = I(SLLI, 3, 1, 6);
  program[n++] = I(ADDI, 1, 1, 1);
  program[n++] = I(SLLI, 1, 1, 20); /* r1 = 0x100000 * (thread + 1) + 576 * thread */
  program[n++] = R(ADD, 1, 1, 2);
  program[n++] = R(ADD, 1, 1, 3);
  program[n++] = I(ADDI, 2, 0, (int32_t)lines / 8);
  for (unsigned load = 0; load < 8; load++)
    program[n++] = I(LW, 4 + load, 1, (int32_t)load * 64);
  program[n++] = I(ADDI, 1, 1, 512);
  program[n++] = I(ADDI, 2, 2, -1);
  program[n++] = B(BNE, 2, 0, -10 * 4);
  program[n++] = HALT;
  struct bench bench = bench_of(config, program, n);
  const double moved = (double)beyond(&bench)->bytes;
  const double possible = config->memory.bandwidth_gbps * 2 * (double)bench_cycles(&bench); /* 500 MHz */
  assert_true(moved >= (double)THREADS * lines * line_cost);
  assert_true(moved <= possible);
  if (moved < 0.99 * possible)
    fail_msg("%g GB/s, %u channels: %g of %g bytes", config->memory.bandwidth_gbps, config->memory.channels, moved,
             possible);
  for (uint32_t i = 0; i < config->memory.channels; i++)
    assert_true((double)beyond(&bench)->channel[i].bytes <= possible / config->memory.channels);
  bench_end(&bench);
}

static void streaming_reaches_the_bandwidth(void **state) {
  (void)state;
  static const struct {
    double gbps;
    uint32_t channels, interleave, l2_bytes, least_transfer, lines;
  } cases[] = {
      {8, 1, 64, 0, 1, 400},     {8, 1, 64, 65536, 1, 400},  {8, 4, 128, 0, 1, 800},
      {8, 4, 64, 65536, 1, 400}, {24, 3, 64, 0, 96, 800},    {24, 3, 128, 65536, 96, 1200},
      {1.234, 2, 256, 0, 1, 80}, {1.234, 16, 64, 0, 1, 160}, {16, 1, 64, 64, 1, 800},
  };
  const char *engine = getenv("TRAX_ENGINE"); /* the reference takes ten times as long */
  const unsigned step = engine && strcmp(engine, "reference") == 0 && !setting("TRAX_WHOLE", 0) ? 3 : 1;
  for (unsigned i = 0; i < sizeof cases / sizeof *cases; i += step) {
    struct trax_config config = bench_far(2, 32);
    config.memory.size_mib = 128;
    config.memory.bandwidth_gbps = cases[i].gbps;
    config.memory.channels = cases[i].channels;
    config.memory.interleave_bytes = cases[i].interleave;
    config.memory.min_transfer_bytes = cases[i].least_transfer;
    config.l2.bytes = cases[i].l2_bytes;
    config.l2.ways = cases[i].l2_bytes == 64 ? 1 : 8;
    stream(&config, cases[i].lines, cases[i].least_transfer > 64 ? cases[i].least_transfer : 64);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(second_level_misses_and_hits),
      cmocka_unit_test(second_level_lines_are_longer),
      cmocka_unit_test(a_bank_takes_one_request),
      cmocka_unit_test(second_level_miss_registers_run_out),
      cmocka_unit_test(loads_past_the_data_cache_pass),
      cmocka_unit_test(writes_and_increments_pass),
      cmocka_unit_test(second_level_replacement),
      cmocka_unit_test(data_cache_replacement),
      cmocka_unit_test(channels_work_side_by_side),
      cmocka_unit_test(the_run_ends_with_the_last_bus),
      cmocka_unit_test(increments_take_longer),
      cmocka_unit_test(least_latency),
      cmocka_unit_test(several_units_of_a_group),
      cmocka_unit_test(adders_and_multipliers_grouped_differently),
      cmocka_unit_test(roots_have_a_latency_of_their_own),
      cmocka_unit_test(conversions_have_a_latency_of_their_own),
      cmocka_unit_test(streaming_reaches_the_bandwidth),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
