/* engine-bench: how fast the engines are.

     engine-bench                                    built-in programs
     engine-bench PROGRAM [SYMBOL=FILE | SYMBOL:BYTES]...    an executable with its buffers

   A row for each case: million simulated instructions per second of processor time with each engine and without time,
   and how much faster the fast engine is than the reference. They take turns, and the least time of several runs
   counts, since the host may be busy. Ends with status 1 if the engines disagree on cycles or instructions. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "core/machine.h"
#include "trax/isa.h"

enum { ENGINES = 3, REPEATS = 3, TEXT = 0x1000, TABLE = 0x10000, TABLE_BYTES = 0x10000 };

static const char *const configs[] = {"1x32", "4x32", "2x64"};

static uint32_t op(trax_op operation, unsigned rd, unsigned ra, unsigned rb, int32_t imm) {
  return trax_encode((trax_inst){operation, (uint8_t)rd, (uint8_t)ra, (uint8_t)rb, imm});
}

/* --- built-in programs: every thread 2000 turns of a loop, with its own data --- */

static size_t begin(uint32_t *words) {
  size_t n = 0;
  words[n++] = op(TRAX_OP_RDSR, 1, 0, 0, TRAX_SR_THREAD);
  words[n++] = op(TRAX_OP_LUI, 2, 0, 0, TABLE >> 16);
  words[n++] = op(TRAX_OP_FCVT_S_W, 3, 1, 0, 0);
  words[n++] = op(TRAX_OP_ADDI, 20, 0, 0, 2000);
  return n;
}

static size_t end(uint32_t *words, size_t n, size_t loop) {
  words[n++] = op(TRAX_OP_ADDI, 20, 20, 0, -1);
  words[n] = op(TRAX_OP_BNE, 0, 20, 0, ((int32_t)loop - (int32_t)n) * 4);
  words[++n] = op(TRAX_OP_HALT, 0, 0, 0, 0);
  return n + 1;
}

static size_t integers(uint32_t *words) {
  const size_t loop = begin(words);
  size_t n = loop;
  for (unsigned i = 0; i < 16; i++) {
    words[n++] = op(TRAX_OP_XOR, 4 + i % 8, 1, 4 + (i + 3) % 8, 0);
    words[n++] = op(TRAX_OP_SRLI, 5 + i % 8, 4 + i % 8, 0, 3);
    words[n++] = op(TRAX_OP_ADD, 1, 1, 5 + i % 8, 0);
  }
  return end(words, n, loop);
}

static size_t floats(uint32_t *words) {
  const size_t loop = begin(words);
  size_t n = loop;
  for (unsigned i = 0; i < 12; i++) {
    words[n++] = op(TRAX_OP_FMUL, 4 + i % 8, 3, 3, 0);
    words[n++] = op(TRAX_OP_FADD, 5 + i % 8, 4 + i % 8, 3, 0);
    words[n++] = op(TRAX_OP_XORI, 6, 6, 0, 9);
    words[n++] = op(TRAX_OP_ADD, 7, 6, 1, 0);
  }
  return end(words, n, loop);
}

/* Walks through a table with branches that depend on it, like a traversal. */
static size_t walk(uint32_t *words) {
  const size_t loop = begin(words);
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
  return end(words, n, loop);
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

struct result {
  uint64_t cycles, instructions;
  double seconds;
};

static struct result run(const char *preset, const struct bench_case *bench, trax_engine engine, char **arguments) {
  trax_error error;
  trax_config *config = trax_config_create();
  check(config ? trax_config_preset(config, preset, &error) : trax_fail(&error, "out of memory"), &error);
  trax_machine *machine = trax_machine_create(config, &error);
  check(machine ? TRAX_OK : TRAX_ERROR, &error);
  if (bench->program)
    load_words(machine, bench->program);
  else
    load_program(machine, arguments);
  const trax_run_options options = {.engine = engine};
  const clock_t begun = clock();
  check(trax_machine_run(machine, &options, &error), &error);
  const struct result result = {machine->stats.cycles, machine->stats.instructions,
                                (double)(clock() - begun) / CLOCKS_PER_SEC};
  trax_machine_destroy(machine);
  trax_config_destroy(config);
  return result;
}

static bool row(const char *preset, const struct bench_case *bench, char **arguments) {
  struct result best[ENGINES];
  for (unsigned repeat = 0; repeat < REPEATS; repeat++)
    for (unsigned engine = 0; engine < ENGINES; engine++) {
      const struct result result = run(preset, bench, (trax_engine)engine, arguments);
      if (!repeat || result.seconds < best[engine].seconds)
        best[engine] = result;
    }
  const struct result *reference = &best[TRAX_ENGINE_REFERENCE], *fast = &best[TRAX_ENGINE_FAST];
  const bool same = reference->cycles == fast->cycles && reference->instructions == fast->instructions;
  printf("%-6s %-10s %14llu", preset, bench->name, (unsigned long long)fast->instructions);
  for (unsigned engine = 0; engine < ENGINES; engine++)
    printf(" %10.1f", 1e-6 * (double)best[engine].instructions / best[engine].seconds);
  printf(" %10.2f%s\n", reference->seconds / fast->seconds, same ? "" : "  DIFFERENT");
  fflush(stdout);
  return same;
}

int main(int count, char **arguments) {
  static const struct bench_case builtin[] = {{"integers", integers}, {"floats", floats}, {"walk", walk}};
  static const struct bench_case program = {"program", NULL};
  const struct bench_case *cases = count > 1 ? &program : builtin;
  const size_t case_count = count > 1 ? 1 : sizeof builtin / sizeof *builtin;
  bool same = true;
  printf("%-6s %-10s %14s %10s %10s %10s %10s\n", "chip", "case", "instructions", "fast", "reference", "functional",
         "fast/ref.");
  for (size_t i = 0; i < sizeof configs / sizeof *configs; i++)
    for (size_t j = 0; j < case_count; j++)
      same &= row(configs[i], &cases[j], arguments + 1);
  return same ? EXIT_SUCCESS : EXIT_FAILURE;
}
