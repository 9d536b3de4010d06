/* The bandwidth is reached, by each engine, with and without a second-level cache, and the least latency of memory. */
#include "compare.h"

#include "fast/memory/memory.h"

#include <stdlib.h>
#include <string.h>

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
  const double moved = (double)bench.machine->stats.memory.bytes;
  const double possible = config->memory.bandwidth_gbps * 2 * (double)bench_cycles(&bench); /* 500 MHz */
  assert_true(moved >= (double)THREADS * lines * line_cost);
  assert_true(moved <= possible);
  if (moved < 0.99 * possible)
    fail_msg("%g GB/s, %u channels: %g of %g bytes", config->memory.bandwidth_gbps, config->memory.channels, moved,
             possible);
  for (uint32_t i = 0; i < config->memory.channels; i++)
    assert_true((double)bench.machine->stats.memory.channel[i].bytes <= possible / config->memory.channels);
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
      cmocka_unit_test(least_latency),
      cmocka_unit_test(streaming_reaches_the_bandwidth),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
