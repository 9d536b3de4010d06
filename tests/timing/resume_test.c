/* A run that goes on from a checkpoint ends as the one that was not disturbed, whatever ends it: the watchdog, the
   limit of cycles, the program; and the checkpoints that both write on the way are the same. Several TMs, so that they
   run ahead of each other between the cycles in which somebody looks. */
#include "compare.h"
#include "temporary.h"

#include "host/checkpoint.h"
#include "report/watchdog.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { TMS = 3, TPS = 2, MOST_WORDS = 128, BUSY_TURNS = 40 };

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

/* What ends or disturbs a run; 0: nothing. */
struct end {
  uint64_t watchdog, max_cycles, checkpoint_at;
};

struct leg {
  struct end end;
  const char *resume, *write;
  struct trax_checkpoint *checkpoint;
  struct trax_watchdog *watchdog;
  uint8_t *written; /* the checkpoint, if it wrote one */
  size_t written_bytes;
};

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
    fail_msg("%s, resumed before %" PRIu64 ", watchdog %" PRIu64 ", limit %" PRIu64 ", checkpoint at %" PRIu64 ": %s",
             which, begin, end.watchdog, end.max_cycles, end.checkpoint_at, difference.text);
}

/* The run of `end_of` from the cycle `begin` on against the one from the beginning on, and what it wrote against the
   run that nothing ends, `plain`. */
static void check(const struct trax_config *config, const struct program *program, const struct run *plain,
                  struct end end_of, uint64_t begin) {
  const char *first = test_path("first"), *second = test_path("second");
  struct leg whole = {.end = {.watchdog = end_of.watchdog, .max_cycles = end_of.max_cycles}};
  struct leg stopped = {.end = {.watchdog = end_of.watchdog, .max_cycles = begin}, .write = first};
  struct leg resumed = {.end = end_of, .resume = first, .write = end_of.checkpoint_at ? second : NULL};
  struct leg last = {.resume = second};
  struct run expected = run_leg(&whole, config, program, 1);
  if (begin < expected.bench.machine->stats.cycles) {
    struct run before = run_leg(&stopped, config, program, 2);
    assert_int_equal(before.bench.status, TRAX_STUCK);
    assert_int_equal(before.bench.machine->stats.cycles, begin);
    put_back(&stopped);
    struct run after = run_leg(&resumed, config, program, 2);
    expect_alike(&expected, &after, "the run", end_of, begin);
    if (resumed.written) {
      put_back(&resumed);
      struct run rest = run_leg(&last, config, program, 2);
      expect_alike(plain, &rest, "the run from its checkpoint on", end_of, begin);
      end(&rest);
      unlink(second);
    }
    unlink(first);
    end(&before);
    end(&after);
  }
  end(&expected);
  free(stopped.written);
  free(resumed.written);
}

static void every_end(void **state) {
  (void)state;
  struct trax_config config = bench_far(TMS, TPS);
  config.memory.size_mib = 1;
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
  for (size_t i = 0; i < sizeof watchdogs / sizeof *watchdogs; i++)
    for (size_t j = 0; j < sizeof limits / sizeof *limits; j++)
      for (size_t k = 0; k < sizeof places / sizeof *places; k++)
        for (size_t l = 0; l < sizeof begins / sizeof *begins; l++)
          if ((!limits[j] || begins[l] < limits[j]) && (!places[k] || begins[l] < places[k]))
            check(&config, &program, &run, (struct end){watchdogs[i], limits[j], places[k]}, begins[l]);
  end(&run);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_end)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
