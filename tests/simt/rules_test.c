/* Small programs on warps: cycles, charges and statistics derived by hand from docs/simt.md.

   With memory next to the chip (bench_near) all groups issue their first instruction in cycle 1. In the far one a line
   is there after 104 cycles. */
#include "bench.h"
#include "control/engines.h"

/* One TM of warps. */
static struct trax_config near_warps(uint32_t tps, uint32_t width) {
  struct trax_config config = bench_near(1, tps);
  config.simt.width = width;
  return config;
}

static struct trax_config far_warps(uint32_t tps, uint32_t width) {
  struct trax_config config = bench_far(1, tps);
  config.simt.width = width;
  return config;
}

static const struct trax_tm_stats *total(const struct bench *bench) {
  return &bench->machine->stats.total;
}

/* The number of instructions that groups have fetched. */
static uint64_t groups(const struct bench *bench) {
  return trax_fetches(total(bench));
}

static void lanes_that_agree_go_together(void **state) {
  (void)state;
  const struct trax_config config = near_warps(8, 8);
  struct bench bench = BENCH(config, I(ADDI, 1, 0, 7), R(ADD, 2, 1, 1), HALT);
  for (unsigned lane = 0; lane < 8; lane++) {
    ISSUES(&bench, lane, 1, 2, 3);
    CHARGES(&bench, lane, TRAX_CAUSE_ICACHE_MISS, 1);
  }
  assert_int_equal(bench_cycles(&bench), 4);
  assert_int_equal(groups(&bench), 3);
  assert_int_equal(bench.machine->stats.instructions, 24);
  bench_end(&bench);
}

static void one_way_only(void **state) {
  (void)state;
  const struct trax_config config = near_warps(2, 2);
  struct bench bench = BENCH(config, U(RDSR, 1, TRAX_SR_TP), B(BEQ, 1, 0, 12), NOP, NOP, HALT);
  ISSUES(&bench, 0, 1, 2, 5);
  ISSUES(&bench, 1, 1, 2, 3, 4, 5);
  CHARGES(&bench, 0, TRAX_CAUSE_ICACHE_MISS, 1, TRAX_CAUSE_DIVERGENCE, 2);
  CHARGES(&bench, 1, TRAX_CAUSE_ICACHE_MISS, 1);
  assert_int_equal(bench_cycles(&bench), 6);
  bench_end(&bench);
}

static void if_and_else(void **state) {
  (void)state;
  const struct trax_config config = near_warps(2, 2);
  struct bench bench = BENCH(config, U(RDSR, 1, TRAX_SR_TP), B(BNE, 1, 0, 12), NOP, J(0, 8), NOP, HALT);
  ISSUES(&bench, 0, 1, 2, 3, 4, 6);
  ISSUES(&bench, 1, 1, 2, 5, 6);
  CHARGES(&bench, 0, TRAX_CAUSE_ICACHE_MISS, 1, TRAX_CAUSE_DIVERGENCE, 1);
  CHARGES(&bench, 1, TRAX_CAUSE_ICACHE_MISS, 1, TRAX_CAUSE_DIVERGENCE, 2);
  assert_int_equal(groups(&bench), 6);
  bench_end(&bench);
}

static void nested(void **state) {
  (void)state;
  const struct trax_config config = near_warps(4, 4);
  struct bench bench = BENCH(config, U(RDSR, 1, TRAX_SR_TP), I(ANDI, 2, 1, 1), I(ANDI, 3, 1, 2), B(BEQ, 2, 0, 16),
                             B(BEQ, 3, 0, 8), NOP, NOP, HALT);
  ISSUES(&bench, 0, 1, 2, 3, 4, 8);
  ISSUES(&bench, 1, 1, 2, 3, 4, 5, 7, 8);
  ISSUES(&bench, 2, 1, 2, 3, 4, 8);
  ISSUES(&bench, 3, 1, 2, 3, 4, 5, 6, 7, 8);
  assert_int_equal(bench_cycles(&bench), 9);
  bench_end(&bench);
}

/* Lane i goes round i + 1 times; those that have left wait behind the loop. In closed form: w (w + 1) of the 2 w w
   lanes are used within it. */
static void loop_of_different_lengths(void **state) {
  (void)state;
  for (uint32_t width = 2; width <= 64; width *= 2) {
    struct trax_config config = near_warps(width, width);
    config.icache.tps_per_cache = 64;
    struct bench bench =
        BENCH(config, U(RDSR, 1, TRAX_SR_TP), I(ADDI, 1, 1, 1), I(ADDI, 1, 1, -1), B(BNE, 1, 0, -4), HALT);
    assert_int_equal(bench_cycles(&bench), 2 * width + 4);
    assert_int_equal(groups(&bench), 3 + 2 * width);
    assert_int_equal(bench.machine->stats.instructions, 3 * width + width * (width + 1));
    assert_int_equal(bench_total(&bench, TRAX_CAUSE_DIVERGENCE), width * (width - 1));
    assert_int_equal(bench_charge(&bench, 0, TRAX_CAUSE_DIVERGENCE), 2 * (width - 1));
    bench_end(&bench);
  }
}

/* Lane 0 calls the instruction of cycle 4, and goes on to the one at which lane 1 waits in no call. */
static void lanes_of_any_depth_join_a_group_that_goes_on(void **state) {
  (void)state;
  const struct trax_config config = near_warps(2, 2);
  struct bench bench = BENCH(config, U(RDSR, 2, TRAX_SR_TP), B(BNE, 2, 0, 16), J(1, 8), HALT, NOP, NOP, HALT);
  ISSUES(&bench, 0, 1, 2, 3, 4, 5, 6);
  ISSUES(&bench, 1, 1, 2, 5, 6);
  bench_end(&bench);
}

static void a_called_function_goes_first(void **state) {
  (void)state;
  const struct trax_config config = near_warps(2, 2);
  struct bench bench =
      BENCH(config, U(RDSR, 4, TRAX_SR_TP), B(BEQ, 4, 0, 8), J(1, 12), NOP, HALT, NOP, I(JALR, 0, 1, 0));
  ISSUES(&bench, 0, 1, 2, 6, 7);
  ISSUES(&bench, 1, 1, 2, 3, 4, 5, 6, 7);
  bench_end(&bench);
}

/* The second warp loses the banks of the first two instructions, in 0 and in 2. */
static void warps_are_tps_to_each_other(void **state) {
  (void)state;
  const struct trax_config config = near_warps(4, 2);
  struct bench bench = BENCH(config, NOP, NOP, HALT);
  for (unsigned lane = 0; lane < 4; lane++)
    if (lane < 2) {
      ISSUES(&bench, lane, 1, 2, 3);
    } else {
      ISSUES(&bench, lane, 1, 3, 4);
      CHARGES(&bench, lane, TRAX_CAUSE_ICACHE_BANK, 2);
    }
  assert_int_equal(bench_cycles(&bench), 5);
  bench_end(&bench);
}

static void fewer_units_than_lanes(void **state) {
  (void)state;
  struct trax_config config = near_warps(8, 8);
  config.fpu.adders_per_cluster = 4;
  struct bench bench = BENCH(config, R(FADD, 1, 0, 0), HALT);
  for (unsigned lane = 0; lane < 8; lane++)
    if (lane < 4) {
      ISSUES(&bench, lane, 1, 3);
      CHARGES(&bench, lane, TRAX_CAUSE_ICACHE_MISS, 1, TRAX_CAUSE_LOCKSTEP, 1);
    } else {
      ISSUES(&bench, lane, 2, 3);
      CHARGES(&bench, lane, TRAX_CAUSE_ICACHE_MISS, 1, TRAX_CAUSE_FP_ADD, 1);
    }
  bench_end(&bench);
}

/* Two warps share an adder: the arbiter goes round their lanes. */
static void warps_that_share_a_unit(void **state) {
  (void)state;
  struct trax_config config = near_warps(4, 2);
  config.icache.ports_per_bank = 64;
  struct bench bench = BENCH(config, R(FADD, 1, 0, 0), HALT);
  ISSUES(&bench, 0, 1, 3);
  ISSUES(&bench, 1, 2, 3);
  ISSUES(&bench, 2, 3, 5);
  ISSUES(&bench, 3, 4, 5);
  CHARGES(&bench, 2, TRAX_CAUSE_ICACHE_MISS, 1, TRAX_CAUSE_FP_ADD, 2, TRAX_CAUSE_LOCKSTEP, 1);
  bench_end(&bench);
}

static void bank_conflict(void **state) {
  (void)state;
  struct trax_config config = near_warps(4, 4);
  config.dcache.tps_per_bank = 1;
  struct bench bench =
      BENCH(config, U(LUI, 1, 1), U(RDSR, 2, TRAX_SR_TP), I(SLLI, 2, 2, 4), R(ADD, 1, 1, 2), I(LW, 3, 1, 0), HALT);
  for (unsigned lane = 0; lane < 4; lane++) {
    ISSUES(&bench, lane, 1, 2, 3, 4, 5 + lane, 9);
    CHARGES(&bench, lane, TRAX_CAUSE_ICACHE_MISS, 1, TRAX_CAUSE_DCACHE_BANK, lane, TRAX_CAUSE_LOCKSTEP, 3 - lane);
  }
  assert_int_equal(total(&bench)->broadcast_loads, 0);
  bench_end(&bench);
}

/* One access to the bank serves the word's loads by all lanes of the warp, and none of another warp. */
static void broadcast(void **state) {
  (void)state;
  const struct trax_config config = far_warps(8, 4);
  struct bench bench = BENCH(config, U(LUI, 1, 1), I(LW, 2, 1, 0), R(ADD, 3, 2, 2), HALT);
  for (unsigned lane = 0; lane < 8; lane++) {
    ISSUES(&bench, lane, 104, 105 + lane / 4, 209, 210);
    CHARGES(&bench, lane, TRAX_CAUSE_ICACHE_MISS, 104, TRAX_CAUSE_DCACHE_BANK, lane / 4, TRAX_CAUSE_DATA_MISS,
            103 - lane / 4);
  }
  assert_int_equal(total(&bench)->dcache_misses, 1);
  assert_int_equal(total(&bench)->dcache_merged, 7);
  assert_int_equal(total(&bench)->broadcast_loads, 6);
  bench_end(&bench);
}

/* Stores to one word are served one by one. */
static void stores_are_no_broadcast(void **state) {
  (void)state;
  const struct trax_config config = near_warps(2, 2);
  struct bench bench = BENCH(config, U(LUI, 1, 1), S(SW, 1, 1, 0), HALT);
  ISSUES(&bench, 0, 1, 2, 4);
  ISSUES(&bench, 1, 1, 3, 4);
  bench_end(&bench);
}

/* Both lanes have the word at 0x10000 in the cache; lane 1 then loads from the next line. The pointer of the only bank
   is behind lane 0. */
static void the_group_waits_for_the_miss_of_a_lane(void **state) {
  (void)state;
  const struct trax_config config = far_warps(2, 2);
  struct bench bench = BENCH(config, U(LUI, 1, 1), U(RDSR, 2, TRAX_SR_TP), I(LW, 3, 1, 0), R(ADD, 4, 3, 3),
                             I(SLLI, 2, 2, 6), R(ADD, 1, 1, 2), I(LW, 5, 1, 0), R(ADD, 6, 5, 5), HALT);
  ISSUES(&bench, 0, 104, 105, 106, 210, 211, 212, 214, 317, 318);
  ISSUES(&bench, 1, 104, 105, 106, 210, 211, 212, 213, 317, 318);
  CHARGES(&bench, 0, TRAX_CAUSE_ICACHE_MISS, 104, TRAX_CAUSE_DATA_MISS, 103, TRAX_CAUSE_DCACHE_BANK, 1,
          TRAX_CAUSE_LOCKSTEP, 102);
  CHARGES(&bench, 1, TRAX_CAUSE_ICACHE_MISS, 104, TRAX_CAUSE_DATA_MISS, 205, TRAX_CAUSE_LOCKSTEP, 1);
  assert_int_equal(bench_cycles(&bench), 319);
  bench_end(&bench);
}

/* The quotient of lane 0 is there in 11. */
static void the_group_waits_for_the_register_of_a_lane(void **state) {
  (void)state;
  const struct trax_config config = near_warps(2, 2);
  struct bench bench = BENCH(config, U(RDSR, 1, TRAX_SR_TP), B(BNE, 1, 0, 8), R(FDIV, 3, 0, 0), R(ADD, 4, 3, 3), HALT);
  ISSUES(&bench, 0, 1, 2, 3, 11, 12);
  ISSUES(&bench, 1, 1, 2, 11, 12);
  CHARGES(&bench, 0, TRAX_CAUSE_ICACHE_MISS, 1, TRAX_CAUSE_DATA_SPECIAL, 7);
  CHARGES(&bench, 1, TRAX_CAUSE_ICACHE_MISS, 1, TRAX_CAUSE_DIVERGENCE, 1, TRAX_CAUSE_LOCKSTEP, 7);
  bench_end(&bench);
}

/* The sum of lane 1 is there in 8, the quotient of lane 0 in 11. */
static void the_group_waits_for_its_first_lane_when_others_are_ready(void **state) {
  (void)state;
  struct trax_config config = near_warps(2, 2);
  config.fpu.add_latency_cycles = 3;
  struct bench bench = BENCH(config, U(RDSR, 1, TRAX_SR_TP), B(BNE, 1, 0, 12), R(FDIV, 3, 0, 0), J(0, 8),
                             R(FADD, 3, 0, 0), R(ADD, 4, 3, 3), HALT);
  ISSUES(&bench, 0, 1, 2, 3, 4, 11, 12);
  ISSUES(&bench, 1, 1, 2, 5, 11, 12);
  CHARGES(&bench, 0, TRAX_CAUSE_ICACHE_MISS, 1, TRAX_CAUSE_DIVERGENCE, 1, TRAX_CAUSE_DATA_SPECIAL, 5);
  bench_end(&bench);
}

static void increments_are_of_lanes(void **state) {
  (void)state;
  const struct trax_config config = near_warps(4, 4);
  struct bench bench =
      BENCH(config, U(LUI, 1, 1), I(AINC, 2, 1, 0), I(SLLI, 3, 2, 2), R(ADD, 1, 1, 3), S(SW, 2, 1, 4), HALT);
  for (unsigned lane = 0; lane < 4; lane++)
    assert_int_equal(bench_word(&bench, DATA + 4 + 4 * lane), lane);
  assert_int_equal(bench_word(&bench, DATA), 4);
  ISSUES(&bench, 0, 1, 2, 3, 4, 5, 9); /* there is one bank for the stores */
  ISSUES(&bench, 2, 1, 2, 3, 4, 7, 9);
  bench_end(&bench);
}

/* Lane 0 spins for a word that lane 1 stores, at a greater address. Patience is 16, so a turn is one instruction: in 20
   lane 1 computes the value, in 37 it stores it, in 41 it is alone. */
static void a_lane_that_spins_for_another(void **state) {
  (void)state;
  struct trax_config config = near_warps(2, 2);
  config.simt.patience = 16;
  struct bench bench = BENCH(config, U(LUI, 1, 1), U(RDSR, 2, TRAX_SR_TP), B(BNE, 2, 0, 16), I(LW, 3, 1, 0),
                             B(BEQ, 3, 0, -4), HALT, I(ADDI, 4, 0, 1), S(SW, 4, 1, 0), HALT);
  ISSUES(&bench, 1, 1, 2, 3, 20, 37, 41);
  assert_int_equal(bench_charge(&bench, 0, TRAX_CAUSE_DIVERGENCE), 2);
  assert_int_equal(bench_cycles(&bench), 42);
  bench_end(&bench);
}

/* A warp wider than its TPs' caches fetches from that of the group's first lane: lane 1, alone behind the branch, has
   a cache of its own, where the line is not. */
static void a_group_fetches_from_the_cache_of_its_first_lane(void **state) {
  (void)state;
  struct trax_config config = near_warps(2, 2);
  config.icache.tps_per_cache = 1;
  struct bench bench = BENCH(config, U(RDSR, 1, TRAX_SR_TP), B(BEQ, 1, 0, 8), NOP, HALT);
  ISSUES(&bench, 0, 1, 2, 5);
  ISSUES(&bench, 1, 1, 2, 4, 5);
  CHARGES(&bench, 1, TRAX_CAUSE_ICACHE_MISS, 2);
  assert_int_equal(total(&bench)->icache_misses, 2);
  bench_end(&bench);
}

static void warps_with_caches_of_their_own(void **state) {
  (void)state;
  struct trax_config config = near_warps(4, 2);
  config.icache.tps_per_cache = 2;
  struct bench bench = BENCH(config, NOP, NOP, HALT);
  for (unsigned lane = 0; lane < 4; lane++)
    ISSUES(&bench, lane, 1, 2, 3);
  bench_end(&bench);
}

/* The second warp's line gets a place when the first one's has come. */
static void a_fetch_without_a_place(void **state) {
  (void)state;
  struct trax_config config = far_warps(4, 2);
  config.icache.tps_per_cache = 2;
  config.memory.queue_depth = 1;
  struct bench bench = BENCH(config, HALT);
  for (unsigned lane = 0; lane < 2; lane++)
    ISSUES(&bench, lane, 104);
  for (unsigned lane = 2; lane < 4; lane++) {
    ISSUES(&bench, lane, 208);
    CHARGES(&bench, lane, TRAX_CAUSE_MEMORY_QUEUE, 104, TRAX_CAUSE_ICACHE_MISS, 104);
  }
  bench_end(&bench);
}

/* Patience is 64: each lwnt costs 4, each branch 1. 12 rounds and a load later, in 29, lane 1 has the turn, of 4
   instructions, until it ends. */
static void loads_past_the_cache_cost_patience(void **state) {
  (void)state;
  struct trax_config config = near_warps(2, 2);
  config.simt.patience = 64;
  struct bench bench = BENCH(config, U(LUI, 1, 1), U(RDSR, 2, TRAX_SR_TP), B(BNE, 2, 0, 16), I(LWNT, 3, 1, 0),
                             B(BEQ, 3, 0, -4), HALT, I(ADDI, 4, 0, 1), S(SW, 4, 1, 0), HALT);
  ISSUES(&bench, 1, 1, 2, 3, 29, 30, 31);
  assert_int_equal(bench_cycles(&bench), 36);
  bench_end(&bench);
}

/* Lane 1 has stored, and its fence waits for the write: made in 108, complete in 209. Lane 0 has nothing to wait for.
 */
static void fence(void **state) {
  (void)state;
  const struct trax_config config = far_warps(2, 2);
  struct bench bench =
      BENCH(config, U(LUI, 1, 1), U(RDSR, 2, TRAX_SR_TP), B(BEQ, 2, 0, 8), S(SW, 2, 1, 0), FENCE(W), HALT);
  ISSUES(&bench, 0, 104, 105, 106, 108, 210);
  ISSUES(&bench, 1, 104, 105, 106, 107, 209, 210);
  CHARGES(&bench, 0, TRAX_CAUSE_ICACHE_MISS, 104, TRAX_CAUSE_DIVERGENCE, 1, TRAX_CAUSE_LOCKSTEP, 101);
  CHARGES(&bench, 1, TRAX_CAUSE_ICACHE_MISS, 104, TRAX_CAUSE_DATA_MISS, 101);
  bench_end(&bench);
}

static void exit_of_a_lane(void **state) {
  (void)state;
  const struct trax_config config = near_warps(2, 2);
  struct bench bench =
      BENCH(config, U(RDSR, 1, TRAX_SR_TP), B(BEQ, 1, 0, 12), I(ADDI, 2, 0, 5), T(2, TRAX_TRAP_EXIT), HALT);
  ISSUES(&bench, 0, 1, 2, 5);
  ISSUES(&bench, 1, 1, 2, 3, 4);
  assert_int_equal(bench.machine->exit_statuses[1], 5);
  assert_int_equal(bench_charge(&bench, 0, TRAX_CAUSE_DIVERGENCE), 2);
  assert_int_equal(bench_charge(&bench, 1, TRAX_CAUSE_HALTED), 1);
  bench_end(&bench);
}

static void halt_of_some_lanes(void **state) {
  (void)state;
  const struct trax_config config = near_warps(4, 4);
  struct bench bench = BENCH(config, U(RDSR, 1, TRAX_SR_TP), I(SLTI, 2, 1, 2), B(BNE, 2, 0, 8), HALT, NOP, HALT);
  for (unsigned lane = 0; lane < 4; lane++)
    if (lane < 2) {
      ISSUES(&bench, lane, 1, 2, 3, 5, 6);
    } else {
      ISSUES(&bench, lane, 1, 2, 3, 4);
      assert_int_equal(bench_charge(&bench, lane, TRAX_CAUSE_HALTED), 2);
    }
  assert_int_equal(bench_cycles(&bench), 7);
  bench_end(&bench);
}

/* A unit for each lane is not always free. */
static void units_of_lanes_may_be_busy(void **state) {
  (void)state;
  struct trax_config config = near_warps(2, 2);
  config.special.units_per_tm = 2;
  config.special.pipelined = false;
  config.special.latency_cycles = 8;
  struct bench bench = BENCH(config, R(FDIV, 1, 0, 0), R(FDIV, 2, 0, 0), HALT);
  for (unsigned lane = 0; lane < 2; lane++)
    ISSUES(&bench, lane, 1, 9, 10);
  bench_end(&bench);
}

/* The box is in r10 to r15, and the fifth of them comes late. */
static void a_group_waits_for_groups_of_registers(void **state) {
  (void)state;
  struct trax_config config = near_warps(2, 2);
  config.ray.units_per_group = 1;
  config.fpu.mul_latency_cycles = 12;
  config.fpu.tps_per_cluster = 1;
  struct bench bench = BENCH(config, R(FMUL, 14, 0, 0), R(FBOX, 1, 16, 10), HALT);
  ISSUES(&bench, 0, 1, 13, 15);
  ISSUES(&bench, 1, 1, 14, 15);
  bench_end(&bench);
}

/* Each halt writes a run, and the queue has one place. */
static void an_ended_lane_is_halted_while_its_group_waits(void **state) {
  (void)state;
  struct trax_config config = near_warps(2, 2);
  config.memory.queue_depth = 1;
  struct bench bench =
      BENCH(config, U(RDSR, 1, TRAX_SR_TP), I(SLLI, 1, 1, 6), U(LUI, 2, 1), R(ADD, 1, 1, 2), S(SWNT, 1, 1, 0), HALT);
  ISSUES(&bench, 0, 1, 2, 3, 4, 5, 6);
  ISSUES(&bench, 1, 1, 2, 3, 4, 5, 7);
  CHARGES(&bench, 0, TRAX_CAUSE_ICACHE_MISS, 1);
  CHARGES(&bench, 1, TRAX_CAUSE_ICACHE_MISS, 1, TRAX_CAUSE_MEMORY_QUEUE, 1);
  assert_int_equal(bench_charge(&bench, 0, TRAX_CAUSE_HALTED), bench_cycles(&bench) - 7);
  bench_end(&bench);
}

static void fault_of_a_lane(void **state) {
  (void)state;
  const struct trax_config config = near_warps(2, 2);
  const uint32_t words[] = {U(RDSR, 1, TRAX_SR_TP), B(BEQ, 1, 0, 8), I(LW, 2, 0, 8), HALT};
  struct bench bench = bench_begin(&config, words, 4);
  bench_run(&bench, 0);
  assert_int_equal(bench.status, TRAX_FAULT);
  assert_int_equal(bench.machine->fault.kind, TRAX_FAULT_NULL_PAGE);
  assert_int_equal(bench.machine->fault.thread, 1);
  assert_int_equal(bench.machine->fault.cycle, 3);
  assert_int_equal(bench_cycles(&bench), 4);
  bench_end(&bench);
}

/* The taken branch of cycle 2 has two cycles of bubble. The group of cycle 4 waits for lane 0's. */
static void bubble_of_a_lane(void **state) {
  (void)state;
  struct trax_config config = near_warps(2, 2);
  config.tp.branch_bubble_cycles = 2;
  struct bench bench = BENCH(config, U(RDSR, 1, TRAX_SR_TP), B(BEQ, 1, 0, 8), NOP, HALT);
  ISSUES(&bench, 0, 1, 2, 5);
  ISSUES(&bench, 1, 1, 2, 3, 5);
  CHARGES(&bench, 0, TRAX_CAUSE_ICACHE_MISS, 1, TRAX_CAUSE_BRANCH, 2);
  CHARGES(&bench, 1, TRAX_CAUSE_ICACHE_MISS, 1, TRAX_CAUSE_LOCKSTEP, 1);
  bench_end(&bench);
}

static void engines_that_have_warps(void **state) {
  (void)state;
  const struct trax_config config = near_warps(8, 8);
  const uint32_t halt[] = {HALT};
  for (unsigned i = 0; i < 2; i++) {
    struct bench bench = bench_begin(&config, halt, 1);
    const trax_run_options options = {.engine = i ? "reference" : "fast"};
    assert_int_equal(trax_machine_run(bench.machine, &options, &bench.error), TRAX_ERROR);
    assert_string_equal(bench.error.message, i ? "simt.width = 8 needs the engine functional or simt, not reference"
                                               : "simt.width = 8 needs the engine functional or simt, not fast");
    bench_end(&bench);
  }
  assert_string_equal(trax_engine_for(&config)->name, "simt");
  struct trax_config other = config;
  trax_error error;
  other.simt.width = 3;
  assert_int_equal(trax_config_validate(&other, &error), TRAX_ERROR);
  assert_string_equal(error.message, "simt.width is 3; it must divide chip.tps_per_tm = 8");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lanes_that_agree_go_together),
      cmocka_unit_test(one_way_only),
      cmocka_unit_test(if_and_else),
      cmocka_unit_test(nested),
      cmocka_unit_test(loop_of_different_lengths),
      cmocka_unit_test(a_called_function_goes_first),
      cmocka_unit_test(lanes_of_any_depth_join_a_group_that_goes_on),
      cmocka_unit_test(warps_are_tps_to_each_other),
      cmocka_unit_test(fewer_units_than_lanes),
      cmocka_unit_test(warps_that_share_a_unit),
      cmocka_unit_test(bank_conflict),
      cmocka_unit_test(broadcast),
      cmocka_unit_test(stores_are_no_broadcast),
      cmocka_unit_test(the_group_waits_for_the_miss_of_a_lane),
      cmocka_unit_test(the_group_waits_for_the_register_of_a_lane),
      cmocka_unit_test(the_group_waits_for_its_first_lane_when_others_are_ready),
      cmocka_unit_test(increments_are_of_lanes),
      cmocka_unit_test(a_lane_that_spins_for_another),
      cmocka_unit_test(a_group_fetches_from_the_cache_of_its_first_lane),
      cmocka_unit_test(warps_with_caches_of_their_own),
      cmocka_unit_test(a_fetch_without_a_place),
      cmocka_unit_test(loads_past_the_cache_cost_patience),
      cmocka_unit_test(fence),
      cmocka_unit_test(exit_of_a_lane),
      cmocka_unit_test(halt_of_some_lanes),
      cmocka_unit_test(units_of_lanes_may_be_busy),
      cmocka_unit_test(a_group_waits_for_groups_of_registers),
      cmocka_unit_test(an_ended_lane_is_halted_while_its_group_waits),
      cmocka_unit_test(fault_of_a_lane),
      cmocka_unit_test(bubble_of_a_lane),
      cmocka_unit_test(engines_that_have_warps),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
