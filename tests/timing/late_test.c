/* The memory controllers of both engines in cycles that no test reaches by simulating all cycles before: transfers by
   hand (docs/timing-memory.md, "Memory controller"), where the bus time since cycle 0 does not fit in 64 bits. */
#include "bench.h"

#include "fast/chip.h"
#include "reference/reference.h"

#include <inttypes.h>
#include <string.h>

enum { REQUESTS = 4 };

/* Some transfers of 64 bytes that wait in cycle `begin`, and how many cycles after it each is over. */
struct transfers {
  double gigabytes_per_second;
  unsigned megahertz;
  uint64_t begin;
  uint64_t over[REQUESTS];
};

static const struct transfers cases[] = {
    /* 9.99999 bytes a cycle: 6.4000064 cycles each, and so 12.8000128, 19.2000192, 25.6000256. */
    {999.999, 100000, 0, {7, 13, 20, 26}},
    {999.999, 100000, 20000000000000, {7, 13, 20, 26}},
    {999.999, 100000, (uint64_t)1 << 60, {7, 13, 20, 26}},
    /* 24.69 bytes a cycle: 2.5921..., 5.1842..., 7.7764..., 10.3685... */
    {12.345, 500, 3, {3, 6, 8, 11}},
    {12.345, 500, (uint64_t)1 << 60, {3, 6, 8, 11}},
    /* 1,999,999.998 bytes a cycle. */
    {999999.999, 500, 18446744092, {1, 1, 1, 1}}, /* where 64 bits end */
    {999999.999, 500, 20000000000, {1, 1, 1, 1}},
    /* A byte in 500 cycles: 32,000 for each. */
    {0.001, 500, (uint64_t)1 << 60, {32000, 64000, 96000, 128000}},
};

static struct trax_config config_of(const struct transfers *transfers, uint32_t channels) {
  struct trax_config config = bench_far(1, 1);
  config.memory.bandwidth_gbps = transfers->gigabytes_per_second * channels;
  config.memory.channels = channels;
  config.chip.clock_mhz = transfers->megahertz;
  return config;
}

static void check(const struct transfers *transfers, unsigned number, uint64_t completion, uint32_t latency) {
  if (completion != transfers->begin + transfers->over[number] + latency)
    fail_msg("%g GB/s at %u MHz, transfer %u from cycle %" PRIu64 ": back in %" PRIu64 ", not after %" PRIu64
             " cycles and %u",
             transfers->gigabytes_per_second, transfers->megahertz, number, transfers->begin, completion,
             transfers->over[number], latency);
}

/* The fast engine's, which knows when it has to look again. */
static void fast_controller(const struct transfers *transfers, uint32_t channels) {
  const struct trax_config config = config_of(transfers, channels);
  struct trax_memory memory;
  struct trax_memory_stats stats = {0};
  struct trax_tm tm = {0};
  assert_int_equal(trax_memory_create(&memory, &config, &stats, NULL), TRAX_OK);
  assert_true(trax_queue_create(&tm.queue, REQUESTS));
  for (unsigned i = 0; i < REQUESTS; i++) { /* all in channel 0 */
    const struct trax_request request = {.kind = TRAX_REQUEST_WRITE, .bytes = 64};
    trax_memory_submit(&memory, &tm, trax_queue_push(&tm.queue, request));
  }
  uint64_t t = transfers->begin;
  for (unsigned looks = 0; trax_memory_has_waiting(&memory); looks++) {
    assert_true(looks < REQUESTS);
    trax_memory_cycle(&memory, &tm, t);
    t = trax_memory_next_cycle(&memory, t);
  }
  for (unsigned i = 0; i < REQUESTS; i++)
    check(transfers, i, tm.queue.requests[i].completion, config.memory.latency_cycles);
  assert_int_equal(trax_memory_idle_from(&memory), transfers->begin + transfers->over[REQUESTS - 1]);
  trax_queue_destroy(&tm.queue);
  trax_memory_destroy(&memory);
}

static void reference_controller(const struct transfers *transfers, uint32_t channels) {
  const struct trax_config config = config_of(transfers, channels);
  static struct trax_ref_tm tm;
  static struct trax_machine machine; /* nobody listens */
  struct trax_ref_request queue[REQUESTS];
  struct trax_memory_stats stats = {0};
  struct trax_ref_chip chip = {.machine = &machine, .tm = &tm, .tms = 1, .config = &config, .stats = &stats};
  tm = (struct trax_ref_tm){.config = &config, .queue = queue, .places = REQUESTS};
  for (unsigned i = 0; i < REQUESTS; i++)
    queue[i] = (struct trax_ref_request){.kind = WRITE, .bytes = 64, .stage = AT_CHANNEL};
  assert_true(trax_ref_controller_create(&chip.controller, &config, NULL));
  const uint64_t end = transfers->begin + transfers->over[REQUESTS - 1];
  for (uint64_t t = transfers->begin; t < end; t++) {
    trax_ref_controller_cycle(&chip, t);
    assert_false(trax_ref_buses_idle(&chip, t));
  }
  for (unsigned i = 0; i < REQUESTS; i++)
    check(transfers, i, queue[i].completion, config.memory.latency_cycles);
  assert_true(trax_ref_buses_idle(&chip, end));
}

static void late_transfers(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    for (uint32_t channels = 1; channels <= 2; channels++) {
      fast_controller(&cases[i], channels);
      reference_controller(&cases[i], channels);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(late_transfers)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
