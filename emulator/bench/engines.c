/* engine-bench measures the speed of the engines.

   It prints a row for each chip: million simulated instructions per second of wall time, for the reference engine, the
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
#include "trax/options.h"

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

static const trax_command command = {.name = "engine-bench",
                                     .synopsis = "[OPTION...] PROGRAM [SYMBOL=FILE | SYMBOL:BYTES]...",
                                     .description =
                                         "Measures the speed of the engines on an executable with its buffers.",
                                     .rows = rows,
                                     .column = 22};

static void check(trax_status status, const trax_error *error) {
  if (status == TRAX_OK)
    return;
  fprintf(stderr, "engine-bench: error: %s\n", error->message);
  exit(EXIT_FAILURE);
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

static struct result run(const char *preset, const struct engine *engine, char **arguments) {
  trax_error error;
  trax_config *config = trax_config_create();
  check(config ? trax_config_preset(config, preset, &error) : trax_fail(&error, "out of memory"), &error);
  trax_machine *machine = trax_machine_create(config, &error);
  check(machine ? TRAX_OK : TRAX_ERROR, &error);
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

static bool row(const char *preset, char **arguments) {
  const unsigned first = options.no_reference ? FAST : REFERENCE;
  struct result best[ENGINES];
  for (unsigned repeat = 0; repeat < options.repeats; repeat++)
    for (unsigned engine = first; engine < ENGINES; engine++) {
      const struct result result = run(preset, &engines[engine], arguments);
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
  printf("%-6s program    %12llu %12llu", preset, (unsigned long long)best[FAST].cycles,
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
  trax_error error;
  const trax_parsed parsed = trax_command_parse(&command, &options, &count, arguments, &error);
  if (parsed == TRAX_PARSED_DONE)
    return EXIT_SUCCESS;
  check(parsed == TRAX_PARSED_RUN ? TRAX_OK : TRAX_ERROR, &error);
  check(count > 0 ? TRAX_OK : trax_fail(&error, "no program is given"), &error);
  bool same = true;
  printf("%-6s %-10s %12s %12s", "chip", "case", "cycles", "instructions");
  for (unsigned engine = 0; engine < ENGINES; engine++)
    printf(" %10s", engines[engine].name);
  printf(" %9s %10s %9s\n", "fast/ref.", "fast/func.", "2/1");
  for (const char *chip = options.chips; *chip;) {
    const char *end = strchrnul(chip, ',');
    char preset[16];
    snprintf(preset, sizeof preset, "%.*s", (int)(end - chip), chip);
    same &= row(preset, arguments);
    chip = *end ? end + 1 : end;
  }
  return same ? EXIT_SUCCESS : EXIT_FAILURE;
}
