/* The fast engine goes back: every byte that it has allocated for the state of a run is then as it was, be it in a list
   of sections or forgotten there (emulator/fast/state.c). */
#include "compare.h"

#include "fast/fast.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_BLOCKS = 4096, MOST_MOMENTS = 512, LENGTH = 30000 };

struct block {
  uint8_t *bytes;
  size_t size;
};

static struct block blocks[MOST_BLOCKS]; /* [block_count] */
static size_t block_count, state_bytes;
static bool recording;

/* The state before a cycle. */
static struct moment {
  uint64_t t;
  uint8_t *bytes; /* [state_bytes] */
} moments[MOST_MOMENTS];

static unsigned returns, compared;

/* --- what is allocated (the linker's --wrap) --- */

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);

static void *note(void *bytes, size_t size) {
  if (recording && bytes) {
    assert_true(block_count < MOST_BLOCKS);
    blocks[block_count++] = (struct block){bytes, size};
  }
  return bytes;
}

void *__wrap_malloc(size_t size) {
  return note(__real_malloc(size), size);
}

void *__wrap_calloc(size_t count, size_t size) {
  return note(__real_calloc(count, size), count * size);
}

void *__wrap_aligned_alloc(size_t alignment, size_t size) {
  return note(__real_aligned_alloc(alignment, size), size);
}

/* --- what of it is the state --- */

static void leave_out(const void *bytes) {
  for (size_t i = 0; i < block_count; i++)
    if (blocks[i].bytes == bytes) {
      blocks[i] = blocks[--block_count];
      return;
    }
}

/* What holds whatever cycle it is: the program as it was noted so far; what has ever been loaded and written; the
   structures of those who go back. */
static void find_state(const struct trax_chip *chip, struct trax_machine *machine, size_t before_epochs) {
  const struct trax_fast_program *program = &chip->fast->program;
  block_count = before_epochs;
  const void *const others[] = {chip,          chip->fast,    chip->fast->blocks.state, program->sections,
                                program->inst, program->asks, program->note,            program->line,
                                program->lines_ahead};
  for (size_t i = 0; i < sizeof others / sizeof *others; i++)
    leave_out(others[i]);
  blocks[block_count++] = (struct block){(uint8_t *)&machine->stats.memory, sizeof machine->stats.memory};
  blocks[block_count++] = (struct block){(uint8_t *)machine->tm_stats, chip->tms * sizeof *machine->tm_stats};
  state_bytes = sizeof chip->memory;
  for (size_t i = 0; i < block_count; i++)
    state_bytes += blocks[i].size;
}

static void keep(const struct trax_chip *chip, struct moment *moment, uint64_t t) {
  uint8_t *to = moment->bytes = moment->bytes ? moment->bytes : __real_malloc(state_bytes);
  moment->t = t;
  memcpy(to, &chip->memory, sizeof chip->memory);
  to += sizeof chip->memory;
  for (size_t i = 0; i < block_count; to += blocks[i++].size)
    memcpy(to, blocks[i].bytes, blocks[i].size);
}

static void compare(const struct trax_chip *chip, const struct moment *moment) {
  const uint8_t *from = moment->bytes;
  struct trax_memory memory = chip->memory;
  memory.context = ((const struct trax_memory *)(const void *)from)->context; /* that of before_increment, which is NULL */
  if (memcmp(from, &memory, sizeof memory) != 0)
    fail_msg("cycle %llu: the memory controller differs", (unsigned long long)moment->t);
  from += sizeof chip->memory;
  for (size_t i = 0; i < block_count; from += blocks[i++].size)
    for (size_t j = 0; j < blocks[i].size; j++)
      if (from[j] != blocks[i].bytes[j])
        fail_msg("cycle %llu: byte %zu of %zu bytes that were allocated as number %zu is %u and was %u",
                 (unsigned long long)moment->t, j, blocks[i].size, i, blocks[i].bytes[j], from[j]);
  compared++;
}

/* --- runs --- */

static void go_back(const struct trax_config *config, const uint32_t *program, size_t count) {
  struct bench bench = bench_begin(config, program, count);
  const trax_run_options options = {.host_threads = 1};
  const struct trax_engine *engine = &trax_fast_engine;
  struct trax_run run;
  bench.machine->observer = NULL; /* else TMs do not run ahead */
  block_count = 0;
  recording = true;
  assert_int_equal(trax_run_create(&run, bench.machine, engine, &options, &bench.error), TRAX_OK);
  recording = false;
  const struct trax_chip *chip = run.chip;
  size_t before_epochs = 0;
  while (before_epochs < block_count && blocks[before_epochs].bytes != (uint8_t *)chip->epochs)
    before_epochs++;
  assert_true(before_epochs < block_count);
  find_state(chip, bench.machine, before_epochs);
  uint64_t t = 0;
  unsigned next = 0;
  enum trax_advance advance = TRAX_GOES_ON;
  memset(moments, 0, sizeof moments);
  while (advance == TRAX_GOES_ON && t < LENGTH) {
    keep(chip, &moments[next++ % MOST_MOMENTS], t);
    const uint64_t before = t;
    advance = engine->advance(run.chip, &t, t - t % 512 + 512); /* so that pauses are of few cycles */
    if (t > before)
      continue;
    returns++;
    for (unsigned i = 0; i < MOST_MOMENTS; i++)
      if (moments[i].bytes && moments[i].t == t)
        compare(chip, &moments[i]);
  }
  for (unsigned i = 0; i < MOST_MOMENTS; i++)
    free(moments[i].bytes);
  trax_run_destroy(&run);
  bench_end(&bench);
}

static void to_what_it_was(void **state) {
  (void)state;
  for (unsigned seed = 1; seed <= setting("TRAX_RANDOM_ROUNDS", 60); seed++) {
    uint32_t program[BODY + 64];
    random_state = seed;
    struct trax_config config = any_config(3, any(1, 6));
    config.memory.latency_cycles = config.l2.latency_cycles = 20; /* so that there are epochs */
    go_back(&config, program, any_racing_program(program));
  }
  printf("went back %u times, %u of them to states that were kept\n", returns, compared);
  assert_true(compared >= 20);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(to_what_it_was)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
