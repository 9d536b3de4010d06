#include "bench.h"

#include "machine/timing.h"

#include <pthread.h>
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

static void tell(struct bench_told *thread, trax_cause cause, uint64_t cycles) {
  thread->until += cycles;
  thread->cycles[cause] += cycles;
  for (uint64_t i = 0; i < cycles; i++)
    thread->causes = thread->causes * 0x100000001B3 + cause;
}

static void record_issue(void *context, const struct trax_issue *issue) {
  struct bench *bench = context;
  struct bench_issues *issues = &bench->issues;
  struct bench_told *thread = told(bench, issue->tm, issue->tp);
  assert_int_equal(issue->cycle, thread->until);
  tell(thread, TRAX_CAUSE_ISSUED, 1);
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
  tell(thread, cause, cycles);
}

/* --- stretches, as issues and charges --- */

bool bench_stretches;

/* Records the logged charges before the instruction `at` of a stretch, and returns how many have been recorded. */
static size_t record_logged(struct bench *bench, uint32_t tm, uint32_t tp, const struct trax_thread_log *log,
                            size_t recorded, unsigned at) {
  for (; recorded < log->charged_count && log->charged[recorded].at == at; recorded++)
    record_charge(bench, tm, tp, (trax_cause)log->charged[recorded].cause, log->charged[recorded].rd,
                  told(bench, tm, tp)->until, log->charged[recorded].cycles);
  return recorded;
}

static struct trax_thread_log *log_of(const struct bench *bench, uint32_t tm, uint32_t tp) {
  return &bench->machine->observer->logs[tm * bench->machine->config.chip.tps_per_tm + tp];
}

/* Whether an instruction is one that a stretch has alone. */
static bool is_single(trax_inst inst) {
  return inst.op == TRAX_OP_TRAP || inst.op == TRAX_OP_JALR || (inst.op == TRAX_OP_JAL && inst.rd) ||
         (inst.rd == TRAX_STACK_POINTER && trax_op_table[inst.op].flags & TRAX_WRITES_RD);
}

/* Records the refusals before an instruction. */
static void record_refused(struct bench *bench, const struct trax_stretch *stretch, unsigned at, trax_op op) {
  const struct trax_config *config = &bench->machine->config;
  const trax_shared unit = trax_op_table[op].access_bytes ? TRAX_SHARED_NONE : trax_timing_of(op, config).unit;
  const uint64_t *until = &told(bench, stretch->tm, stretch->tp)->until;
  const unsigned fetch = trax_refused_fetch(stretch->refused[at]), others = trax_refused_others(stretch->refused[at]);
  if (fetch)
    record_charge(bench, stretch->tm, stretch->tp, TRAX_CAUSE_ICACHE_BANK, 0, *until, fetch);
  if (others)
    record_charge(bench, stretch->tm, stretch->tp,
                  unit == TRAX_SHARED_NONE ? TRAX_CAUSE_DCACHE_BANK : trax_shared_kind(unit, config).refused, 0, *until,
                  others);
}

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER; /* threads of the host record at the same time */

static void record_stretch(void *context, const struct trax_stretch *stretch) {
  struct bench *bench = context;
  struct trax_thread_log *log = log_of(bench, stretch->tm, stretch->tp);
  size_t charged = 0, accessed = 0;
  unsigned at = 0;
  pthread_mutex_lock(&mutex);
  for (size_t i = 0; i < stretch->pieces; i++)
    for (uint32_t k = 0; k < stretch->piece[i].count; k++, at++) {
      struct trax_issue issue = {.tm = stretch->tm, .tp = stretch->tp, .pc = stretch->piece[i].pc + 4 * k};
      memcpy(&issue.word, bench->machine->space.bytes + issue.pc, sizeof issue.word);
      const trax_inst inst = trax_decode(issue.word);
      assert_true(stretch->count == 1 || !is_single(inst));
      charged = record_logged(bench, stretch->tm, stretch->tp, log, charged, at);
      if (stretch->refused)
        record_refused(bench, stretch, at, inst.op);
      issue.cycle = told(bench, stretch->tm, stretch->tp)->until;
      issue.next_pc = at + 1 == stretch->count           ? stretch->next_pc
                      : k + 1 == stretch->piece[i].count ? stretch->piece[i + 1].pc
                                                         : issue.pc + 4;
      issue.result = at + 1 == stretch->count ? stretch->result : 0;
      issue.address = trax_op_table[inst.op].access_bytes ? TRAX_LOCAL_BASE : 0;
      if (accessed < stretch->accessed_count && stretch->accessed[accessed].at == at) {
        issue.address = stretch->accessed[accessed].address;
        issue.outcome = stretch->accessed[accessed++].outcome;
      }
      record_issue(bench, &issue);
      assert_true(!is_single(inst) || issue.cycle == stretch->cycle);
      assert_int_equal(stretch->cycles != NULL, inst.op == TRAX_OP_TRAP);
      if (stretch->cycles)
        assert_memory_equal(stretch->cycles, told(bench, stretch->tm, stretch->tp)->cycles,
                            TRAX_CAUSE_COUNT * sizeof *stretch->cycles);
    }
  assert_int_equal(at, stretch->count);
  assert_int_equal(accessed, stretch->accessed_count);
  for (size_t i = charged; i < log->charged_count; i++)
    log->charged[i].at -= (uint8_t)at;
  log->charged_count -= charged;
  if (log->charged_count)
    memmove(log->charged, log->charged + charged, log->charged_count * sizeof *log->charged);
  pthread_mutex_unlock(&mutex);
}

/* What was recorded when the engine held, for it to go back to. */
static struct kept {
  size_t issues;
  struct bench_told *told;      /* [threads] */
  struct trax_thread_log *logs; /* [threads] */
} kept;

static void copy_log(struct trax_thread_log *to, const struct trax_thread_log *from) {
  to->charged_count = from->charged_count;
  if (from->charged_count > to->charged_capacity) {
    to->charged = realloc(to->charged, from->charged_count * sizeof *to->charged);
    assert_non_null(to->charged);
    to->charged_capacity = from->charged_count;
  }
  if (from->charged_count)
    memcpy(to->charged, from->charged, from->charged_count * sizeof *to->charged);
}

static void keep(void *context, bool holds) {
  const struct bench *bench = context;
  kept.issues = bench->issues.count;
  for (uint64_t i = 0; holds && i < bench->machine->stats.threads; i++) {
    kept.told[i] = bench->told[i];
    copy_log(&kept.logs[i], &bench->machine->observer->logs[i]);
  }
}

static void go_back(void *context) {
  struct bench *bench = context;
  bench->issues.count = kept.issues;
  for (uint64_t i = 0; i < bench->machine->stats.threads; i++) {
    bench->told[i] = kept.told[i];
    copy_log(&bench->machine->observer->logs[i], &kept.logs[i]);
  }
}

static int by_time(const void *a, const void *b) {
  const struct trax_issue *x = a, *y = b;
  if (x->cycle != y->cycle)
    return x->cycle < y->cycle ? -1 : 1;
  return x->tm != y->tm ? (int)x->tm - (int)y->tm : (int)x->tp - (int)y->tp;
}

static void end_stretches(struct bench *bench) {
  const uint32_t tps = bench->machine->config.chip.tps_per_tm;
  for (uint32_t i = 0; i < bench->machine->stats.threads; i++) {
    struct trax_thread_log *log = log_of(bench, i / tps, i % tps);
    assert_int_equal(record_logged(bench, i / tps, i % tps, log, 0, 0), log->charged_count);
    free(log->charged);
  }
  if (bench->issues.count)
    qsort(bench->issues.issue, bench->issues.count, sizeof *bench->issues.issue, by_time);
}

void bench_run_observed(struct bench *bench, const trax_run_options *options) {
  struct trax_machine *machine = bench->machine;
  struct trax_observer observer = {.context = bench,
                                   .issue = record_issue,
                                   .charge = record_charge,
                                   .stretch = bench_stretches ? record_stretch : NULL,
                                   .keep = bench_stretches ? keep : NULL,
                                   .go_back = bench_stretches ? go_back : NULL,
                                   .logs = calloc(machine->stats.threads, sizeof *observer.logs)};
  kept.told = calloc(machine->stats.threads, sizeof *kept.told);
  kept.logs = calloc(machine->stats.threads, sizeof *kept.logs);
  assert_true(observer.logs && kept.told && kept.logs);
  machine->observer = &observer;
  bench->status = trax_machine_run(machine, options, &bench->error);
  if (bench_stretches)
    end_stretches(bench);
  machine->observer = NULL;
  free(observer.logs);
  free(kept.told);
  for (uint64_t i = 0; i < machine->stats.threads; i++)
    free(kept.logs[i].charged);
  free(kept.logs);
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
