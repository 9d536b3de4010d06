/* A run that goes on from a checkpoint ends as the one that was not disturbed, whatever ends it: the watchdog, the
   limit of cycles, an interrupt, a fault, the program; and a run goes on from the checkpoint that it writes then.
   Several TMs, each of which ends in its own way or not at all, and which run ahead of each other between the cycles in
   which somebody looks. */
#include "compare.h"
#include "temporary.h"

#include "host/checkpoint.h"
#include "report/watchdog.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { TMS = 3, TPS = 2, MOST_WORDS = 128, BUSY_TURNS = 40, SILENT_TURNS = 500 };
#define COUNT_OF(ARRAY) (sizeof(ARRAY) / sizeof *(ARRAY))

struct program {
  uint32_t words[MOST_WORDS];
  size_t count;
};

static void emit(struct program *program, uint32_t word) {
  assert_true(program->count < MOST_WORDS);
  program->words[program->count++] = word;
}

/* Items, loads and stores for a while; then every thread counts down in silence, and longer in the higher TMs; a word
   at the end says that it was there. */
static void write_program(struct program *program) {
  program->count = 0;
  emit(program, trax_encode((trax_inst){TRAX_OP_RDSR, 1, 0, 0, TRAX_SR_THREAD}));
  emit(program, U(LUI, 10, DATA >> 16));
  emit(program, I(SLLI, 2, 1, 6));
  emit(program, R(ADD, 11, 10, 2));
  emit(program, I(ADDI, 3, 0, BUSY_TURNS));
  emit(program, I(ADDI, 4, 0, 1));
  const size_t busy = program->count;
  emit(program, I(LW, 5, 11, 0));
  emit(program, R(ADD, 6, 6, 5));
  emit(program, S(SW, 6, 11, 4));
  emit(program, I(AINC, 7, 10, 0x400));
  emit(program, T(4, TRAX_TRAP_ITEMS));
  emit(program, I(ADDI, 3, 3, -1));
  emit(program, B(BNE, 3, 0, ((int32_t)busy - (int32_t)program->count) * 4));
  emit(program, I(ADDI, 3, 1, 4));
  emit(program, I(SLLI, 3, 3, 8));
  const size_t idle = program->count;
  emit(program, I(LW, 5, 11, 0));
  emit(program, I(ADDI, 3, 3, -1));
  emit(program, B(BNE, 3, 0, ((int32_t)idle - (int32_t)program->count) * 4));
  emit(program, S(SW, 4, 11, 8));
  emit(program, HALT);
}

/* --- what a TM does --- */

enum behaviour { HALTS_SOON, HALTS_LATE, FAULTS, IS_SILENT, GOES_ON, BEHAVIOURS };

static void emit_work(struct program *program) {
  emit(program, I(LW, 5, 11, 0));
  emit(program, R(ADD, 6, 6, 5));
  emit(program, S(SW, 6, 11, 4));
  emit(program, I(AINC, 7, 10, 0x400));
  emit(program, T(4, TRAX_TRAP_ITEMS));
}

/* Back to the word `to` while r3, which counts down, is not 0, or for ever. */
static void emit_loop(struct program *program, size_t to, bool for_ever) {
  emit(program, I(ADDI, 3, 3, -1));
  emit(program, B(BNE, for_ever ? 4 : 3, 0, ((int32_t)to - (int32_t)program->count) * 4));
}

static void emit_behaviour(struct program *program, enum behaviour behaviour) {
  emit(program, I(ADDI, 3, 0, 2));
  const size_t work = program->count;
  emit_work(program);
  emit_loop(program, work, behaviour == GOES_ON);
  if (behaviour == HALTS_LATE || behaviour == FAULTS || behaviour == IS_SILENT) {
    emit(program, I(ADDI, 3, 0, behaviour == FAULTS ? SILENT_TURNS + 100 : SILENT_TURNS));
    const size_t silent = program->count;
    emit(program, I(LW, 5, 11, 0));
    emit_loop(program, silent, behaviour == IS_SILENT);
  }
  if (behaviour == FAULTS)
    emit(program, I(LW, 5, 0, 0));
  emit(program, S(SW, 4, 11, 8));
  emit(program, HALT);
}

static void write_behaviours(struct program *program, const enum behaviour *behaviours) {
  program->count = 0;
  emit(program, U(RDSR, 1, TRAX_SR_THREAD));
  emit(program, U(RDSR, 2, TRAX_SR_TM));
  emit(program, U(LUI, 10, DATA >> 16));
  emit(program, I(SLLI, 11, 1, 6));
  emit(program, R(ADD, 11, 10, 11));
  emit(program, I(ADDI, 4, 0, 1));
  for (uint32_t tm = 0; tm < TMS; tm++) {
    emit(program, I(ADDI, 3, 0, (int32_t)tm));
    const size_t branch = program->count;
    emit(program, 0);
    emit_behaviour(program, behaviours[tm]);
    program->words[branch] = B(BNE, 2, 3, (int32_t)(program->count - branch) * 4);
  }
}

/* --- runs --- */

/* The event that ends or disturbs a run; 0: none. */
struct end {
  uint64_t watchdog, max_cycles, interrupt, checkpoint_at;
};

struct leg {
  struct end end;
  struct trax_watch interrupt;
  const char *resume, *write;
  struct trax_checkpoint *checkpoint;
  struct trax_watchdog *watchdog;
  uint8_t *written; /* the checkpoint, if it wrote one */
  size_t written_bytes;
};

static trax_status interrupt(struct trax_watch *watch, struct trax_run *run, uint64_t t) {
  (void)run;
  (void)t;
  watch->next = TRAX_NEVER;
  return TRAX_INTERRUPTED;
}

static void prepare(void *context, struct trax_machine *machine) {
  struct leg *leg = context;
  const struct trax_checkpoint_options options = {
      .write = leg->write, .at = leg->end.checkpoint_at, .resume = leg->resume};
  trax_error error;
  if (trax_checkpoint_begin(&leg->checkpoint, machine, &options, &error) != TRAX_OK)
    fail_msg("%s", error.message);
  if (leg->end.watchdog) {
    leg->watchdog = trax_watchdog_begin(machine, leg->end.watchdog);
    assert_non_null(leg->watchdog);
  }
  if (leg->end.interrupt) {
    leg->interrupt = (struct trax_watch){.next = leg->end.interrupt, .inspect = interrupt};
    trax_machine_watch(machine, &leg->interrupt);
  }
}

static void read_written(struct leg *leg) {
  FILE *file = leg->write ? fopen(leg->write, "rb") : NULL;
  if (!file)
    return;
  leg->written = malloc(1 << 20);
  assert_non_null(leg->written);
  leg->written_bytes = fread(leg->written, 1, 1 << 20, file);
  fclose(file);
  unlink(leg->write);
}

static struct run run_leg(struct leg *leg, const struct trax_config *config, const struct program *program,
                          unsigned threads) {
  const trax_run_options options = {.max_cycles = leg->end.max_cycles, .host_threads = threads};
  struct run run = run_prepared(config, program->words, program->count, &options, prepare, leg);
  trax_error error;
  trax_watchdog_end(leg->watchdog);
  leg->watchdog = NULL;
  if (leg->end.interrupt)
    trax_machine_unwatch(run.bench.machine, &leg->interrupt);
  if (trax_checkpoint_end(leg->checkpoint, &error) != TRAX_OK)
    fail_msg("%s", error.message);
  read_written(leg);
  return run;
}

static void put_back(const struct leg *leg) {
  FILE *file = fopen(leg->write, "wb");
  assert_int_equal(fwrite(leg->written, 1, leg->written_bytes, file), leg->written_bytes);
  fclose(file);
}

static void expect_alike(const struct run *expected, const struct run *run, const char *which, struct end end,
                         uint64_t begin) {
  struct difference difference;
  if (different_runs(&difference, expected, run))
    fail_msg("%s, resumed before %" PRIu64 ", watchdog %" PRIu64 ", limit %" PRIu64 ", interrupt %" PRIu64
             ", checkpoint at %" PRIu64 ": %s",
             which, begin, end.watchdog, end.max_cycles, end.interrupt, end.checkpoint_at, difference.text);
}

/* Compares the run of `end_of` from the cycle `begin` on with `expected`, the one from the beginning on. What it writes
   goes on as `plain`, which nothing ends but its own limit. False: the run has ended before. */
static bool check(const struct trax_config *config, const struct program *program, const struct run *plain,
                  uint64_t plain_limit, const struct run *expected, struct end end_of, uint64_t begin,
                  bool interrupted) {
  const char *first = test_path("first"), *second = test_path("second");
  struct leg stopped = {.end = {.watchdog = end_of.watchdog}, .write = first};
  *(interrupted ? &stopped.end.interrupt : &stopped.end.max_cycles) = begin;
  struct leg resumed = {.end = end_of, .resume = first, .write = second};
  struct leg last = {.end = {.max_cycles = plain_limit}, .resume = second};
  if (begin >= expected->bench.machine->stats.cycles)
    return false;
  struct run before = run_leg(&stopped, config, program, 2);
  assert_int_equal(before.bench.status, interrupted ? TRAX_INTERRUPTED : TRAX_STUCK);
  assert_int_equal(before.bench.machine->stats.cycles, begin);
  put_back(&stopped);
  struct run after = run_leg(&resumed, config, program, 2);
  expect_alike(expected, &after, "the run", end_of, begin);
  if (resumed.written) {
    put_back(&resumed);
    struct run rest = run_leg(&last, config, program, 2);
    expect_alike(plain, &rest, "the run from its checkpoint on", end_of, begin);
    end(&rest);
    if (expected->bench.status == TRAX_STUCK) { /* the checkpoint of the end, with the same options: the same end */
      struct leg again = {.end = end_of, .resume = second};
      put_back(&resumed);
      struct run same = run_leg(&again, config, program, 2);
      expect_alike(expected, &same, "the end from its checkpoint on", end_of, begin);
      end(&same);
    }
    unlink(second);
  } else {
    assert_true(after.bench.status == TRAX_OK || after.bench.status == TRAX_FAULT);
  }
  unlink(first);
  end(&before);
  end(&after);
  free(stopped.written);
  free(resumed.written);
  return true;
}

/* Its instruction caches have the ports of the default, which the engine arbitrates in a third of the time. */
static struct trax_config machine(void) {
  struct trax_config config = bench_far(TMS, TPS);
  config.memory.size_mib = 1;
  config.icache.ports_per_bank = 1;
  return config;
}

static void every_end(void **state) {
  (void)state;
  const struct trax_config config = machine();
  struct program program;
  write_program(&program);
  struct leg plain = {0};
  struct run run = run_leg(&plain, &config, &program, 1);
  assert_int_equal(run.bench.status, TRAX_OK);
  const uint64_t cycles = run.bench.machine->stats.cycles;
  const uint64_t watchdogs[] = {0, 61, 1000, cycles / 3, 100 * cycles};
  const uint64_t limits[] = {0, cycles / 2 + 17, 2 * cycles};
  const uint64_t places[] = {0, cycles / 2 + 3, cycles - 2};
  const uint64_t begins[] = {1, cycles / 3, cycles / 2 + 1, cycles - 100};
  for (size_t i = 0; i < COUNT_OF(watchdogs); i++)
    for (size_t j = 0; j < COUNT_OF(limits); j++) {
      struct leg whole = {.end = {.watchdog = watchdogs[i], .max_cycles = limits[j]}};
      struct run expected = run_leg(&whole, &config, &program, 1);
      for (size_t k = 0; k < COUNT_OF(places); k++)
        for (size_t l = 0; l < COUNT_OF(begins); l++)
          if ((!limits[j] || begins[l] < limits[j]) && (!places[k] || begins[l] < places[k]))
            check(&config, &program, &run, 0, &expected,
                  (struct end){.watchdog = watchdogs[i], .max_cycles = limits[j], .checkpoint_at = places[k]},
                  begins[l], false);
      end(&expected);
    }
  end(&run);
}

enum kind { ENDED, FAULTED, STUCK, AT_THE_LIMIT, INTERRUPTED, KINDS };

static enum kind kind_of(const struct run *run, const struct end *end) {
  switch (run->bench.status) {
  case TRAX_OK:
    return ENDED;
  case TRAX_FAULT:
    return FAULTED;
  case TRAX_INTERRUPTED:
    return INTERRUPTED;
  default:
    return run->bench.machine->stats.cycles < end->max_cycles ? STUCK : AT_THE_LIMIT;
  }
}

/* All TMs do each of the behaviours, and the run ends in each way that is possible then: every third combination, so
   that every two TMs do every two; all with TRAX_WHOLE. */
static void every_combination(void **state) {
  (void)state;
  enum { LIMIT = 4000 };
  static const struct end ends[] = {{.max_cycles = LIMIT},
                                    {.max_cycles = LIMIT, .watchdog = 300},
                                    {.max_cycles = LIMIT, .watchdog = 1100},
                                    {.max_cycles = LIMIT, .interrupt = 1700},
                                    {.max_cycles = LIMIT, .watchdog = 700, .interrupt = 900}};
  static const uint64_t begins[] = {250, 1000, 2100};
  const struct trax_config config = machine();
  unsigned resumed[KINDS][COUNT_OF(begins)] = {{0}};
  for (unsigned combination = 0; combination < BEHAVIOURS * BEHAVIOURS * BEHAVIOURS;
       combination += setting("TRAX_WHOLE", 0) ? 1 : 3) {
    const enum behaviour behaviours[TMS] = {combination % BEHAVIOURS, combination / BEHAVIOURS % BEHAVIOURS,
                                            combination / BEHAVIOURS / BEHAVIOURS};
    struct program program;
    write_behaviours(&program, behaviours);
    struct run plain = {.output = NULL};
    for (size_t i = 0; i < COUNT_OF(ends); i++) {
      struct leg whole = {.end = ends[i]};
      struct run expected = run_leg(&whole, &config, &program, 1);
      if (i == 0)
        plain = expected;
      for (size_t j = 0; j < COUNT_OF(begins); j++)
        resumed[kind_of(&expected, &ends[i])][j] +=
            check(&config, &program, &plain, LIMIT, &expected, ends[i], begins[j], (combination + i + j) % 2 != 0);
      if (i > 0)
        end(&expected);
    }
    end(&plain);
  }
  for (enum kind kind = 0; kind < KINDS; kind++)
    for (size_t j = 0; j < COUNT_OF(begins); j++) {
      print_message("%u ", resumed[kind][j]);
      assert_true(resumed[kind][j] > 0 || (kind == INTERRUPTED && begins[j] > 1700));
    }
  print_message("runs were resumed\n");
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_end), cmocka_unit_test(every_combination)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
