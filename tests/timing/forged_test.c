/* Checkpoints with right digests and wrong contents: every kind of field of the state is damaged in every way, alone
   and together with another one, and the header too. The file is refused, with its name and what is wrong with it, or
   its run ends in an orderly way, in time.

   TRAX_RANDOM_SEED makes it different; with the address sanitizer it also sees what is read beside an array. */
#define _POSIX_C_SOURCE 200809L /* alarm */
#include "compare.h"
#include "temporary.h"

#include "engine/layout.h"
#include "engine/run.h"
#include "host/checkpoint.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <xxhash.h>
#include <zlib.h>

enum {
  MOST_NAMES = 256,
  MOST_PIECES = 1 << 20,
  MOST_BYTES = 1 << 24,
  STOP = 400,
  GO_ON = 3000,
  SECONDS = 60 /* more than a run takes */
};

/* As emulator/host/checkpoint.c writes it. */
struct header {
  char magic[8];
  uint32_t version, pages;
  uint64_t cycle, state, compressed, run[2], layouts, calls, complete, body[2];
};

struct piece {
  unsigned name;
  size_t at, size;
};

/* Places in the state. */
static char names[MOST_NAMES][64]; /* structure.field */
static bool refused[MOST_NAMES];   /* damaged somewhere */
static unsigned name_count;
static uint8_t data[DATA_BYTES];
static struct piece *pieces;                          /* [piece_count] */
static size_t piece_count, layout_bytes, state_bytes; /* the layout is before the state */

static const char *path;
static uint8_t *content, *damaged;
static size_t content_bytes;
static struct header header;

/* --- the state --- */

static unsigned number_of(const char *name) {
  unsigned i = 0;
  while (i < name_count && strcmp(names[i], name) != 0)
    i++;
  if (i == name_count) {
    assert_true(name_count < MOST_NAMES);
    snprintf(names[name_count++], sizeof *names, "%s", name);
  }
  return i;
}

static void note_section(void *context, const struct trax_section *section) {
  (void)context;
  for (size_t i = 0; i < section->count; i++)
    for (size_t j = 0; j < section->field_count; j++) {
      char name[64];
      snprintf(name, sizeof name, "%s.%s", section->name, section->fields[j].name);
      assert_true(piece_count < MOST_PIECES);
      pieces[piece_count++] = (struct piece){number_of(name), state_bytes, section->fields[j].size};
      state_bytes += section->fields[j].size;
    }
}

static trax_status note_pieces(void *context, struct trax_run *run, trax_error *error) {
  (void)context;
  struct trax_layout layouts[TRAX_MOST_LAYOUTS];
  piece_count = 0;
  layout_bytes = trax_layout_of(run->engine, run->chip, layouts) * sizeof *layouts;
  state_bytes = layout_bytes;
  run->engine->visit(run->chip, note_section, NULL);
  return trax_fail(error, "that is all");
}

/* --- files --- */

static void write_file(struct header changed) {
  uLongf size = compressBound(content_bytes);
  uint8_t *body = malloc(size);
  assert_int_equal(compress2(body, &size, damaged, content_bytes, 1), Z_OK);
  if (changed.compressed == header.compressed)
    changed.compressed = size;
  changed.body[0] = changed.body[1] = 0;
  XXH3_state_t *state = XXH3_createState();
  XXH3_128bits_reset(state);
  XXH3_128bits_update(state, &changed, sizeof changed);
  XXH3_128bits_update(state, body, size);
  const XXH128_hash_t digest = XXH3_128bits_digest(state);
  XXH3_freeState(state);
  changed.body[0] = digest.low64;
  changed.body[1] = digest.high64;
  FILE *file = fopen(path, "wb");
  assert_int_equal(fwrite(&changed, sizeof changed, 1, file), 1);
  assert_int_equal(fwrite(body, 1, size, file), size);
  fclose(file);
  free(body);
}

static void read_file(void) {
  static uint8_t bytes[MOST_BYTES];
  FILE *file = fopen(path, "rb");
  assert_non_null(file);
  const size_t size = fread(bytes, 1, sizeof bytes, file);
  fclose(file);
  memcpy(&header, bytes, sizeof header);
  uLongf expected = layout_bytes + header.state + header.pages * (uint64_t)4100 + header.calls;
  content = realloc(content, expected);
  damaged = realloc(damaged, expected);
  assert_int_equal(uncompress(content, &expected, bytes + sizeof header, size - sizeof header), Z_OK);
  content_bytes = expected;
  memcpy(damaged, content, content_bytes);
}

/* --- runs --- */

static trax_error reason;
static char attempt[200]; /* what is damaged, and how */

static void end_late_run(int signal_number) {
  (void)signal_number;
  static const char text[] = ": its run does not end\n";
  if (write(STDERR_FILENO, attempt, strlen(attempt)) > 0 && write(STDERR_FILENO, text, sizeof text - 1) > 0)
    _exit(1);
  _exit(2);
}

/* Whether the file is refused. */
static bool resume(const struct trax_config *config, const uint32_t *program, size_t count, const char *what) {
  struct bench bench = bench_begin(config, program, count);
  struct trax_checkpoint *checkpoint = NULL;
  const struct trax_checkpoint_options options = {.resume = path};
  memcpy(bench.machine->space.bytes + DATA, data, sizeof data);
  if (count % 2) {
    bench.machine->space.input = DATA + DATA_BYTES / 4;
    bench.machine->space.input_bytes = DATA_BYTES / 2;
  }
  reason.message[0] = '\0';
  alarm(SECONDS);
  trax_status status = trax_checkpoint_begin(&checkpoint, bench.machine, &options, &reason);
  const trax_run_options run = {.max_cycles = STOP + GO_ON, .host_threads = 1};
  if (status == TRAX_OK)
    status = trax_machine_run(bench.machine, &run, &reason);
  alarm(0);
  if (status == TRAX_ERROR && strncmp(reason.message, path, strlen(path)) != 0)
    fail_msg("%s: \"%s\" does not name the file", what, reason.message);
  trax_checkpoint_end(checkpoint, NULL);
  bench_end(&bench);
  return status == TRAX_ERROR;
}

enum damage { ONES, ZEROS, FLIPPED, RANDOM, ONE_MORE, COPIED, DAMAGES };

/* The pieces of a name in this machine, which may have none. */
static const struct piece *some[MOST_PIECES];
static size_t some_count;

static void find_pieces(unsigned name) {
  some_count = 0;
  for (size_t i = 0; i < piece_count; i++)
    if (pieces[i].name == name)
      some[some_count++] = &pieces[i];
}

/* Damages one of the pieces that have been found. */
static void damage(size_t number, enum damage how) {
  enum { NEAR = 8 };
  const size_t size = some[number]->size;
  uint8_t *bytes = damaged + some[number]->at;
  if (how == COPIED) { /* the value of a neighbour, which then is there twice */
    const size_t other = number + any(0, 2 * NEAR);
    memcpy(bytes, content + some[other < NEAR ? 0 : (other - NEAR) % some_count]->at, size);
  }
  for (size_t i = 0; i < size; i++)
    bytes[i] = (uint8_t)(how == ONES ? 0xFF : how == ZEROS ? 0 : how == RANDOM ? any(0, 255) : bytes[i]);
  if (how == FLIPPED)
    bytes[any(0, (uint32_t)size - 1)] ^= (uint8_t)(1u << any(0, 7));
  if (how == ONE_MORE)
    bytes[0]++;
}

static size_t any_of_some(void) {
  return any(0, (uint32_t)some_count - 1);
}

static bool try_damage(const struct trax_config *config, const uint32_t *program, size_t count) {
  write_file(header);
  memcpy(damaged, content, content_bytes);
  if (setting("TRAX_TEST_VERBOSE", 0))
    fprintf(stderr, "%s\n", attempt);
  return resume(config, program, count, attempt);
}

static bool is_counter(unsigned name) {
  return strncmp(names[name], "trax_tm_stats.", 14) == 0 || strncmp(names[name], "trax_memory_stats.", 18) == 0;
}

/* Whether its values name elements of other arrays, or are matched with those of others. */
static bool is_matched(unsigned name) {
  static const char *const lists[] = {
      "trax_request.", "trax_mshr.",         "trax_icache_pending.",
      "trax_l2_mshr.", "trax_dram_request.", "queue->",
      "l2->",          "dcache->",           "tm->",
      "trax_waiting.", "trax_l2.arriving",
  };
  for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
    if (strncmp(names[name], lists[i], strlen(lists[i])) == 0)
      return true;
  return false;
}

static void damage_state(const struct trax_config *config, const uint32_t *program, size_t count) {
  const unsigned scale = setting("TRAX_WHOLE", 0) ? 10 : 1;
  for (unsigned name = 0; name < name_count; name++) {
    find_pieces(name);
    for (unsigned how = is_counter(name) ? RANDOM : ONES; how < (is_counter(name) ? RANDOM + 1 : DAMAGES); how++) {
      const unsigned singles = (how == COPIED && is_matched(name) ? 12 : 1) * scale;
      for (unsigned turn = 0; turn <= singles && some_count; turn++) { /* one of the name somewhere, and all of it */
        if (turn < singles)
          damage(any_of_some(), (enum damage)how);
        for (size_t i = 0; i < some_count && turn == singles; i++)
          damage(i, (enum damage)how);
        snprintf(attempt, sizeof attempt, "%.60s, damage %u, turn %u", names[name], how, turn);
        refused[name] |= try_damage(config, program, count);
      }
    }
  }
}

/* Two or three fields, mostly by their neighbours' values: they may agree with each other, and be wrong together. */
static void damage_together(const struct trax_config *config, const uint32_t *program, size_t count) {
  const unsigned tries = setting("TRAX_WHOLE", 0) ? 20000 : 100;
  for (unsigned i = 0; i < tries; i++) {
    int length = snprintf(attempt, sizeof attempt, "together:");
    for (unsigned fields = any(2, 3); fields;) {
      const unsigned name = any(0, name_count - 1), how = any(0, 1) ? COPIED : any(0, DAMAGES - 1);
      find_pieces(name);
      if (is_counter(name) || !some_count)
        continue;
      damage(any_of_some(), (enum damage)how);
      length += snprintf(attempt + length, sizeof attempt - (size_t)length, " %.50s by %u", names[name], how);
      fields--;
    }
    try_damage(config, program, count);
  }
}

static void damage_header(const struct trax_config *config, const uint32_t *program, size_t count, bool all_bits) {
  for (size_t at = sizeof header.magic; at < offsetof(struct header, body); at++)
    for (unsigned bit = all_bits ? 0 : any(0, 7), last = all_bits ? 7 : bit; bit <= last; bit++) {
      struct header changed = header;
      ((uint8_t *)&changed)[at] ^= (uint8_t)(1u << bit);
      write_file(changed);
      const bool is_cycle = at >= offsetof(struct header, cycle) && at < offsetof(struct header, state);
      if (!resume(config, program, count, "header"))
        fail_msg("byte %zu, bit %u of the header is taken", at, bit);
      if (is_cycle && !strstr(reason.message, "its state cannot be: "))
        fail_msg("another cycle: \"%s\"", reason.message);
      if (at < offsetof(struct header, pages) && !strstr(reason.message, "a checkpoint of version"))
        fail_msg("another version: \"%s\"", reason.message);
    }
  write_file(header);
  assert_false(resume(config, program, count, "what was not damaged"));
}

/* Another build's: the file says of which section the layout is another one. */
static void damage_layout(const struct trax_config *config, const uint32_t *program, size_t count) {
  enum { BYTES_OF_EACH = 4 };
  for (size_t i = 0; i < BYTES_OF_EACH * layout_bytes / sizeof(struct trax_layout); i++) {
    const struct trax_layout *layout = (const struct trax_layout *)content + i / BYTES_OF_EACH;
    const size_t at = i / BYTES_OF_EACH * sizeof *layout + any(0, sizeof *layout - 1);
    damaged[at] ^= (uint8_t)(1u << any(0, 7));
    write_file(header);
    memcpy(damaged, content, content_bytes);
    if (!resume(config, program, count, "layout") || !strstr(reason.message, "another build of trax-sim") ||
        !strstr(reason.message, layout->name))
      fail_msg("another layout of %s: \"%s\"", layout->name, reason.message);
  }
}

/* What a program may have made, what is only compared or counted, and round-robin masks: with any value, the run stays
   within its structures. */
static const char *const free_names[] = {
    "trax_tm.progressed",
    "trax_tm.queue_arbiter",
    "trax_tm.data_bank_rr_masks",
    "trax_tm.fetch_rr_masks16",
    "trax_fast_units.rr_masks",
    "tm->fetch_arbiters.",
    "trax_tp.reg",
    "trax_tp.address",
    "trax_tp.writes",
    "trax_tp.increments",
    "trax_tp.local",
    "trax_icache_pending.line",
    "tags->lines.",
    "tags->next.",
    "trax_shared_unit.arbiter",
    "trax_waiting.arbiter",
    "trax_mshr.line",
    "trax_mshr.passing",
    "trax_dcache.all_fills_end",
    "trax_queue.peak",
    "trax_queue.made",
    "trax_request.line",
    "trax_request.value",
    "trax_request.number",
    "tm->exit_statuses.",
    "trax_dram_request.row",
    "trax_dram_bank.row",
    "trax_dram_rank.activations",
};

static bool may_be_anything(const char *name) {
  for (size_t i = 0; i < sizeof free_names / sizeof *free_names; i++)
    if (strcmp(free_names[i], name) == 0)
      return true;
  return false;
}

static void machine(struct trax_config config, uint64_t seed, bool all_bits) {
  random_state = seed;
  uint32_t program[BODY + 64];
  const size_t count = any_program(program);
  const trax_run_options options = {.max_cycles = STOP, .host_threads = 1};
  struct trax_checkpoint *checkpoint;
  config.ray.units_per_group = 1;
  struct bench bench = bench_begin(&config, program, count);
  bench.machine->prepare = note_pieces;
  assert_int_equal(trax_machine_run(bench.machine, &options, &bench.error), TRAX_ERROR);
  bench_end(&bench);
  bench = bench_begin(&config, program, count);
  random_state = 99; /* as compare.c fills the data */
  for (uint32_t i = 0; i < DATA_BYTES; i++)
    data[i] = (uint8_t)any(0, 255);
  memcpy(bench.machine->space.bytes + DATA, data, sizeof data);
  random_state = seed + setting("TRAX_RANDOM_SEED", 1);
  const struct trax_checkpoint_options write = {.write = path};
  assert_int_equal(trax_checkpoint_begin(&checkpoint, bench.machine, &write, &bench.error), TRAX_OK);
  const trax_status status = trax_machine_run(bench.machine, &options, &bench.error);
  assert_int_equal(status, TRAX_STUCK); /* in the midst of it */
  assert_int_equal(trax_checkpoint_end(checkpoint, &bench.error), TRAX_OK);
  bench_end(&bench);
  read_file();
  assert_int_equal(layout_bytes + header.state, state_bytes);
  damage_header(&config, program, count, all_bits);
  damage_layout(&config, program, count);
  damage_state(&config, program, count);
  damage_together(&config, program, count);
}

static void every_field(void **state) {
  (void)state;
  struct trax_config ring = TRAX_CONFIG_DEFAULT;
  ring.chip.tms = 2;
  ring.chip.tps_per_tm = 6;
  ring.memory.size_mib = 1;
  ring.memory.bandwidth_gbps = 1;
  ring.memory.queue_depth = 8;
  ring.dcache.mshrs = 4;
  struct trax_config lists = ring;
  lists.memory.channels = 2;
  lists.memory.atomic_latency_cycles = 30;
  struct trax_config l2 = lists;
  l2.l2.bytes = 1024;
  l2.l2.ways = 2;
  l2.l2.banks = 2;
  l2.l2.mshrs = 4;
  struct trax_config dram = ring;
  dram.chip.tps_per_tm = 20;
  dram.memory.queue_depth = 32;
  dram.dcache.mshrs = 16;
  dram.memory.model = TRAX_MEMORY_DRAM;
  machine(ring, 3, true); /* headers are the same for all machines */
  machine(l2, 6, false);
  machine(dram, 7, false);
  if (setting("TRAX_WHOLE", 0)) {
    machine(lists, 4, true);
    machine(l2, 5, true);
  }
  for (unsigned i = 0; i < name_count; i++)
    if (!refused[i] && !is_counter(i) && !may_be_anything(names[i]))
      fail_msg("%s was never refused", names[i]);
}

int main(void) {
  path = test_path("forged");
  signal(SIGALRM, end_late_run);
  pieces = malloc(MOST_PIECES * sizeof *pieces);
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_field)};
  const int failures = cmocka_run_group_tests(tests, NULL, NULL);
  free(pieces);
  free(content);
  free(damaged);
  return failures;
}
