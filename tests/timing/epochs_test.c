/* TMs that run ahead of each other (emulator/fast/epochs.c) against the reference engine: what one of them writes
   while others read, write or increment it, in every order and distance within an epoch. Threads are quiet for so long
   that epochs are running when it happens, and after it. */
#include "compare.h"
#include "program.h"

#include <string.h>

enum {
  LATENCY = 17,     /* and so about the length of an epoch */
  QUIET = 200,      /* turns of a loop of two instructions */
  AFTERWARDS = 800, /* so many that no state is kept from before when the run ends, which is found cycle by cycle */
  OTHER = 8,        /* of the same small block as the word at DATA, which this makes one that has been written */
  RESULTS = 0x100,  /* results of TM i are at DATA + RESULTS + 64 i */
  TRAFFIC = 0x200,  /* from a TM's results to what it writes so that requests wait */
  WRITES = 12,
  WORD = 0,
};

/* What a TM does when it is time; r10 is DATA, r11 where its results go, r4 a number of its own. */
typedef void action(struct program *program);

static void store_word(struct program *program) {
  emit(program, S(SW, 4, 10, WORD));
}
/* What an increment makes of it, or another TM stores. */
static void store_one(struct program *program) {
  emit(program, I(ADDI, 4, 0, 1));
  emit(program, S(SW, 4, 10, WORD));
}
static void store_past_cache(struct program *program) {
  emit(program, S(SWNT, 4, 10, WORD));
}
static void store_first_byte(struct program *program) {
  emit(program, S(SB, 4, 10, WORD));
}
static void store_second_byte(struct program *program) {
  emit(program, S(SB, 4, 10, WORD + 1));
}
static void load_word(struct program *program) {
  emit(program, I(LW, 5, 10, WORD));
  emit(program, S(SW, 5, 11, 0));
}
static void load_past_cache(struct program *program) {
  emit(program, I(LWNT, 5, 10, WORD));
  emit(program, S(SW, 5, 11, 0));
}
static void load_second_byte(struct program *program) {
  emit(program, I(LBU, 5, 10, WORD + 1));
  emit(program, S(SW, 5, 11, 0));
}
/* Its own byte and another TM's. */
static void store_byte_and_load_word(struct program *program) {
  store_first_byte(program);
  for (unsigned i = 0; i < 3; i++)
    emit(program, NOP);
  load_word(program);
}
static void store_and_load_word(struct program *program) {
  store_word(program);
  load_word(program);
  emit(program, I(LH, 6, 10, WORD + 2));
  emit(program, S(SW, 6, 11, 4));
}
/* The load is the last step of the burst, which the cycle counter ends, and beside the run that the store began. */
static void store_and_load_beside(struct program *program) {
  store_word(program);
  emit(program, I(LW, 5, 10, WORD + 4));
  emit(program, trax_encode((trax_inst){TRAX_OP_RDSR, 6, 0, 0, TRAX_SR_CYCLE}));
  emit(program, S(SW, 5, 11, 0));
}
/* The second byte twice. */
static void store_bytes_and_load_word(struct program *program) {
  store_second_byte(program);
  emit(program, I(XORI, 4, 4, 0x27));
  store_first_byte(program);
  store_second_byte(program);
  load_word(program);
}
static void increment(struct program *program) {
  emit(program, I(AINC, 5, 10, WORD));
  emit(program, S(SW, 5, 11, 0));
}
/* A word that it has loaded many times, so that it is loaded ahead. */
static void add_up(struct program *program) {
  for (unsigned i = 0; i < 60; i++) {
    emit(program, I(LW, 5, 10, WORD));
    emit(program, R(ADD, 6, 6, 5));
  }
  emit(program, S(SW, 6, 11, 0));
}
/* And one of another line. */
static void add_up_two(struct program *program) {
  for (unsigned i = 0; i < 60; i++) {
    emit(program, I(LW, 5, i % 2 ? 10 : 11, i % 2 ? WORD : 12));
    emit(program, R(ADD, 6, 6, 5));
  }
  emit(program, S(SW, 6, 11, 0));
}
/* And writes a word of local memory of which it reads what was there. */
static void add_up_locally(struct program *program) {
  for (unsigned i = 0; i < 60; i++) {
    emit(program, I(LW, 7, 0, -4));
    emit(program, R(ADD, 7, 7, 10));
    emit(program, S(SW, 7, 0, -4));
    emit(program, I(LW, 5, 10, WORD));
    emit(program, R(ADD, 7, 7, 5));
  }
  emit(program, S(SW, 7, 11, 0));
}
/* Its path depends on a word that it has loaded far ahead, since each turn takes long. */
static void choose(struct program *program) {
  for (unsigned i = 0; i < 24; i++) {
    emit(program, I(LW, 5, 10, WORD));
    emit(program, I(ANDI, 5, 5, 1));
    emit(program, B(BNE, 5, 0, 8));
    emit(program, I(ADDI, 6, 6, 1));
    for (unsigned j = 0; j < 6; j++)
      emit(program, R(FDIV, 7, 7, 7));
  }
  emit(program, S(SW, 6, 11, 0));
}
static void store_again_and_again(struct program *program) {
  for (unsigned i = 0; i < 8; i++) {
    emit(program, S(SW, 4, 10, WORD));
    for (unsigned j = 0; j < 12; j++)
      emit(program, NOP);
  }
}
/* A word in every other cycle, which the stores before it combine with. */
static void count_up(struct program *program) {
  for (unsigned i = 0; i < 80; i++) {
    emit(program, I(ADDI, 4, 4, 1));
    emit(program, S(SW, 4, 10, WORD));
  }
}
static void add_up_past_cache(struct program *program) {
  emit(program, I(ADDI, 6, 0, 0));
  for (unsigned i = 0; i < 6; i++) {
    emit(program, I(LWNT, 5, 10, WORD));
    emit(program, R(ADD, 6, 6, 5));
  }
  emit(program, S(SW, 6, 11, 0));
}
static void print(struct program *program) {
  emit(program, I(ADDI, 5, 4, 'a'));
  emit(program, T(5, TRAX_TRAP_PUTC));
}
static void fault(struct program *program) {
  emit(program, I(LW, 5, 0, 0));
}
static void store_for_long(struct program *program) {
  for (unsigned i = 0; i < 20; i++)
    emit(program, S(SW, 4, 10, (int32_t)(WORD + 64 * i)));
}
static void end_thread(struct program *program) {
  emit(program, HALT);
}

struct scenario {
  const char *name;
  bool written;  /* the block has been written before, so that loads ahead from it are watched */
  action *of[4]; /* TM 0, 1, 2; a second TP of TM 0 */
};

static const struct scenario scenarios[] = {
    {"a load of what another TM stores", true, {store_word, load_word}},
    {"a load past the cache of what a higher TM stores past it", true, {load_past_cache, store_past_cache}},
    {"a byte of the word that another TM stores", true, {store_word, load_second_byte}},
    {"a load of a word of which another TM stores the second byte", true, {store_second_byte, load_word}},
    {"two stores of one word", true, {store_word, store_word}},
    {"the same store by two TMs", true, {store_one, store_one}},
    {"the same store by two TMs, and another one", true, {store_one, store_one, store_word}},
    {"two stores of one word, and a load", true, {store_word, store_word, load_word}},
    {"bytes of a word by two TMs", true, {store_first_byte, store_second_byte}},
    {"bytes of a word by two TMs, one of which loads it", true, {store_byte_and_load_word, store_second_byte}},
    {"bytes of a word by two TMs, and a third one loads it", true, {store_first_byte, store_second_byte, load_word}},
    {"bytes of a word by one TM, which loads it", true, {store_bytes_and_load_word}},
    {"a TM's own store", true, {store_and_load_word, load_second_byte}},
    {"a load beside a TM's own store, the last one of a burst", true, {store_and_load_beside}},
    {"a TM's own store of what nobody has stored", false, {store_and_load_word, NULL}},
    {"a load of what is incremented", true, {increment, load_word}},
    {"two increments, and a load", true, {increment, increment, load_past_cache}},
    {"a store of what is incremented", true, {store_word, increment}},
    {"a store of what an increment makes of the word", true, {store_one, increment}},
    {"an increment of what a higher TM stores", true, {increment, store_word}},
    {"an increment of what has been loaded ahead", false, {increment, add_up}},
    {"a store of what has been loaded ahead", false, {add_up, store_word}},
    {"a store of what has been loaded ahead by itself and another", false, {add_up, add_up, store_word}},
    {"a store of what has been loaded ahead between stores to local memory", false, {add_up_locally, store_word}},
    {"a store of what has been loaded ahead since a first write", true, {add_up, store_word}},
    {"a store of what has been loaded ahead between loads of another line", true, {add_up_two, store_word}},
    {"an increment of what has been loaded ahead since a first write", true, {increment, add_up}},
    {"a store of it by itself and another, between stores to local memory", true, {add_up_locally, add_up, store_word}},
    {"an increment and stores of what decides a path", true, {choose, increment, NULL, store_again_and_again}},
    {"stores by a higher TP of what has been loaded ahead", true, {add_up, NULL, NULL, count_up}},
    {"a store past the cache by a higher TP of what has been loaded ahead",
     true,
     {add_up, NULL, NULL, store_past_cache}},
    {"loads past the cache of what a higher TP stores in the same cycle",
     true,
     {add_up_past_cache, NULL, NULL, count_up}},
    {"loads past the cache of what a lower TP stores in the same cycle",
     true,
     {count_up, NULL, NULL, add_up_past_cache}},
    {"output", false, {print, print, print}},
    {"a fault, and stores that must not happen", false, {fault, store_for_long}},
    {"a fault of a higher TM, and stores", false, {store_for_long, fault}},
    {"an end, and stores after it", false, {end_thread, store_for_long, load_word}},
    {"bytes of a word by two TMs, the higher of which loads it", true, {store_second_byte, store_byte_and_load_word}},
};

/* Many cycles go by in a loop. */
static void emit_delay(struct program *program, unsigned delay) {
  if (delay > 128) {
    emit_loop(program, delay / 2, 0);
    delay %= 2;
  }
  for (unsigned i = 0; i < delay; i++)
    emit(program, NOP);
}

static void write_program(struct program *program, const struct scenario *scenario, const unsigned delay[3],
                          bool busy) {
  static const unsigned numbers[3] = {0x1234567, 0x55AA, 0x7F};
  program->count = 0;
  emit(program, trax_encode((trax_inst){TRAX_OP_RDSR, 1, 0, 0, TRAX_SR_TM}));
  emit(program, trax_encode((trax_inst){TRAX_OP_RDSR, 2, 0, 0, TRAX_SR_TP}));
  for (unsigned i = 0; i < 3; i++)
    emit(program, R(ADD, 1, 1, 2)); /* a second TP counts as TM 3 */
  emit(program, U(LUI, 10, DATA >> 16));
  emit(program, I(SLLI, 11, 1, 6));
  emit(program, R(ADD, 11, 11, 10));
  emit(program, I(ADDI, 11, 11, RESULTS));
  for (unsigned tm = 0; tm < (scenario->of[3] ? 4 : 3); tm++) {
    action *const act = scenario->of[tm];
    emit(program, I(ADDI, 2, 0, (int32_t)tm));
    const size_t branch = program->count;
    emit(program, NOP);
    if (scenario->written) {
      emit(program, S(SW, 0, 10, OTHER));
      emit(program, S(SW, 0, 10, WORD)); /* the data are random */
      emit(program, S(SW, 0, 11, 12));
    }
    emit(program, U(LUI, 4, (int32_t)(numbers[tm % 3] >> 16)));
    emit(program, I(ORI, 4, 4, (int32_t)(numbers[tm % 3] & 0x7FF)));
    if (act == add_up || act == add_up_locally || act == choose)
      emit_loop(program, QUIET, I(LW, 5, 10, WORD));
    else
      emit_loop(program, QUIET, NOP);
    for (unsigned i = 0; i < WRITES && busy; i++)
      emit(program, S(SW, 4, 11, (int32_t)(TRAFFIC + 256 * i)));
    emit_delay(program, delay[tm % 3 + (tm == 3 ? 2 : 0)]);
    if (act)
      act(program);
    emit_loop(program, AFTERWARDS, 0);
    emit(program, I(LWNT, 5, 10, WORD));
    emit(program, S(SW, 5, 11, 8));
    emit(program, HALT);
    program->words[branch] = B(BNE, 1, 2, ((int32_t)program->count - (int32_t)branch) * 4);
  }
  emit(program, HALT);
}

/* Every third delay is taken, another one for each scenario; all with TRAX_WHOLE. */
static bool is_left_out(unsigned number) {
  return number % 3 != 0 && !setting("TRAX_WHOLE", 0);
}

static const double PLENTY = 100000; /* GB/s: all have their instructions in the same cycle */

/* `bandwidth`: GB/s; if it is little, requests wait for the bus all the time, and epochs are long. */
static void check(const struct scenario *scenario, const unsigned delay[3], unsigned epoch, double bandwidth) {
  struct trax_config config = bench_far(3, scenario->of[3] ? 2 : 1);
  config.icache.line_bytes = config.icache.bytes = 4096;
  config.memory.latency_cycles = epoch;
  config.memory.bandwidth_gbps = bandwidth;
  if (bandwidth < PLENTY)
    config.memory.min_transfer_bytes = 4096; /* as an instruction line, so that those do not come far apart */
  config.memory.size_mib = 1;
  struct program program;
  write_program(&program, scenario, delay, bandwidth < PLENTY);
  struct run reference = run_alone(&config, program.words, program.count, "reference", 0, 1);
  struct run fast = run_alone(&config, program.words, program.count, "fast", 0, 2);
  struct difference difference;
  if (different_runs(&difference, &reference, &fast) || different_transfers(&difference, &reference, &fast))
    fail_msg("%s, after %u, %u and %u cycles more, latency %u, %g GB/s: %s", scenario->name, delay[0], delay[1],
             delay[2], epoch, bandwidth, difference.text);
  end(&reference);
  end(&fast);
}

static void in_any_order(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof scenarios / sizeof *scenarios; i++)
    for (unsigned first = 0; first < 10; first += 3)
      for (unsigned second = 0; second < 14; second++)
        if (!is_left_out((unsigned)i + first + second))
          check(&scenarios[i], (unsigned[]){first, second, 5 + second % 3}, LATENCY, PLENTY);
}

/* Far apart: the other's epoch may be over, and increments happen late. */
static void at_any_distance(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof scenarios / sizeof *scenarios; i++)
    for (unsigned distance = 0; distance < 110; distance += 11) {
      if (!is_left_out((unsigned)i + distance))
        check(&scenarios[i], (unsigned[]){distance, 3, distance / 2}, 16 + distance % 50, PLENTY);
      if (!is_left_out((unsigned)i + distance + 1))
        check(&scenarios[i], (unsigned[]){3, distance, distance / 2}, 16 + distance % 50, PLENTY);
    }
}

/* The controller has served what waits, increments among it, before the cycles in which others write and read. */
static void while_requests_wait(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof scenarios / sizeof *scenarios; i++)
    for (unsigned distance = 0; distance < 500; distance += 61) {
      if (!is_left_out((unsigned)i + distance))
        check(&scenarios[i], (unsigned[]){0, distance, distance / 2}, 16 + distance % 50, 128);
      if (!is_left_out((unsigned)i + distance + 1))
        check(&scenarios[i], (unsigned[]){distance, 0, distance / 2}, 16 + distance % 50, 128);
    }
}

/* The controller serves an increment ahead of an epoch while a TP of another TM is in the midst of a burst that has
   loaded the word. A build with assertions sees whether that TP rolls back in time: a later roll back would lead it to
   another instruction. */
static void while_an_increment_waits(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof scenarios / sizeof *scenarios; i++)
    for (unsigned delay = 300; scenarios[i].of[3] && delay < 600; delay += 30)
      check(&scenarios[i], (unsigned[]){0, 60, delay}, 50, 128);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(in_any_order), cmocka_unit_test(at_any_distance),
                                     cmocka_unit_test(while_requests_wait), cmocka_unit_test(while_an_increment_waits)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
