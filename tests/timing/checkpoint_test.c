/* Checkpoints of random programs: the run that goes on from one ends as the one that was not disturbed, and so does the
   one that wrote it. Damaged files are refused.

   TRAX_RANDOM_ROUNDS and TRAX_RANDOM_SEED make it longer and different. */
#include "compare.h"
#include "temporary.h"

#include "host/checkpoint.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *path;

struct asked {
  struct trax_checkpoint_options options;
  struct trax_checkpoint *checkpoint;
};

static void begin_checkpoint(void *context, struct trax_machine *machine) {
  struct asked *asked = context;
  trax_error error;
  if (trax_checkpoint_begin(&asked->checkpoint, machine, &asked->options, &error) != TRAX_OK)
    fail_msg("%s", error.message);
}

static struct run run_asked(const struct trax_config *config, const uint32_t *program, size_t count,
                            struct trax_checkpoint_options options, uint64_t max_cycles) {
  struct asked asked = {.options = options};
  const trax_run_options run_options = {.max_cycles = max_cycles, .host_threads = 1};
  struct run run = run_prepared(config, program, count, &run_options, begin_checkpoint, &asked);
  trax_error error;
  if (trax_checkpoint_end(asked.checkpoint, &error) != TRAX_OK)
    fail_msg("%s", error.message);
  return run;
}

/* The resumed run has the end of the output. */
static void complete_output(struct run *resumed, const struct run *whole) {
  assert_true(resumed->output_bytes <= whole->output_bytes);
  char *output = malloc(whole->output_bytes + 1);
  const size_t before = whole->output_bytes - resumed->output_bytes;
  assert_non_null(output);
  memcpy(output, whole->output, before);
  memcpy(output + before, resumed->output, resumed->output_bytes);
  free(resumed->output);
  resumed->output = output;
  resumed->output_bytes = whole->output_bytes;
}

static void each(size_t (*generate)(uint32_t *), unsigned rounds) {
  const unsigned seed = setting("TRAX_RANDOM_SEED", 1);
  rounds = setting("TRAX_RANDOM_ROUNDS", rounds);
  for (unsigned round = 0; round < rounds; round++) {
    random_state = 0x9FB21C651E98DF25u * (seed + round);
    uint32_t program[BODY + 64];
    const size_t count = generate(program);
    const uint32_t tms = any(1, 4), tps = any(1, MAX_THREADS / tms > 64 ? 64 : MAX_THREADS / tms);
    const struct trax_config config = any_config(tms, tps);
    struct run whole = run_alone(&config, program, count, "fast", 0, 1);
    const uint64_t cycles = whole.bench.machine->stats.cycles, at = any(1, (uint32_t)cycles);
    if (any(0, 3)) {
      struct run writing =
          run_asked(&config, program, count, (struct trax_checkpoint_options){.write = path, .at = at}, 0);
      expect_same(&whole, &writing);
      end(&writing);
    } else { /* the run is stopped there */
      struct run stopped = run_asked(&config, program, count, (struct trax_checkpoint_options){.write = path}, at);
      end(&stopped);
    }
    if (access(path, R_OK) == 0) { /* not where a run that is to be stopped ends before */
      struct run resumed = run_asked(&config, program, count, (struct trax_checkpoint_options){.resume = path}, 0);
      complete_output(&resumed, &whole);
      expect_same(&whole, &resumed);
      end(&resumed);
      unlink(path);
    }
    end(&whole);
  }
}

static void own_words(void **state) {
  (void)state;
  each(any_program, 15);
}

static void races(void **state) {
  (void)state;
  each(any_racing_program, 25);
}

/* From one checkpoint to the next. */
static void relay(void **state) {
  (void)state;
  random_state = 7;
  uint32_t program[BODY + 64];
  const size_t count = any_program(program);
  const struct trax_config config = any_config(2, 16);
  struct run whole = run_alone(&config, program, count, "fast", 0, 1);
  const uint64_t cycles = whole.bench.machine->stats.cycles;
  struct trax_checkpoint_options options = {.write = path};
  unsigned legs = 0;
  for (uint64_t limit = 1 + cycles / 7;; limit += 1 + cycles / 7, legs++) {
    struct run leg = run_asked(&config, program, count, options, limit);
    options.resume = path;
    if (leg.bench.status == TRAX_STUCK) {
      end(&leg);
      continue;
    }
    expect_same(&whole, &leg);
    end(&leg);
    break;
  }
  assert_true(legs >= 6);
  unlink(path);
  end(&whole);
}

/* An increment waits for the bus at the checkpoint, behind stores; another thread loads the word after it, in
   instructions that may run ahead before. */
static void pending_increment(void **state) {
  (void)state;
  struct trax_config config = bench_far(1, 2);
  config.icache.line_bytes = config.icache.bytes = 4096; /* all instructions are there before the first one */
  config.memory.bandwidth_gbps = 0.1;
  uint32_t program[64];
  size_t count = 0;
  program[count++] = trax_encode((trax_inst){TRAX_OP_RDSR, 1, 0, 0, TRAX_SR_TP});
  program[count++] = U(LUI, 10, DATA >> 16);
  const size_t branch = count++;
  for (int32_t i = 1; i <= 10; i++)
    program[count++] = S(SWNT, 10, 10, 64 * i);
  program[count++] = I(AINC, 5, 10, 0);
  program[count++] = HALT;
  program[branch] = B(BNE, 1, 0, ((int32_t)count - (int32_t)branch) * 4);
  for (unsigned i = 0; i < 40; i++)
    program[count++] = R(FDIV, 2, 2, 2);
  program[count++] = I(LW, 6, 10, 0);
  program[count++] = S(SW, 6, 10, 128);
  program[count++] = HALT;
  struct run whole = run_alone(&config, program, count, "reference", 0, 1);
  const uint64_t cycles = whole.bench.machine->stats.cycles;
  for (uint64_t at = cycles - 900; at < cycles; at += 31) {
    struct run writing =
        run_asked(&config, program, count, (struct trax_checkpoint_options){.write = path, .at = at}, 0);
    end(&writing);
    struct run resumed = run_asked(&config, program, count, (struct trax_checkpoint_options){.resume = path}, 0);
    struct difference difference;
    if (different_runs(&difference, &whole, &resumed))
      fail_msg("checkpoint at %" PRIu64 " of %" PRIu64 ": %s", at, cycles, difference.text);
    end(&resumed);
    unlink(path);
  }
  end(&whole);
}

static void damaged_files(void **state) {
  (void)state;
  random_state = 11;
  uint32_t program[BODY + 64];
  const size_t count = any_program(program);
  const struct trax_config config = any_config(2, 8);
  struct run stopped = run_asked(&config, program, count, (struct trax_checkpoint_options){.write = path}, 100);
  assert_int_equal(stopped.bench.status, TRAX_STUCK);
  end(&stopped);
  static uint8_t bytes[1 << 20];
  FILE *file = fopen(path, "rb");
  const size_t size = fread(bytes, 1, sizeof bytes, file);
  fclose(file);
  assert_true(size > 100 && size < sizeof bytes);
  for (unsigned i = 0; i < 500; i++) {
    const size_t place = i < 80 ? i : any(0, (uint32_t)size - 1);
    const bool cut = i % 5 == 4;
    const uint8_t before = bytes[place];
    bytes[place] ^= (uint8_t)(1u << any(0, 7));
    file = fopen(path, "wb");
    fwrite(bytes, 1, cut ? place : size, file);
    fclose(file);
    bytes[place] = before;
    struct bench bench = bench_begin(&config, program, count);
    struct trax_checkpoint *checkpoint;
    trax_error error = {""};
    const struct trax_checkpoint_options options = {.resume = path};
    assert_int_equal(trax_checkpoint_begin(&checkpoint, bench.machine, &options, &error), TRAX_ERROR);
    assert_memory_equal(error.message, path, strlen(path));
    bench_end(&bench);
  }
  unlink(path);
}

int main(void) {
  path = test_path("checkpoint");
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(own_words),         cmocka_unit_test(races),         cmocka_unit_test(relay),
      cmocka_unit_test(pending_increment), cmocka_unit_test(damaged_files),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
