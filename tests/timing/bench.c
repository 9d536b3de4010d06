#include "bench.h"

#include <stdlib.h>
#include <string.h>

struct trax_config bench_near(uint32_t tms, uint32_t tps) {
  struct trax_config config = TRAX_CONFIG_DEFAULT;
  config.chip.tms = tms;
  config.chip.tps_per_tm = tps;
  config.memory.latency_cycles = 0;
  config.memory.bandwidth_gbps = 1e6;
  config.memory.size_mib = 4;
  config.icache.line_bytes = 1024;
  return config;
}

struct trax_config bench_far(uint32_t tms, uint32_t tps) {
  struct trax_config config = TRAX_CONFIG_DEFAULT;
  config.chip.tms = tms;
  config.chip.tps_per_tm = tps;
  config.memory.size_mib = 4;
  config.icache.ports_per_bank = 64;
  return config;
}

static struct bench_told *told(struct bench *bench, uint32_t tm, uint32_t tp) {
  return &bench->told[tm * bench->machine->config.chip.tps_per_tm + tp];
}

static void record_issue(void *context, const struct trax_issue *issue) {
  struct bench *bench = context;
  struct bench_issues *issues = &bench->issues;
  struct bench_told *thread = told(bench, issue->tm, issue->tp);
  assert_int_equal(issue->cycle, thread->until);
  thread->until++;
  thread->cycles[TRAX_CAUSE_ISSUED]++;
  if (issues->count == issues->capacity) {
    issues->capacity = issues->capacity ? 2 * issues->capacity : 256;
    issues->issue = realloc(issues->issue, issues->capacity * sizeof *issues->issue);
    assert_non_null(issues->issue);
  }
  issues->issue[issues->count++] = *issue;
}

static void record_charge(void *context, uint32_t tm, uint32_t tp, trax_cause cause, unsigned rd, uint64_t since,
                          uint64_t cycles) {
  struct bench_told *thread = told(context, tm, tp);
  assert_int_equal(since, thread->until);
  assert_true(cycles > 0 && cause != TRAX_CAUSE_ISSUED);
  assert_true(!rd || trax_is_wait(cause)); /* a fence also waits for stores, which have no register */
  thread->waits[rd] += rd ? cycles : 0;
  thread->until += cycles;
  thread->cycles[cause] += cycles;
}

bool bench_ahead;

void bench_run_observed(struct bench *bench, const trax_run_options *options) {
  struct trax_machine *machine = bench->machine;
  const struct trax_observer observer = {
      .context = bench, .ahead = bench_ahead, .issue = record_issue, .charge = record_charge};
  machine->observer = &observer;
  bench->status = trax_machine_run(machine, options, &bench->error);
  machine->observer = NULL;
  for (uint64_t i = 0; i < machine->stats.threads; i++) {
    assert_int_equal(bench->told[i].until, machine->stats.cycles);
    assert_memory_equal(bench->told[i].cycles, machine->tp_stats[i].cycles, sizeof bench->told[i].cycles);
  }
}

struct bench bench_begin(const struct trax_config *config, const uint32_t *words, size_t count) {
  struct bench bench = {0};
  bench.machine = trax_machine_create(config, &bench.error);
  if (!bench.machine)
    fail_msg("%s", bench.error.message);
  bench.told = calloc(bench.machine->stats.threads, sizeof *bench.told);
  assert_non_null(bench.told);
  uint8_t *host;
  const unsigned read = TRAX_PERMIT_READ;
  assert_int_equal(trax_machine_map(bench.machine, TEXT, (uint32_t)count * 4, read | TRAX_PERMIT_EXECUTE, &host, NULL),
                   TRAX_OK);
  memcpy(host, words, count * 4);
  assert_int_equal(trax_machine_map(bench.machine, DATA, DATA_BYTES, read | TRAX_PERMIT_WRITE, NULL, NULL), TRAX_OK);
  assert_int_equal(trax_machine_map(bench.machine, RODATA, 64, read, NULL, NULL), TRAX_OK);
  assert_int_equal(trax_machine_set_entry(bench.machine, TEXT, &bench.error), TRAX_OK);
  return bench;
}

void bench_run(struct bench *bench, uint64_t max_cycles) {
  /* The tests run once with each engine. */
  const trax_run_options options = {.max_cycles = max_cycles, .engine = getenv("TRAX_ENGINE")};
  bench_run_observed(bench, &options);
}

struct bench bench_of(const struct trax_config *config, const uint32_t *words, size_t count) {
  struct bench bench = bench_begin(config, words, count);
  bench_run(&bench, 0);
  if (bench.status != TRAX_OK)
    fail_msg("%s", bench.error.message);
  return bench;
}

void bench_end(struct bench *bench) {
  trax_machine_destroy(bench->machine);
  free(bench->issues.issue);
  free(bench->told);
  memset(bench, 0, sizeof *bench);
}

uint64_t bench_cycles(const struct bench *bench) {
  return bench->machine->stats.cycles;
}

uint64_t bench_charge(const struct bench *bench, unsigned thread, trax_cause cause) {
  return bench->machine->tp_stats[thread].cycles[cause];
}

uint64_t bench_total(const struct bench *bench, trax_cause cause) {
  return bench->machine->stats.total.cycles[cause];
}

uint32_t bench_word(const struct bench *bench, uint32_t address) {
  uint32_t word;
  memcpy(&word, bench->machine->space.bytes + address, sizeof word);
  return word;
}

void bench_expect_issues(const struct bench *bench, unsigned thread, const uint64_t *cycles, size_t count,
                         const char *file, int line) {
  const uint32_t tps = bench->machine->config.chip.tps_per_tm;
  size_t found = 0;
  for (size_t i = 0; i < bench->issues.count; i++) {
    const struct trax_issue *issue = &bench->issues.issue[i];
    if (issue->tm * tps + issue->tp != thread)
      continue;
    if (found >= count || cycles[found] != issue->cycle) {
      print_error("thread %u: instruction %zu (pc 0x%x) issued in cycle %llu, expected %lld\n", thread, found,
                  issue->pc, (unsigned long long)issue->cycle, found < count ? (long long)cycles[found] : -1LL);
      _fail(file, line);
    }
    found++;
  }
  if (found != count) {
    print_error("thread %u issued %zu instructions, expected %zu\n", thread, found, count);
    _fail(file, line);
  }
}

void bench_expect_charges(const struct bench *bench, unsigned thread, const uint64_t *pairs, size_t count,
                          const char *file, int line) {
  static const char *const names[] = {
#define NAME(ID, JSON, ...) JSON,
      TRAX_CAUSES(NAME)
#undef NAME
  };
  uint64_t expected[TRAX_CAUSE_COUNT] = {0};
  for (size_t i = 0; i + 1 < count; i += 2)
    expected[pairs[i]] = pairs[i + 1];
  for (unsigned cause = TRAX_CAUSE_ISSUED + 1; cause < TRAX_CAUSE_HALTED; cause++) {
    const uint64_t charged = bench_charge(bench, thread, (trax_cause)cause);
    if (charged != expected[cause]) {
      print_error("thread %u: %llu cycles of %s, expected %llu\n", thread, (unsigned long long)charged, names[cause],
                  (unsigned long long)expected[cause]);
      _fail(file, line);
    }
  }
}
