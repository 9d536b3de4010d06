/* Random programs on random configurations: what must hold whatever the timing.

   A thread touches only its own words, and others' only through atomic increments of its own counter; so the values at
   the end must not depend on the configuration. The trace of issues must respect every unit's capacity and every
   latency. */
#include "generate.h"

#include "fast/memory/memory.h"

#include <stdlib.h>
#include <string.h>

/* --- what must hold --- */

static uint32_t latency_of(const trax_inst *inst, const struct trax_config *config) { /* 0: memory's */
  const bool flop = trax_op_table[inst->op].flags & TRAX_IS_FLOP;
  const bool converts = strncmp(trax_op_table[inst->op].mnemonic, "fcvt.", 5) == 0;
  switch (trax_op_table[inst->op].unit) {
  case TRAX_UNIT_FP_ADD:
    return flop       ? config->fpu.add_latency_cycles
           : converts ? config->fpu.convert_latency_cycles
                      : config->fpu.compare_latency_cycles;
  case TRAX_UNIT_FP_MUL:
    return config->fpu.mul_latency_cycles;
  case TRAX_UNIT_INT_MUL:
    return config->int_mul.latency_cycles;
  case TRAX_UNIT_SPECIAL:
    return inst->op == TRAX_OP_FRSQRT && config->special.rsqrt_latency_cycles ? config->special.rsqrt_latency_cycles
                                                                              : config->special.latency_cycles;
  case TRAX_UNIT_RAY_BOX:
    return config->ray.box_latency_cycles;
  case TRAX_UNIT_RAY_TRIANGLE:
    return config->ray.triangle_latency_cycles;
  case TRAX_UNIT_MEMORY:
    return 0;
  default:
    return config->tp.int_latency_cycles;
  }
}

static void check_dependences(const struct bench *bench) {
  const struct trax_config *config = &bench->machine->config;
  static uint64_t usable[MAX_THREADS][32], last[MAX_THREADS];
  memset(usable, 0, sizeof usable);
  memset(last, 0, sizeof last);
  for (size_t i = 0; i < bench->issues.count; i++) {
    const struct trax_issue *issue = &bench->issues.issue[i];
    const trax_inst inst = trax_decode(issue->word);
    const unsigned flags = trax_op_table[inst.op].flags;
    const unsigned thread = issue->tm * config->chip.tps_per_tm + issue->tp;
    assert_true(issue->cycle > last[thread] || last[thread] == 0);
    last[thread] = issue->cycle;
    for (unsigned n = 0; n < trax_group_a(flags); n++)
      assert_true(usable[thread][(inst.ra + n) % 32] <= issue->cycle);
    for (unsigned n = 0; n < trax_group_b(flags); n++)
      assert_true(usable[thread][(inst.rb + n) % 32] <= issue->cycle);
    if (!(flags & TRAX_WRITES_RD) || inst.rd == 0)
      continue;
    assert_true(usable[thread][inst.rd] <= issue->cycle);
    uint32_t latency = latency_of(&inst, config);
    if (!latency) {
      const bool cached = issue->address < TRAX_LOCAL_BASE && inst.op != TRAX_OP_LWNT && inst.op != TRAX_OP_AINC;
      latency = issue->address >= TRAX_LOCAL_BASE ? config->tp.local_latency_cycles
                : cached                          ? 1 /* a merged load's line may come in the next cycle */
                                                  : trax_memory_least_latency(config);
    }
    usable[thread][inst.rd] = issue->cycle + latency;
  }
}

/* At most `capacity` of the issues on a unit within any `window` cycles, by group of TPs. */
static void check_unit(const struct bench *bench, trax_unit unit, bool flops_only, uint32_t group_size,
                       uint32_t capacity, uint64_t window) {
  enum { DEPTH = 64 };
  static uint64_t recent[64][64][DEPTH]; /* by TM and group: cycles + 1 of the latest, by turn */
  static unsigned turn[64][64];
  memset(recent, 0, sizeof recent);
  memset(turn, 0, sizeof turn);
  assert_true(capacity <= DEPTH);
  for (size_t i = 0; i < bench->issues.count; i++) {
    const struct trax_issue *issue = &bench->issues.issue[i];
    const trax_op op = trax_decode(issue->word).op;
    if (trax_op_table[op].unit != unit || (flops_only && !(trax_op_table[op].flags & TRAX_IS_FLOP)))
      continue;
    const unsigned group = issue->tp / group_size;
    uint64_t *oldest = &recent[issue->tm][group][turn[issue->tm][group]++ % capacity];
    assert_true(*oldest == 0 || issue->cycle >= *oldest - 1 + window);
    *oldest = issue->cycle + 1;
  }
}

static void check_units(const struct bench *bench) {
  const struct trax_config *config = &bench->machine->config;
  const uint32_t cluster = config->fpu.tps_per_cluster, mul_cluster = config->fpu.mul_tps_per_cluster;
  const uint32_t latency = config->special.latency_cycles, rsqrt_latency = config->special.rsqrt_latency_cycles;
  check_unit(bench, TRAX_UNIT_FP_ADD, config->fpu.compare_units, cluster, config->fpu.adders_per_cluster, 1);
  check_unit(bench, TRAX_UNIT_FP_MUL, false, mul_cluster ? mul_cluster : cluster, config->fpu.multipliers_per_cluster,
             1);
  check_unit(bench, TRAX_UNIT_INT_MUL, false, config->int_mul.tps_per_unit, config->int_mul.units_per_group, 1);
  check_unit(bench, TRAX_UNIT_SPECIAL, false, 64, config->special.units_per_tm,
             config->special.pipelined                  ? 1
             : rsqrt_latency && rsqrt_latency < latency ? rsqrt_latency
                                                        : latency);
  const uint32_t units = config->ray.units_per_group;
  check_unit(bench, TRAX_UNIT_RAY_BOX, false, config->ray.tps_per_group, units, config->ray.box_interval_cycles);
  check_unit(bench, TRAX_UNIT_RAY_TRIANGLE, false, config->ray.tps_per_group, units,
             config->ray.triangle_interval_cycles);
}

static void check_order(const struct bench *bench) {
  for (size_t i = 1; i < bench->issues.count; i++) {
    const struct trax_issue *a = &bench->issues.issue[i - 1], *b = &bench->issues.issue[i];
    assert_true(a->cycle < b->cycle || (a->cycle == b->cycle && (a->tm < b->tm || (a->tm == b->tm && a->tp < b->tp))));
  }
}

/* What the TMs requested is what was transferred, and no more than the buses can. */
static void check_bytes(const struct trax_stats *stats, const struct trax_config *config) {
  const struct trax_tm_stats *total = &stats->total;
  const struct trax_memory_stats *memory = &stats->memory;
  const double possible =
      trax_memory_gbps(config) * 1000 / config->chip.clock_mhz * (double)stats->cycles * (1 + 1e-12);
  uint64_t transfers = 0, bytes = 0;
  for (uint32_t i = 0; i < config->memory.channels; i++) {
    assert_true((double)memory->channel[i].bytes <= possible / config->memory.channels);
    transfers += memory->channel[i].transfers;
    bytes += memory->channel[i].bytes;
  }
  assert_int_equal(memory->transfers, transfers);
  assert_int_equal(memory->bytes, bytes);
  const bool dram = config->memory.model == TRAX_MEMORY_DRAM;
  const uint64_t increments = dram ? total->atomics : 0; /* without a transfer */
  const uint64_t read_bytes = total->data_read_bytes + total->instruction_read_bytes + total->nontemporal_read_bytes;
  if (!config->l2.bytes) {
    assert_int_equal(transfers + increments, total->memory_requests);
    assert_int_equal(bytes, read_bytes + total->written_bytes + total->atomic_bytes);
    return;
  }
  const uint64_t reads = memory->l2_hits + memory->l2_merged + memory->l2_misses + memory->l2_passed;
  const uint64_t writes = memory->l2_store_hits + memory->l2_store_misses;
  const uint64_t passed_bytes = dram                                    ? trax_dram_bytes(config, 0, 4)
                                : config->memory.min_transfer_bytes > 4 ? config->memory.min_transfer_bytes
                                                                        : 4;
  assert_int_equal(reads + writes, total->memory_requests);
  assert_int_equal(writes, total->write_requests + total->atomics);
  assert_int_equal(transfers + increments, writes + memory->l2_misses + memory->l2_passed);
  assert_int_equal(bytes, total->written_bytes + total->atomic_bytes + memory->l2_read_bytes +
                              memory->l2_passed * passed_bytes);
  assert_true(memory->l2_served_bytes <= read_bytes);
}

static void check_counts(const struct bench *bench) {
  const struct trax_stats *stats = &bench->machine->stats;
  const struct trax_config *config = &bench->machine->config;
  uint64_t sum = 0;
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    sum += stats->total.cycles[cause];
  assert_int_equal(sum, stats->threads * stats->cycles);
  for (uint64_t thread = 0; thread < stats->threads; thread++) {
    sum = 0;
    for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
      sum += bench->machine->tp_stats[thread].cycles[cause];
    assert_int_equal(sum, stats->cycles);
  }
  assert_int_equal(stats->instructions, bench->issues.count);

  uint64_t cached_loads = 0, cached_stores = 0;
  for (size_t i = 0; i < bench->issues.count; i++) {
    const trax_op op = trax_decode(bench->issues.issue[i].word).op;
    const unsigned flags = trax_op_table[op].flags;
    if (bench->issues.issue[i].address >= TRAX_LOCAL_BASE || (flags & (TRAX_IS_ATOMIC | TRAX_IS_NONTEMPORAL)))
      continue;
    cached_loads += (flags & TRAX_IS_LOAD) != 0;
    cached_stores += (flags & TRAX_IS_STORE) != 0;
  }
  assert_int_equal(stats->total.dcache_hits + stats->total.dcache_misses + stats->total.dcache_merged, cached_loads);
  assert_int_equal(stats->total.store_hits + stats->total.store_misses, cached_stores);
  /* Every instruction was fetched once, but the lookups that missed or merged needed no second one. */
  assert_int_equal(stats->total.icache_hits + stats->total.icache_misses + stats->total.icache_merged,
                   stats->instructions);
  check_bytes(stats, config);
  assert_true(stats->total.queue_peak <= (uint64_t)config->memory.queue_depth * config->chip.tms);
}

static struct bench run(const struct trax_config *config, const uint32_t *program, size_t count) {
  struct bench bench = bench_begin(config, program, count);
  uint64_t saved = random_state;
  random_state = 99; /* the same data for all configurations */
  for (uint32_t i = 0; i < DATA_BYTES; i++)
    bench.machine->space.bytes[DATA + i] = (uint8_t)any(0, 255);
  random_state = saved;
  bench_run(&bench, 50u * 1000 * 1000);
  if (bench.status != TRAX_OK)
    fail_msg("%s", bench.error.message);
  return bench;
}

static void random_programs(void **state) {
  (void)state;
  const char *rounds_text = getenv("TRAX_RANDOM_ROUNDS"), *seed_text = getenv("TRAX_RANDOM_SEED");
  const unsigned rounds = rounds_text ? (unsigned)atoi(rounds_text) : 4;
  const unsigned seed = seed_text ? (unsigned)atoi(seed_text) : 1;
  for (unsigned round = 0; round < rounds; round++) {
    random_state = 0x9E3779B97F4A7C15u * (seed + round);
    print_message("TRAX_RANDOM_SEED=%u\n", seed + round);
    uint32_t program[BODY + 64];
    const size_t count = any_program(program);
    const uint32_t tms = any(1, 4), tps = any(1, MAX_THREADS / tms > 64 ? 64 : MAX_THREADS / tms);
    uint8_t *expected = NULL;
    for (unsigned variant = 0; variant < 3; variant++) {
      const struct trax_config config = any_config(tms, tps);
      struct bench bench = run(&config, program, count);
      check_order(&bench);
      check_dependences(&bench);
      check_units(&bench);
      check_counts(&bench);
      if (!expected) {
        expected = malloc(DATA_BYTES);
        assert_non_null(expected);
        memcpy(expected, bench.machine->space.bytes + DATA, DATA_BYTES);
        struct bench again = run(&config, program, count);
        assert_int_equal(again.issues.count, bench.issues.count);
        assert_memory_equal(again.issues.issue, bench.issues.issue, bench.issues.count * sizeof *bench.issues.issue);
        assert_memory_equal(&again.machine->stats.total, &bench.machine->stats.total,
                            sizeof again.machine->stats.total);
        bench_end(&again);
      } else
        assert_memory_equal(expected, bench.machine->space.bytes + DATA, DATA_BYTES);
      bench_end(&bench);
    }
    free(expected);
  }
}

/* Random words: whatever they do, the machine ends in an orderly way with its accounts balanced. */
static void random_words(void **state) {
  (void)state;
  unsigned faults[TRAX_FAULT_COUNT] = {0};
  for (unsigned round = 0; round < 3000; round++) {
    random_state = 0xD1B54A32D192ED03u * (round + 1);
    uint32_t program[32];
    any_words(program, 32);
    const struct trax_config config = any_config(any(1, 2), any(1, 4));
    struct bench bench = bench_begin(&config, program, 32);
    bench_run(&bench, 20000);
    assert_int_not_equal(bench.status, TRAX_ERROR);
    const struct trax_fault *fault = trax_machine_fault(bench.machine);
    assert_true((bench.status == TRAX_FAULT) == (fault->kind != TRAX_FAULT_NONE));
    faults[fault->kind]++;
    uint64_t sum = 0;
    for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
      sum += bench_total(&bench, (trax_cause)cause);
    assert_int_equal(sum, bench.machine->stats.threads * bench_cycles(&bench));
    bench_end(&bench);
  }
  for (unsigned kind = 0; kind < TRAX_FAULT_COUNT; kind++)
    print_message("%u times: %s\n", faults[kind], trax_fault_text((trax_fault_kind)kind));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(random_programs),
      cmocka_unit_test(random_words),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
