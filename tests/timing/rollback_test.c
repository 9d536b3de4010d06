/* The fast engine goes back: every byte that it has allocated for the state of a run is then as it was, be it in a list
   of sections or forgotten there (emulator/fast/state.c).

   TRAX_ADDED_FIELDS=NAMES, of structures that have got a field `added`: the test writes to them and sees that they are
   restored, too, also from a checkpoint (tests/structure/state_test.py). With --layout it only prints the layout. */
#include "compare.h"
#include "temporary.h"

#include "engine/layout.h"
#include "fast/chip.h"
#include "host/checkpoint.h"

#include <inttypes.h>
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
  const struct trax_fast_program *program = &chip->program;
  block_count = before_epochs;
  const void *const others[] = {chip,          chip->blocks.state, program->sections, program->inst,
                                program->step, program->timing,    program->line,     program->chunk_lines};
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
  memory.context = ((const struct trax_memory *)(const void *)from)->context; /* that of `increment`, which is NULL */
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

/* --- added fields --- */

enum { MOST_ADDED = 32 };

static char added[MOST_ADDED][64]; /* [added_count]: of which structures */
static size_t touched[MOST_ADDED]; /* how many fields in all */
static size_t added_count;

static void read_names(void) {
  const char *names = getenv("TRAX_ADDED_FIELDS");
  for (int used = 0; names && sscanf(names, "%63s%n", added[added_count], &used) == 1; names += used)
    assert_true(++added_count < MOST_ADDED);
}

/* Calls visit for the bytes of each added field. */
struct added_visitor {
  void (*visit)(uint8_t *bytes, size_t size);
};

static void visit_added(void *context, const struct trax_section *section) {
  const struct added_visitor *visitor = context;
  for (size_t i = 0; i < added_count; i++)
    for (size_t j = 0; j < section->field_count && strcmp(added[i], section->name) == 0; j++)
      for (size_t k = 0; k < section->count && strcmp(section->fields[j].name, "added") == 0; k++, touched[i]++)
        visitor->visit((uint8_t *)section->bytes + k * section->size + section->fields[j].offset,
                       section->fields[j].size);
}

static uint64_t pattern;

static void next_pattern(uint8_t *bytes, size_t size) {
  for (size_t i = 0; i < size; i++)
    bytes[i] = (uint8_t)((pattern += 0x9E3779B97F4A7C15u) >> 56);
}

static void expect_pattern(uint8_t *bytes, size_t size) {
  uint8_t expected[64];
  assert_true(size <= sizeof expected);
  next_pattern(expected, size);
  assert_memory_equal(bytes, expected, size);
}

static void touch(void *chip) {
  trax_state_visit(chip, visit_added, &(struct added_visitor){next_pattern});
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
    touch(run.chip);
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

/* --- checkpoints --- */

enum { SAVED_AT = 400 };

static trax_status touch_added(struct trax_watch *watch, struct trax_run *run, uint64_t t) {
  (void)t;
  watch->next = TRAX_NEVER;
  pattern = 1;
  touch(run->chip);
  return TRAX_INTERRUPTED; /* which writes the checkpoint */
}

static trax_status expect_added(struct trax_watch *watch, struct trax_run *run, uint64_t t) {
  assert_int_equal(t, SAVED_AT);
  watch->next = TRAX_NEVER;
  pattern = 1;
  trax_state_visit(run->chip, visit_added, &(struct added_visitor){expect_pattern});
  return TRAX_INTERRUPTED;
}

static void run_with_checkpoint(const struct trax_config *config, const uint32_t *program, size_t count,
                                const struct trax_checkpoint_options *options, struct trax_watch watch) {
  struct bench bench = bench_begin(config, program, count);
  struct trax_checkpoint *checkpoint;
  const trax_run_options run = {.host_threads = 1};
  if (trax_checkpoint_begin(&checkpoint, bench.machine, options, &bench.error) != TRAX_OK)
    fail_msg("%s", bench.error.message);
  trax_machine_watch(bench.machine, &watch);
  assert_int_equal(trax_machine_run(bench.machine, &run, &bench.error), TRAX_INTERRUPTED);
  trax_machine_unwatch(bench.machine, &watch);
  assert_int_equal(trax_checkpoint_end(checkpoint, &bench.error), TRAX_OK);
  bench_end(&bench);
}

static void from_a_checkpoint(void **state) {
  (void)state;
  uint32_t program[BODY + 64];
  random_state = 5;
  const size_t count = any_program(program);
  struct trax_config config = bench_far(2, 4);
  config.ray.units_per_group = 1;
  config.memory.channels = 2; /* so that every structure is there, with or without the second-level cache */
  const char *path = test_path("added");
  for (unsigned with_l2 = 0; with_l2 < 2; with_l2++) {
    config.l2.bytes = with_l2 ? 1024 : 0;
    run_with_checkpoint(&config, program, count, &(struct trax_checkpoint_options){.write = path},
                        (struct trax_watch){.next = SAVED_AT, .inspect = touch_added});
    run_with_checkpoint(&config, program, count, &(struct trax_checkpoint_options){.resume = path},
                        (struct trax_watch){.next = 0, .inspect = expect_added});
  }
  for (size_t i = 0; i < added_count; i++)
    if (!touched[i])
      fail_msg("%s has no field that was added", added[i]);
}

static void print_layout(void) {
  const trax_run_options options = {.host_threads = 1};
  const struct trax_config config = bench_far(1, 1);
  struct bench bench = bench_begin(&config, &(uint32_t){HALT}, 1);
  struct trax_layout layouts[TRAX_MOST_LAYOUTS];
  struct trax_run run;
  assert_int_equal(trax_run_create(&run, bench.machine, &trax_fast_engine, &options, &bench.error), TRAX_OK);
  const size_t count = trax_layout_of(run.engine, run.chip, layouts);
  for (size_t i = 0; i < count; i++)
    printf("%s %016" PRIx64 "\n", layouts[i].name, layouts[i].hash);
  trax_run_destroy(&run);
  bench_end(&bench);
}

int main(int argc, char **argv) {
  if (argc == 2 && strcmp(argv[1], "--layout") == 0) {
    print_layout();
    return 0;
  }
  read_names();
  const struct CMUnitTest tests[] = {cmocka_unit_test(to_what_it_was), cmocka_unit_test(from_a_checkpoint)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
