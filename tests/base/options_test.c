/* Tables of options: what a command line becomes, what is refused and how, what --help prints, which files are used. */
#include "trax/options.h"
#include "trax/output.h"

#include "temporary.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

struct filled {
  bool fast, shadows;
  const char *output, *input, *stats, *splits;
  unsigned threads, engine;
  uint64_t cycles;
  unsigned points;
};

static trax_status take_point(void *target, const trax_option *option, const char *value, trax_error *error) {
  unsigned *points = (unsigned *)((char *)target + option->offset);
  ++*points;
  return strcmp(value, "1,2") == 0 ? TRAX_OK : trax_option_refuse(option, value, error, "is not %d,%d", 1, 2);
}

static trax_status take_splits(void *target, const trax_option *option, const char *value, trax_error *error) {
  (void)option, (void)error;
  ((struct filled *)target)->splits = value ? value : "default";
  return TRAX_OK;
}

static unsigned shown;

static void show(FILE *out) {
  (void)out;
  shown++;
}

static const char *const engines[] = {"quick", "slow", "none", NULL};

#define FIELD(member) TRAX_OPTION_FIELD(struct filled, member)

static const trax_option rows[] = {
    {"output", 'o', .argument = "FILE", FIELD(output), .file = TRAX_OPTION_OUTPUT, .endings = "png",
     .meaning = "picture"},
    {"fast", 'f', FIELD(fast), .meaning = "switch"},
    {"no-shadows", FIELD(shadows), .off = true, .meaning = "switch off"},
    {"stats", .argument = "FILE", FIELD(stats), .once = true, .file = TRAX_OPTION_OUTPUT,
     .meaning = "figures,\nsecond line"},
    {"stack", .argument = "N", FIELD(threads), .least = 1, .most = 8, .meaning = "number"},
    {"cycles", .argument = "N", FIELD(cycles), .most = UINT64_MAX, .meaning = "large number"},
    {"engine", .argument = "WHICH", FIELD(engine), .choices = engines, .meaning = "choice"},
    {"splits", .argument = "[=FACTOR]", .parse = take_splits, .meaning = "optional"},
    {"point", .argument = "X,Y", .parse = take_point, .offset = offsetof(struct filled, points), .meaning = "parsed"},
    {"input-of-a-long-name", .argument = "FILE", FIELD(input), .file = TRAX_OPTION_INPUT, .meaning = "long"},
    TRAX_OPTION_GROUP("Others"),
    {"show", .kind = TRAX_OPTION_SHOW, .show = show, .meaning = "prints"},
    TRAX_OPTION_HELP('h'),
    TRAX_OPTION_VERSION,
    {"former", .instead = "use --fast"},
    {0}};
static const trax_command command = {.name = "tool",
                                     .synopsis = "[options] FILE\n--check",
                                     .description = "What it does.",
                                     .rows = rows,
                                     .notes = "The end.",
                                     .column = 24};

/* The same without letters. */
static const trax_option plain_rows[] = {{"fast", FIELD(fast), .meaning = "switch"}, {0}};
static const trax_command plain = {
    .name = "plain", .synopsis = "", .description = "", .rows = plain_rows, .column = 20};

static char *arguments[32];
static int count;
static struct filled filled;
static trax_error error;

/* Words between spaces. */
static trax_parsed parse(const trax_command *of, const char *line) {
  static char text[1200];
  snprintf(text, sizeof text, "tool %s", line);
  count = 0;
  for (char *word = strtok(text, " "); word; word = strtok(NULL, " "))
    arguments[count++] = strcmp(word, "\"\"") == 0 ? word + 2 : word;
  filled = (struct filled){.shadows = true};
  error.message[0] = '\0';
  return trax_command_parse(of, &filled, &count, arguments, &error);
}

static void accepted(const char *line) {
  if (parse(&command, line) != TRAX_PARSED_RUN)
    fail_msg("%s: %s", line, error.message);
}

static void refused(const char *line, const char *message) {
  assert_int_equal(parse(&command, line), TRAX_PARSED_WRONG);
  assert_string_equal(error.message, message);
}

static void test_values(void **state) {
  (void)state;
  accepted(
      "a -f --output=x.png --no-shadows --stack 8 - --cycles 0x10 --engine slow --splits --point 1,2 --point=1,2 b");
  assert_true(filled.fast && !filled.shadows);
  assert_string_equal(filled.output, "x.png");
  assert_int_equal(filled.threads, 8);
  assert_int_equal(filled.cycles, 16);
  assert_int_equal(filled.engine, 1);
  assert_string_equal(filled.splits, "default");
  assert_int_equal(filled.points, 2);
  assert_int_equal(count, 3); /* in their order, whatever stands between them */
  assert_string_equal(arguments[0], "a");
  assert_string_equal(arguments[1], "-");
  assert_string_equal(arguments[2], "b");
  accepted("--splits=4 --cycles 18446744073709551615 --stack 1 --stack 2");
  assert_string_equal(filled.splits, "4");
  assert_true(filled.cycles == UINT64_MAX);
  assert_int_equal(filled.threads, 2);
  assert_int_equal(count, 0);
  accepted("-fox.png -- --fast -f");
  assert_string_equal(filled.output, "x.png");
  assert_int_equal(count, 2);
  assert_string_equal(arguments[0], "--fast");
  accepted("--output --fast"); /* a value, whatever it looks like */
  assert_string_equal(filled.output, "--fast");
  assert_false(filled.fast);
}

static void test_names(void **state) {
  (void)state;
  accepted("--fa --inp=x --sp");
  assert_true(filled.fast && filled.input && filled.splits);
  refused("--st", "--st is ambiguous: --stats, --stack");
  refused("--statz", "unknown option --statz; did you mean --stats?");
  refused("--siez=1", "unknown option --siez");
  refused("--quite-another", "unknown option --quite-another");
  refused("--=x", "unknown option --");
  refused("--former=1", "--former has been removed; use --fast");
  refused("--forme", "unknown option --forme");
  refused("-fz", "unknown option -z");
  assert_int_equal(parse(&plain, "-fz"), TRAX_PARSED_WRONG);
  assert_string_equal(error.message, "unknown option -fz; options begin with two dashes");
}

static void test_refusals(void **state) {
  (void)state;
  refused("--fast=1", "--fast takes no value");
  refused("--stack", "--stack needs N");
  refused("a -o", "-o needs FILE");
  refused("--output=", "--output: the value is empty");
  refused("-o \"\"", "--output: the value is empty");
  refused("--splits=", "--splits: the value is empty");
  refused("--stats a --stats b", "--stats is given twice");
  refused("--engine fastest", "--engine: 'fastest' is none of quick, slow and none");
  refused("--point 3,4", "--point: '3,4' is not 1,2");
  static const char *const numbers[] = {"0", "9", "-1", "+1", "1x", "x", "1.5", "0x", "99999999999999999999"};
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
    char line[64], message[128];
    snprintf(line, sizeof line, "--stack %s", numbers[i]);
    snprintf(message, sizeof message, "--stack: '%s' is not a whole number from 1 to 8", numbers[i]);
    refused(line, message);
  }
  refused("--cycles 18446744073709551616",
          "--cycles: '18446744073709551616' is not a whole number from 0 to 18446744073709551615");
}

static void test_help(void **state) {
  (void)state;
  assert_int_equal(parse(&command, "--show --unknown"), TRAX_PARSED_DONE);
  assert_int_equal(shown, 1);
  char text[2048] = "";
  FILE *out = fmemopen(text, sizeof text, "w");
  trax_command_help(&command, out);
  fclose(out);
  assert_string_equal(text, "usage: tool [options] FILE\n"
                            "       tool --check\n"
                            "\n"
                            "What it does.\n"
                            "\n"
                            "  -o, --output FILE     picture\n"
                            "  -f, --fast            switch\n"
                            "      --no-shadows      switch off\n"
                            "      --stats FILE      figures,\n"
                            "                        second line\n"
                            "      --stack N         number\n"
                            "      --cycles N        large number\n"
                            "      --engine WHICH    choice\n"
                            "      --splits[=FACTOR] optional\n"
                            "      --point X,Y       parsed\n"
                            "      --input-of-a-long-name FILE  long\n"
                            "\n"
                            "Others:\n"
                            "      --show            prints\n"
                            "  -h, --help            print this, and end\n"
                            "      --version         print the version, and end\n"
                            "\n"
                            "The end.\n");
}

static void test_completion(void **state) {
  (void)state;
  char text[4096] = {0};
  FILE *out = fmemopen(text, sizeof text, "w");
  trax_command_completion(&command, out);
  fclose(out);
  assert_non_null(
      strstr(text, "    --engine) mapfile -t COMPREPLY < <(compgen -W 'quick slow none' -- \"$word\"); return ;;\n"));
  assert_non_null(
      strstr(text, "    -o | --output) mapfile -t COMPREPLY < <(compgen -f -- \"${word//\\\\/}\"); return ;;\n"));
  assert_non_null(strstr(text, "    --stack) return ;;\n"));
  assert_null(strstr(text, "former"));
  assert_null(strstr(text, "Others"));
}

static void test_files(void **state) {
  (void)state;
  trax_files files = {0};
  char line[1100], folder[512];
  snprintf(folder, sizeof folder, "%s", test_path("none/x"));
  snprintf(line, sizeof line, "--input %s --stats %s", test_path("same"), test_path("./same"));
  accepted(line);
  trax_command_files(&command, &filled, &files);
  assert_int_equal(files.count, 2);
  assert_int_equal(trax_files_check(&files, &error), TRAX_ERROR);
  assert_non_null(strstr(error.message, "is an input and the output of --stats"));
  trax_files_release(&files);
  assert_int_equal(trax_command_check_outputs(&command, &filled, &error), TRAX_OK);
  snprintf(line, sizeof line, "--stats %s", folder);
  accepted(line);
  assert_int_equal(trax_command_check_outputs(&command, &filled, &error), TRAX_ERROR);
  assert_non_null(strstr(error.message, "cannot be written"));
  snprintf(line, sizeof line, "-o %s", test_path("x.jpeg"));
  accepted(line);
  assert_int_equal(trax_command_check_outputs(&command, &filled, &error), TRAX_ERROR);
  assert_non_null(strstr(error.message, "there is no writer for .jpeg, only for .png"));
}

/* A current folder that may not be searched: the search for the file that a path names ends there, with an error. */
static int use_closed_folder(const char *folder) {
  trax_files files = {0};
  if (chdir(folder) != 0 || chmod(".", 0) != 0 || (geteuid() == 0 && seteuid(65534) != 0))
    return 2;
  trax_files_output(&files, NULL, "x");
  const bool good = trax_files_check(&files, &error) == TRAX_OK && trax_output_check("x", &error) == TRAX_ERROR &&
                    strstr(error.message, "x: cannot be written: Permission denied");
  trax_files_release(&files);
  return !good;
}

static void test_closed_folder(void **state) {
  (void)state;
  const char *folder = test_path("closed");
  int status;
  assert_int_equal(mkdir(folder, 0700), 0);
  const pid_t child = fork();
  if (child == 0) {
    alarm(10);
    const int result = use_closed_folder(folder);
    if (getuid() == 0)
      (void)!seteuid(0); /* the files of gcov are root's */
    _exit(result);
  }
  assert_int_equal(waitpid(child, &status, 0), child);
  assert_int_equal(status, 0);
  assert_int_equal(rmdir(folder), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_values),       cmocka_unit_test(test_names),
                                     cmocka_unit_test(test_refusals),     cmocka_unit_test(test_help),
                                     cmocka_unit_test(test_completion),   cmocka_unit_test(test_files),
                                     cmocka_unit_test(test_closed_folder)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
