/* Each rule of docs/timing.md by a small program, on both engines, to every cycle: docs/timing-rules.md is what this
   prints.

     timing-rules-test              the table; ends with status 1 if a number is not the one derived by hand
     timing-rules-test FILE         the same, and FILE must be it */
#include "rules.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static unsigned failures;

__attribute__((format(printf, 2, 3))) static void complain(const struct rule *rule, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  fprintf(stderr, "%s: %s: ", rule->chapter, rule->rule);
  vfprintf(stderr, format, arguments);
  fputc('\n', stderr);
  va_end(arguments);
  failures++;
}

/* The next word of a list, without what encloses it. */
static const char *next_word(const char **list, char *word, size_t size) {
  *list += strspn(*list, " ");
  const size_t length = strcspn(*list, " ");
  assert_true(length < size);
  memcpy(word, *list, length);
  word[length] = 0;
  *list += length;
  return length ? word : NULL;
}

static struct trax_config config_of(const struct rule *rule) {
  struct trax_config config = rule->base == NEAR ? bench_near(1, 1) : bench_far(1, 1);
  char word[64];
  for (const char *rest = rule->set; next_word(&rest, word, sizeof word);) {
    trax_error error;
    char *value = strchr(word, '=');
    assert_non_null(value);
    *value++ = 0;
    if (trax_config_set(&config, word, value, &error))
      fail_msg("%s", error.message);
  }
  return config;
}

static uint64_t charged(const struct bench *bench, const char *name) {
  static const char *const names[] = {
#define NAME(ID, JSON, ...) JSON,
      TRAX_CAUSES(NAME)
#undef NAME
  };
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    if (strcmp(names[cause], name) == 0)
      return bench_total(bench, (trax_cause)cause);
  fail_msg("no cause is called %s", name);
  return 0;
}

static void check_charges(const struct rule *rule, const struct bench *bench, const char *engine) {
  uint64_t expected = 0, sum = 0;
  char word[64];
  for (const char *rest = rule->charges; next_word(&rest, word, sizeof word);) {
    char *value = strchr(word, '=');
    assert_non_null(value);
    *value++ = 0;
    const uint64_t count = strtoull(value, NULL, 10);
    if (charged(bench, word) != count)
      complain(rule, "%" PRIu64 " thread-cycles of %s, %s, by hand %" PRIu64, charged(bench, word), word, engine,
               count);
    if (strcmp(word, "halted") != 0)
      expected += count;
  }
  for (unsigned cause = TRAX_CAUSE_ISSUED + 1; cause < TRAX_CAUSE_HALTED; cause++)
    sum += bench_total(bench, (trax_cause)cause);
  if (sum != expected)
    complain(rule, "%" PRIu64 " thread-cycles of waiting, %s, by hand %" PRIu64, sum, engine, expected);
}

/* The counter of this name of the TMs, the memory or a channel, or the word at DATA + n for word<n>. */
static uint64_t counted(const struct bench *bench, const char *name) {
  const struct trax_tm_stats *total = &bench->machine->stats.total;
#define COUNTER(ID, ...)                                                                                               \
  if (strcmp(name, #ID) == 0)                                                                                          \
    return total->ID;
  TRAX_TM_COUNTERS(COUNTER)
#undef COUNTER
  const struct trax_memory_stats *memory = &bench->machine->stats.memory;
#define COUNTER(ID, ...)                                                                                               \
  if (strcmp(name, #ID) == 0)                                                                                          \
    return memory->ID;
  TRAX_MEMORY_COUNTERS(COUNTER)
#undef COUNTER
  if (strcmp(name, "memory_bytes") == 0)
    return memory->bytes;
  if (strncmp(name, "channel", 7) == 0) {
    const unsigned channel = (unsigned)(name[7] - '0');
    return strcmp(name + 8, "_bytes") == 0 ? memory->channel[channel].bytes : memory->channel[channel].transfers;
  }
  if (strncmp(name, "word", 4) != 0)
    fail_msg("no counter is called %s", name);
  return bench_word(bench, DATA + (uint32_t)strtoul(name + 4, NULL, 10));
}

static void check_counts(const struct rule *rule, const struct bench *bench, const char *engine) {
  char word[64];
  for (const char *rest = rule->counts; rest && next_word(&rest, word, sizeof word);) {
    char *value = strchr(word, '=');
    assert_non_null(value);
    *value++ = 0;
    const uint64_t count = strtoull(value, NULL, 0);
    if (counted(bench, word) != count)
      complain(rule, "%s is %" PRIu64 ", %s, by hand %" PRIu64, word, counted(bench, word), engine, count);
  }
}

/* The issues in the form of rule.issues. */
static void print_issues(const struct bench *bench, char *text, size_t size) {
  const struct trax_config *config = &bench->machine->config;
  size_t length = 0;
  text[0] = 0;
  for (uint32_t thread = 0; thread < bench->machine->stats.threads; thread++) {
    if (thread)
      length += (size_t)snprintf(text + length, size - length, " /");
    for (size_t i = 0; i < bench->issues.count; i++) {
      const struct trax_issue *issue = &bench->issues.issue[i];
      if (issue->tm * config->chip.tps_per_tm + issue->tp == thread)
        length += (size_t)snprintf(text + length, size - length, " %" PRIu64, issue->cycle);
    }
    assert_true(length < size);
  }
}

/* Returns the length of the run. */
static uint64_t check(const struct rule *rule, const char *engine) {
  const char *const name = engine;
  const struct trax_config config = config_of(rule);
  struct bench bench = bench_begin(&config, rule->words, rule->count);
  bench_run_observed(&bench, &(trax_run_options){.engine = engine, .max_cycles = 100000});
  const trax_fault_kind fault = trax_machine_fault(bench.machine)->kind;
  const uint64_t cycles = bench_cycles(&bench);
  if (bench.status != (rule->fault ? TRAX_FAULT : TRAX_OK) || fault != rule->fault)
    complain(rule, "%s, by hand %s: %s", name, trax_fault_text(rule->fault), bench.error.message);
  if (cycles != rule->cycles)
    complain(rule, "%" PRIu64 " cycles, %s, by hand %" PRIu64, cycles, name, rule->cycles);
  char issues[4096];
  print_issues(&bench, issues, sizeof issues);
  if (rule->issues && strcmp(issues + (issues[0] == ' '), rule->issues) != 0)
    complain(rule, "issues %s, %s, by hand %s", issues, name, rule->issues);
  check_charges(rule, &bench, name);
  check_counts(rule, &bench, name);
  bench_end(&bench);
  return cycles;
}

static void print_program(const struct rule *rule, FILE *out) {
  for (size_t i = 0, same; i < rule->count; i += same) {
    char text[64];
    trax_disassemble(rule->words[i], TEXT + 4 * (uint32_t)i, text, sizeof text);
    for (same = 1; i + same < rule->count && rule->words[i + same] == rule->words[i];)
      same++;
    for (char *c = text; *c; c++)
      if (*c == '\t')
        *c = ' ';
    fprintf(out, "%s%s", i ? "; " : "", rule->words[i] == NOP ? "nop" : text);
    if (same > 1)
      fprintf(out, " (%zu)", same);
  }
}

static void print_row(const struct rule *rule, FILE *out) {
  const uint64_t fast = check(rule, "fast"), reference = check(rule, "reference");
  if (rule->is_unlisted)
    return;
  fprintf(out, "| %s | %s%s%s | `", rule->rule, rule->base == NEAR ? "near" : "far", rule->set[0] ? " " : "",
          rule->set);
  print_program(rule, out);
  fprintf(out, "` | %s | %" PRIu64 " | %" PRIu64 " | %" PRIu64 " |\n", rule->issues ? rule->issues : "", rule->cycles,
          fast, reference);
}

static void print_table(FILE *out) {
  size_t count;
  const struct rule *rules = timing_rules(&count);
  const char *chapter = "";
  fprintf(out,
          "# The rules of time, one by one\n\n"
          "What `build/tests/bin/timing-rules-test` prints; a test compares. Each row is a rule of "
          "[timing.md](timing.md), a "
          "machine\n"
          "and a program that shows it, the cycles in which each thread's instructions are issued and the length of "
          "the run, both\n"
          "derived by hand (`tests/timing/rules.c`), and the length that each engine gives. The test also checks the "
          "issues and\n"
          "what every thread-cycle is charged to.\n\n"
          "*near*: one TP, memory next to the chip (what is asked for in t is there in t + 1), one line for all "
          "instructions.\n"
          "*far*: one TP, the default memory (a line is there after 104 cycles, a word after 101), instruction banks "
          "with ports for\n"
          "all. The program begins at 0x%x.\n",
          TEXT);
  size_t listed = 0;
  for (size_t i = 0; i < count; i++) {
    listed += !rules[i].is_unlisted;
    if (!rules[i].is_unlisted && strcmp(chapter, rules[i].chapter) != 0) {
      chapter = rules[i].chapter;
      fprintf(out,
              "\n## %s\n\n| rule | machine | program | issued in | by hand | fast | reference |\n"
              "| --- | --- | --- | --- | --- | --- | --- |\n",
              chapter);
    }
    print_row(&rules[i], out);
  }
  fprintf(out, "\n%zu rules.\n", listed);
}

/* Whether the file holds the text. */
static bool is_same(const char *path, FILE *text) {
  FILE *file = fopen(path, "r");
  rewind(text);
  int c = EOF, d = EOF;
  while (file && (c = fgetc(file)) == (d = fgetc(text)) && c != EOF)
    ;
  if (file)
    fclose(file);
  return file && c == d;
}

int main(int argc, char **argv) {
  FILE *text = tmpfile();
  if (!text) {
    perror("timing-rules-test");
    return 2;
  }
  print_table(text);
  if (argc == 1) {
    rewind(text);
    for (int c; (c = fgetc(text)) != EOF;)
      putchar(c);
  } else if (!is_same(argv[1], text)) {
    fprintf(stderr, "%s is not what timing-rules-test prints\n", argv[1]);
    failures++;
  }
  fclose(text);
  return failures != 0;
}
