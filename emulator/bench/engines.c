/* engine-bench measures the speed of the engines.

   It prints a row for each case: million simulated instructions per second of wall time, for the reference engine, the
   fast engine on one, two and all threads of the host, and the functional engine; then the ratios of the fast engine on
   one thread to the reference and to the functional engine, and of two threads to one. Each repetition runs all
   engines, and the shortest time of an engine counts, since the host may be busy. With --max-cycles the timed engines
   run only the first N cycles. --no-reference omits the reference engine, which takes some forty times as long. The
   exit status is 1 if the engines disagree on cycles or instructions. */
#define _GNU_SOURCE /* clock_gettime, strchrnul */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "machine/machine.h"
#include "trax/isa.h"
#include "trax/options.h"

enum { TEXT = 0x1000, TABLE = 0x10000, TABLE_BYTES = 0x10000 };

static struct options {
  const char *chips;
  uint64_t max_cycles; /* 0: all */
  unsigned repeats;
  bool no_reference;
} options = {.chips = "1x32,4x32,2x64", .repeats = 3};

#define FIELD(member) TRAX_OPTION_FIELD(struct options, member)

static const trax_option rows[] = {
    {"chips", .argument = "LIST", FIELD(chips), .meaning = "as in 4x32,8x64 (default 1x32,4x32,2x64)"},
    {"max-cycles", .argument = "N", FIELD(max_cycles), .least = 1, .most = UINT64_MAX,
     .meaning = "the first N cycles (default all)"},
    {"repeats", .argument = "N", FIELD(repeats), .least = 1, .most = 1000,
     .meaning = "runs, of which the fastest counts (default 3)"},
    {"no-reference", FIELD(no_reference), .meaning = "without the reference engine"},
    TRAX_OPTION_HELP(0),
    TRAX_OPTION_VERSION,
    {0}};

static const trax_command command = {
    .name = "engine-bench",
    .synopsis = "[OPTION...]\n[OPTION...] PROGRAM [SYMBOL=FILE | SYMBOL:BYTES]...",
    .description = "Measures the speed of the engines on built-in programs, or on an executable with its buffers.",
    .rows = rows,
    .column = 22};

static uint32_t op(trax_op operation, unsigned rd, unsigned ra, unsigned rb, int32_t imm) {
  return trax_encode((trax_inst){operation, (uint8_t)rd, (uint8_t)ra, (uint8_t)rb, imm});
}

/* --- built-in programs: every thread executes a loop 2000 times, with its own data --- */

static size_t open_loop(uint32_t *words) {
  size_t n = 0;
  words[n++] = op(TRAX_OP_RDSR, 1, 0, 0, TRAX_SR_THREAD);
  words[n++] = op(TRAX_OP_LUI, 2, 0, 0, TABLE >> 16);
  words[n++] = op(TRAX_OP_FCVT_S_W, 3, 1, 0, 0);
  words[n++] = op(TRAX_OP_ADDI, 20, 0, 0, 2000);
  return n;
}

static size_t close_loop(uint32_t *words, size_t n, size_t loop) {
  words[n++] = op(TRAX_OP_ADDI, 20, 20, 0, -1);
  words[n] = op(TRAX_OP_BNE, 0, 20, 0, ((int32_t)loop - (int32_t)n) * 4);
  words[++n] = op(TRAX_OP_HALT, 0, 0, 0, 0);
  return n + 1;
}

static size_t integers(uint32_t *words) {
  const size_t loop = open_loop(words);
  size_t n = loop;
  for (unsigned i = 0; i < 16; i++) {
    words[n++] = op(TRAX_OP_XOR, 4 + i % 8, 1, 4 + (i + 3) % 8, 0);
    words[n++] = op(TRAX_OP_SRLI, 5 + i % 8, 4 + i % 8, 0, 3);
    words[n++] = op(TRAX_OP_ADD, 1, 1, 5 + i % 8, 0);
  }
  return close_loop(words, n, loop);
}

static size_t floats(uint32_t *words) {
  const size_t loop = open_loop(words);
  size_t n = loop;
  for (unsigned i = 0; i < 12; i++) {
    words[n++] = op(TRAX_OP_FMUL, 4 + i % 8, 3, 3, 0);
    words[n++] = op(TRAX_OP_FADD, 5 + i % 8, 4 + i % 8, 3, 0);
    words[n++] = op(TRAX_OP_XORI, 6, 6, 0, 9);
    words[n++] = op(TRAX_OP_ADD, 7, 6, 1, 0);
  }
  return close_loop(words, n, loop);
}

/* Walks through a table, with branches that depend on its words, as a traversal does. */
static size_t walk(uint32_t *words) {
  const size_t loop = open_loop(words);
  size_t n = loop;
  for (unsigned i = 0; i < 6; i++) {
    words[n++] = op(TRAX_OP_ANDI, 4, 1, 0, 0x3FFC);
    words[n++] = op(TRAX_OP_ADD, 4, 4, 2, 0);
    words[n++] = op(TRAX_OP_LW, 5, 4, 0, 0);
    words[n++] = op(TRAX_OP_SW, 0, 0, 1, -8);
    words[n++] = op(TRAX_OP_FMUL, 6, 3, 3, 0);
    words[n++] = op(TRAX_OP_ADD, 1, 1, 5, 0);
    words[n++] = op(TRAX_OP_ANDI, 7, 1, 0, 16);
    words[n++] = op(TRAX_OP_BEQ, 0, 7, 0, 12);
    words[n++] = op(TRAX_OP_FADD, 8, 6, 3, 0);
    words[n++] = op(TRAX_OP_LW, 9, 0, 0, -8);
    words[n++] = op(TRAX_OP_SUB, 10, 1, 9, 0);
  }
  return close_loop(words, n, loop);
}

struct bench_case {
  const char *name;
  size_t (*program)(uint32_t *words); /* NULL: the executable of the command line */
};

/* --- machines --- */

static void check(trax_status status, const trax_error *error) {
  if (status == TRAX_OK)
    return;
  fprintf(stderr, "engine-bench: error: %s\n", error->message);
  exit(EXIT_FAILURE);
}

static void load_words(trax_machine *machine, size_t (*program)(uint32_t *words)) {
  uint32_t words[128];
  const size_t count = program(words);
  trax_error error;
  uint8_t *host;
  check(trax_machine_map(machine, TEXT, (uint32_t)count * 4, TRAX_PERMIT_READ | TRAX_PERMIT_EXECUTE, &host, &error),
        &error);
  memcpy(host, words, count * 4);
  check(trax_machine_map(machine, TABLE, TABLE_BYTES, TRAX_PERMIT_READ, &host, &error), &error);
  for (uint32_t i = 0; i < TABLE_BYTES / 4; i++) {
    const uint32_t value = i * 2654435761u >> 8;
    memcpy(host + 4 * i, &value, 4);
  }
  check(trax_machine_set_entry(machine, TEXT, &error), &error);
}

static void load_program(trax_machine *machine, char **arguments) {
  trax_error error;
  check(trax_machine_load_elf(machine, *arguments, &error), &error);
  while (*++arguments) {
    char symbol[256];
    const size_t length = strcspn(*arguments, "=:");
    snprintf(symbol, sizeof symbol, "%.*s", (int)length, *arguments);
    const char *value = *arguments + length;
    if (*value == '=')
      check(trax_machine_bind_file(machine, symbol, value + 1, &error), &error);
    else
      check(trax_machine_bind(machine, symbol, NULL, *value ? (uint32_t)strtoul(value + 1, NULL, 0) : 0, &error),
            &error);
  }
}

struct engine {
  const char *name;
  const char *engine;
  unsigned host_threads; /* 0: all */
};

enum { REFERENCE, FAST, FAST_2, FAST_ALL, FUNCTIONAL, ENGINES };
static const struct engine engines[ENGINES] = {{"reference", "reference", 1},
                                               {"fast", "fast", 1},
                                               {"2 threads", "fast", 2},
                                               {"all", "fast", 0},
                                               {"functional", "functional", 1}};

struct result {
  uint64_t cycles, instructions;
  double seconds;
};

static double now(void) {
  struct timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static struct result run(const char *preset, const struct bench_case *bench, const struct engine *engine,
                         char **arguments) {
  trax_error error;
  trax_config *config = trax_config_create();
  check(config ? trax_config_preset(config, preset, &error) : trax_fail(&error, "out of memory"), &error);
  trax_machine *machine = trax_machine_create(config, &error);
  check(machine ? TRAX_OK : TRAX_ERROR, &error);
  if (bench->program)
    load_words(machine, bench->program);
  else
    load_program(machine, arguments);
  const bool timed = strcmp(engine->engine, "functional") != 0;
  const trax_run_options run_options = {
      .engine = engine->engine, .host_threads = engine->host_threads, .max_cycles = timed ? options.max_cycles : 0};
  const double begun = now();
  const trax_status status = trax_machine_run(machine, &run_options, &error);
  const double seconds = now() - begun;
  if (!(timed && options.max_cycles && status == TRAX_STUCK))
    check(status, &error);
  const struct result result = {machine->stats.cycles, machine->stats.instructions, seconds};
  trax_machine_destroy(machine);
  trax_config_destroy(config);
  return result;
}

static bool row(const char *preset, const struct bench_case *bench, char **arguments) {
  const unsigned first = options.no_reference ? FAST : REFERENCE;
  struct result best[ENGINES];
  for (unsigned repeat = 0; repeat < options.repeats; repeat++)
    for (unsigned engine = first; engine < ENGINES; engine++) {
      const struct result result = run(preset, bench, &engines[engine], arguments);
      if (!repeat || result.seconds < best[engine].seconds)
        best[engine] = result;
    }
  bool same = true;
  double speed[ENGINES];
  for (unsigned engine = first; engine < ENGINES; engine++) {
    speed[engine] = 1e-6 * (double)best[engine].instructions / best[engine].seconds;
    if (engine != FUNCTIONAL)
      same &= best[engine].cycles == best[FAST].cycles && best[engine].instructions == best[FAST].instructions;
  }
  printf("%-6s %-10s %12llu %12llu", preset, bench->name, (unsigned long long)best[FAST].cycles,
         (unsigned long long)best[FAST].instructions);
  if (options.no_reference)
    printf(" %10s", "-");
  for (unsigned engine = first; engine < ENGINES; engine++)
    printf(" %10.1f", speed[engine]);
  if (options.no_reference)
    printf(" %9s", "-");
  else
    printf(" %9.1f", speed[FAST] / speed[REFERENCE]);
  printf(" %10.2f %9.2f%s\n", speed[FAST] / speed[FUNCTIONAL], speed[FAST_2] / speed[FAST], same ? "" : "  DIFFERENT");
  fflush(stdout);
  return same;
}

int main(int count, char **arguments) {
  static const struct bench_case builtin[] = {{"integers", integers}, {"floats", floats}, {"walk", walk}};
  static const struct bench_case program = {"program", NULL};
  trax_error error;
  const trax_parsed parsed = trax_command_parse(&command, &options, &count, arguments, &error);
  if (parsed == TRAX_PARSED_DONE)
    return EXIT_SUCCESS;
  check(parsed == TRAX_PARSED_RUN ? TRAX_OK : TRAX_ERROR, &error);
  const bool has_program = count > 0;
  bool same = true;
  printf("%-6s %-10s %12s %12s", "chip", "case", "cycles", "instructions");
  for (unsigned engine = 0; engine < ENGINES; engine++)
    printf(" %10s", engines[engine].name);
  printf(" %9s %10s %9s\n", "fast/ref.", "fast/func.", "2/1");
  for (const char *chip = options.chips; *chip;) {
    const char *end = strchrnul(chip, ',');
    char preset[16];
    snprintf(preset, sizeof preset, "%.*s", (int)(end - chip), chip);
    for (size_t i = 0; i < (has_program ? 1 : sizeof builtin / sizeof *builtin); i++)
      same &= row(preset, has_program ? &program : &builtin[i], arguments);
    chip = *end ? end + 1 : end;
  }
  return same ? EXIT_SUCCESS : EXIT_FAILURE;
}
