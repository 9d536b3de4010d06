/* Instructions that a burst has executed before their issue (emulator/fast/function), and the writes by other threads
   that must roll it back: small programs against the reference engine. Each thread's result is in memory. */
#include "compare.h"
#include "program.h"

#include <string.h>

enum {
  WORD = 0, /* at DATA; this and the next are in lines and blocks of their own */
  OTHER = 128,
  RESULT = 0x200, /* of thread i at DATA + RESULT + 64 i */
};

/* The code of a thread; r10 is DATA, r11 where its result goes, r4 a number of its own. */
typedef void part(struct program *program);

/* The next instruction begins a burst, since nobody reads the cycle counter before its time. */
static void begin_burst(struct program *program) {
  emit(program, trax_encode((trax_inst){TRAX_OP_RDSR, 9, 0, 0, TRAX_SR_CYCLE}));
}

/* What follows is issued after `count` divides, each of which needs the result of the one before. */
static void emit_divides(struct program *program, unsigned count) {
  for (unsigned i = 0; i < count; i++)
    emit(program, R(FDIV, 7, 7, 7));
}

/* The increment waits for the bus. */
static void increment_and_end(struct program *program) {
  for (uint8_t rd = 5; rd < 8; rd++)
    emit(program, I(LWNT, rd, 10, OTHER));
  emit(program, I(AINC, 8, 10, WORD));
}

/* The load is before the increment, and its issue is after it. */
static void load_after_increment(struct program *program) {
  emit_loop(program, 60, 0);
  begin_burst(program);
  emit_divides(program, 20);
  emit(program, I(LW, 5, 10, WORD));
  emit(program, S(SW, 5, 11, 0));
}

/* The burst rolls back for the second load when the first one's word has been incremented since its issue. */
static void load_both(struct program *program) {
  emit_loop(program, 60, 0);
  begin_burst(program);
  emit(program, I(LW, 5, 10, WORD));
  emit(program, I(LW, 6, 10, OTHER + 128)); /* the latest load counts as not issued */
  emit_divides(program, 60);
  emit(program, I(LW, 6, 10, OTHER));
  emit(program, R(ADD, 5, 5, 6));
  emit(program, S(SW, 5, 11, 0));
}

static void increment_and_store(struct program *program) {
  emit(program, S(SW, 0, 10, WORD)); /* so that bursts that load the words are watched */
  emit(program, S(SW, 0, 10, OTHER));
  emit_loop(program, 140, 0);
  emit(program, I(AINC, 5, 10, WORD));
  emit_loop(program, 40, 0);
  emit(program, S(SW, 4, 10, OTHER));
}

static void load_late(struct program *program) {
  emit_loop(program, 40, 0);
  begin_burst(program);
  emit_divides(program, 60);
  emit(program, I(LW, 5, 10, WORD));
  emit(program, S(SW, 5, 11, 0));
}

/* The controller performs the increment after the epoch of its issue, and its block has been loaded ahead meanwhile. */
static void increment_late(struct program *program) {
  emit_loop(program, 100, 0);
  increment_and_end(program);
  emit_loop(program, 900, 0);
}

static void store_past_cache(struct program *program) {
  emit(program, S(SW, 0, 10, WORD));
  emit_loop(program, 100, 0);
  emit(program, S(SWNT, 4, 10, WORD));
}

/* Stores the upper half of a word of local memory, and then reads the next word, which it must not have touched. */
static void store_half_word(struct program *program) {
  emit(program, S(SW, 4, 0, -8));
  emit(program, S(SW, 4, 0, -4));
  begin_burst(program);
  emit(program, S(SH, 0, 0, -6));
  emit_divides(program, 60);
  emit(program, I(LW, 5, 10, WORD));
  begin_burst(program);
  emit(program, I(LW, 6, 0, -8));
  emit(program, I(LW, 7, 0, -4));
  emit(program, S(SW, 6, 11, 4));
  emit(program, S(SW, 7, 11, 8));
}

static void store_in_between(struct program *program) {
  emit_loop(program, 100, 0);
  emit(program, S(SW, 4, 10, WORD));
}

/* Its burst is older than a snapshot that two others' stores to the word go back to. */
static void load_very_late(struct program *program) {
  emit_loop(program, 400, 0);
  begin_burst(program);
  emit_divides(program, 80);
  emit(program, I(LW, 5, 10, WORD));
  emit(program, S(SW, 5, 11, 0));
}

static void store_later(struct program *program) {
  emit_loop(program, 900, 0);
  emit(program, S(SW, 4, 10, WORD));
}

enum { PLENTY = 100000, /* GB/s: nobody waits for the bus */ LITTLE = 20 /* 100 cycles for a transfer */ };

static const struct scenario {
  const char *name;
  uint32_t tms, tps, latency; /* of memory: TMs run ahead of each other if it is at least 16 */
  double bandwidth;
  part *of[3];
} scenarios[] = {
    {"the last thread, while an increment by one that has ended waits",
     2,
     1,
     100,
     LITTLE,
     {increment_and_end, load_after_increment}},
    {"a load ahead of an increment that waits", 2, 1, 100, LITTLE, {increment_late, load_late}},
    {"a roll back over a load of what has been incremented since", 1, 2, 100, PLENTY, {increment_and_store, load_both}},
    {"a store past the cache by another TM", 2, 1, 1, PLENTY, {store_past_cache, load_late}},
    {"a roll back over a store of half a word", 1, 2, 100, PLENTY, {store_in_between, store_half_word}},
    {"different stores by two TMs to what a third one has loaded",
     3,
     1,
     17,
     PLENTY,
     {store_later, store_later, load_very_late}},
};

static void write_program(struct program *program, const struct scenario *scenario, unsigned delay) {
  program->count = 0;
  emit(program, trax_encode((trax_inst){TRAX_OP_RDSR, 1, 0, 0, TRAX_SR_TM}));
  emit(program, trax_encode((trax_inst){TRAX_OP_RDSR, 2, 0, 0, TRAX_SR_TP}));
  emit(program, R(ADD, 1, 1, 2));
  emit(program, U(LUI, 10, DATA >> 16));
  emit(program, I(SLLI, 11, 1, 6));
  emit(program, R(ADD, 11, 11, 10));
  emit(program, I(ADDI, 11, 11, RESULT));
  emit(program, I(ADDI, 4, 1, 0x123));
  for (int32_t thread = 0; thread < (int32_t)(scenario->tms * scenario->tps); thread++) {
    emit(program, I(ADDI, 2, 0, thread));
    const size_t branch = program->count;
    emit(program, NOP);
    for (unsigned i = 0; i < delay && thread == 0; i++)
      emit(program, NOP);
    scenario->of[thread](program);
    emit(program, HALT);
    program->words[branch] = B(BNE, 1, 2, ((int32_t)program->count - (int32_t)branch) * 4);
  }
}

static void rolls_back(void **state) {
  static const char *const engines[] = {"fast", "fast-interpreted", "fast-translated"};
  (void)state;
  for (size_t i = 0; i < sizeof scenarios / sizeof *scenarios; i++)
    for (unsigned delay = 0; delay < 60; delay += 10) {
      const struct scenario *const scenario = &scenarios[i];
      struct trax_config config = bench_far(scenario->tms, scenario->tps);
      config.icache.line_bytes = config.icache.bytes = 4096;
      config.memory.latency_cycles = scenario->latency;
      config.special.latency_cycles = 20;
      config.memory.bandwidth_gbps = scenario->bandwidth;
      config.memory.min_transfer_bytes = 4096;
      struct program program;
      write_program(&program, scenario, delay);
      struct run reference = run_alone(&config, program.words, program.count, "reference", 0, 1);
      for (unsigned k = 0; k < sizeof engines / sizeof *engines; k++) {
        struct run fast = run_alone(&config, program.words, program.count, engines[k], 0, 1);
        struct difference difference;
        if (different_runs(&difference, &reference, &fast))
          fail_msg("%s, %u cycles later, %s: %s", scenario->name, delay, engines[k], difference.text);
        end(&fast);
      }
      end(&reference);
    }
}

/* The first store to the input makes all of it data like others: stores in later epochs are no conflicts. */
static void input_is_written(void **state) {
  (void)state;
  struct trax_config config = bench_far(2, 1);
  struct program program = {.count = 0};
  const uint32_t begin[] = {trax_encode((trax_inst){TRAX_OP_RDSR, 1, 0, 0, TRAX_SR_TM}),
                            U(LUI, 10, DATA >> 16),
                            I(ADDI, 11, 0, 1),
                            I(SLLI, 11, 11, 15),
                            R(ADD, 10, 10, 11) /* in the midst of the input */,
                            I(SLLI, 1, 1, 10),
                            R(ADD, 10, 10, 1)};
  for (size_t i = 0; i < sizeof begin / sizeof *begin; i++)
    emit(&program, begin[i]);
  for (int32_t i = 0; i < 8; i++) {
    emit_loop(&program, 1000, I(LW, 5, 10, 64 * i));
    emit(&program, S(SW, 5, 10, 64 * i + 4));
  }
  emit(&program, HALT);
  if (program.count % 2 == 0)
    emit(&program, HALT); /* run_alone gives machines with an odd number of words an input */
  struct run run = run_alone(&config, program.words, program.count, "fast", 0, 1);
  assert_true(run.bench.machine->space.input_bytes);
  assert_int_equal(run.bench.status, TRAX_OK);
  assert_int_equal(run.bench.machine->slow_paths.conflicts, 2); /* the first store, and the end of the run */
  end(&run);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(rolls_back), cmocka_unit_test(input_is_written)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
