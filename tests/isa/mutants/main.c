/* Runs the conformance suite against mutants of the reference engine (mutants.h), a process for each:

     trax-isa-mutants --list                        every mutant: number, mnemonic, fault
     trax-isa-mutants TESTS MEMORY_MIB JOBS         reads numbers from the standard input, one a line

   TESTS has a line for each image, its fields separated by tabs: path of the image, of its reference signature, what it
   tests, TMs, TPs of a TM, exit status or -, output in hexadecimal. Signatures are made beside it. First all images are
   run on the machine as it is. Then, for each number, one line: the number, and the path of the first image that
   noticed, or -. An image notices by its signature, its output, its exit status, by not ending in twice its time, or by
   ending the emulator. */
#define _DEFAULT_SOURCE /* fork, open_memstream, strsep */
#include "machine/machine.h"
#include "mutants.h"
#include "trax/version.h"

#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

unsigned trax_mutant;

enum { SECONDS = 300 }; /* for all images together: more is an error of this program */

struct test {
  char *image, *signature, *of, *output;
  unsigned tms, tps;
  int status; /* -1: any */
  char *wanted;
  uint64_t limit; /* cycles */
};

static struct test *tests;
static unsigned test_count;
static unsigned *order; /* of the tests, for mutants of no single instruction: those that noticed lately come first */
static const char *memory_mib;
static const char *scratch; /* path that the signatures made begin with */

__attribute__((noreturn, format(printf, 1, 2))) static void fail(const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  fputs("trax-isa-mutants: ", stderr);
  vfprintf(stderr, format, arguments);
  fputc('\n', stderr);
  va_end(arguments);
  exit(1);
}

static void *check(void *pointer) {
  if (!pointer)
    fail("out of memory");
  return pointer;
}

/* NULL if it cannot be read. */
static char *read_text(const char *path) {
  FILE *file = fopen(path, "r");
  if (!file)
    return NULL;
  char *text = NULL;
  size_t size = 0;
  if (getdelim(&text, &size, 0, file) < 0) {
    free(text);
    text = check(strdup(""));
  }
  fclose(file);
  return text;
}

/* --- one image --- */

static trax_machine *load(const struct test *test, trax_error *error) {
  char tms[12], tps[12];
  snprintf(tms, sizeof tms, "%u", test->tms);
  snprintf(tps, sizeof tps, "%u", test->tps);
  trax_config *config = check(trax_config_create());
  trax_machine *machine = NULL;
  if (trax_config_set(config, "chip.tms", tms, error) == TRAX_OK &&
      trax_config_set(config, "chip.tps_per_tm", tps, error) == TRAX_OK &&
      trax_config_set(config, "ray.units_per_group", "1", error) == TRAX_OK &&
      trax_config_set(config, "memory.size_mib", memory_mib, error) == TRAX_OK)
    machine = trax_machine_create(config, error);
  trax_config_destroy(config);
  if (machine && trax_machine_load_elf(machine, test->image, error) != TRAX_OK) {
    trax_machine_destroy(machine);
    machine = NULL;
  }
  return machine;
}

static bool same_signature(const struct test *test, const trax_machine *machine) {
  char path[4096];
  trax_error error;
  snprintf(path, sizeof path, "%s.%ld", scratch, (long)getpid());
  if (trax_machine_write_signature(machine, path, &error) != TRAX_OK)
    return false;
  char *found = read_text(path);
  const bool same = found && strcmp(found, test->wanted) == 0;
  free(found);
  unlink(path);
  return same;
}

static bool same_output(const struct test *test, const char *output, size_t size) {
  bool same = strlen(test->output) == 2 * size;
  for (size_t i = 0; same && i < size; i++) {
    char digits[3];
    snprintf(digits, sizeof digits, "%02x", (unsigned char)output[i]);
    same = memcmp(digits, test->output + 2 * i, 2) == 0;
  }
  return same;
}

/* Whether the image ends as it should; and its length, if `cycles` is not NULL. */
static bool passes(const struct test *test, uint64_t *cycles) {
  trax_error error = {.message = ""};
  trax_machine *machine = load(test, &error);
  if (!machine)
    fail("%s", error.message);
  char *output = NULL;
  size_t size = 0;
  FILE *stream = check(open_memstream(&output, &size));
  const trax_run_options options = {.engine = "reference", .output = stream, .max_cycles = test->limit};
  const trax_status status = trax_machine_run(machine, &options, &error);
  fclose(stream);
  const bool pass = (status == TRAX_OK || status == TRAX_FAULT) && same_output(test, output, size) &&
                    (test->status < 0 || (trax_machine_exit_status(machine) & 0xFF) == test->status) &&
                    same_signature(test, machine);
  if (cycles)
    *cycles = machine->stats.cycles;
  free(output);
  trax_machine_destroy(machine);
  return pass;
}

/* --- the tests --- */

static char *field(char **line) {
  char *text = strsep(line, "\t");
  return text ? text : "";
}

static void read_tests(const char *path) {
  FILE *file = fopen(path, "r");
  if (!file)
    fail("%s: cannot be read", path);
  char *line = NULL;
  size_t size = 0;
  while (getline(&line, &size, file) > 0) {
    char *rest = check(strdup(line));
    rest[strcspn(rest, "\n")] = 0;
    tests = check(realloc(tests, (test_count + 1) * sizeof *tests));
    struct test *test = &tests[test_count++];
    *test = (struct test){.image = field(&rest), .signature = field(&rest), .of = field(&rest)};
    test->tms = (unsigned)strtoul(field(&rest), NULL, 10);
    test->tps = (unsigned)strtoul(field(&rest), NULL, 10);
    const char *const status = field(&rest);
    test->status = *status == '-' ? -1 : (int)strtol(status, NULL, 10);
    test->output = field(&rest);
    test->wanted = read_text(test->signature);
    if (!test->wanted)
      fail("%s: cannot be read", test->signature);
  }
  free(line);
  fclose(file);
}

static void run_unmutated(void) {
  order = check(malloc(test_count * sizeof *order));
  for (unsigned i = 0; i < test_count; i++) {
    uint64_t cycles;
    if (!passes(&tests[i], &cycles))
      fail("%s: fails on the machine as it is", tests[i].image);
    tests[i].limit = 2 * cycles + 1000;
    order[i] = i;
  }
}

/* --- the mutants --- */

static void describe(unsigned number, struct trax_mutant_text *text) {
  static const struct {
    unsigned (*count)(void);
    void (*describe)(unsigned index, struct trax_mutant_text *text);
  } sorts[] = {{trax_statement_mutants, trax_statement_mutant},
               {trax_arithmetic_mutants, trax_arithmetic_mutant},
               {trax_decoding_mutants, trax_decoding_mutant},
               {trax_machine_mutants, trax_machine_mutant},
               {trax_order_mutants, trax_order_mutant}};
  unsigned index = number - 1;
  for (size_t i = 0; i < sizeof sorts / sizeof *sorts; i++) {
    if (index < sorts[i].count()) {
      sorts[i].describe(index, text);
      return;
    }
    index -= sorts[i].count();
  }
  fail("there is no mutant %u", number);
}

static unsigned mutant_count(void) {
  return trax_statement_mutants() + trax_arithmetic_mutants() + trax_decoding_mutants() + trax_machine_mutants() +
         trax_order_mutants();
}

/* Whether the test is the one named, one of the instruction's, any other: 0, 1, 2. */
static int rank(const struct test *test, const struct trax_mutant_text *text) {
  const char *const slash = strrchr(test->image, '/'), *const name = slash ? slash + 1 : test->image;
  const size_t length = strlen(text->image);
  if (length && strncmp(name, text->image, length) == 0 && strcmp(name + length, ".elf") == 0)
    return 0;
  return strcmp(test->of, text->mnemonic) == 0 ? 1 : 2;
}

/* In a process of its own: tells the number of each test before it is run, test_count behind the last if none notices.
 */
static void try_mutant(unsigned number, int answer) {
  struct trax_mutant_text text = {.image = ""};
  describe(number, &text);
  trax_mutant = number;
  for (int turn = 0; turn <= 2; turn++)
    for (unsigned i = 0; i < test_count; i++) {
      const unsigned test = order[i];
      if (rank(&tests[test], &text) != turn)
        continue;
      if (write(answer, &test, sizeof test) != sizeof test)
        exit(1);
      if (!passes(&tests[test], NULL))
        return;
    }
  if (write(answer, &test_count, sizeof test_count) != sizeof test_count)
    exit(1);
}

struct child {
  pid_t pid;
  unsigned number;
  int answer;
};

static void start(struct child *child, unsigned number) {
  int ends[2];
  fflush(stdout);
  if (pipe(ends))
    fail("no pipe can be made");
  child->number = number;
  child->answer = ends[0];
  child->pid = fork();
  if (child->pid < 0)
    fail("no process can be made");
  if (child->pid == 0) {
    close(ends[0]);
    alarm(SECONDS);
    if (!freopen("/dev/null", "w", stderr))
      exit(1);
    try_mutant(number, ends[1]);
    _exit(0);
  }
  close(ends[1]);
}

static void move_to_front(unsigned test) {
  unsigned at = 0;
  while (order[at] != test)
    at++;
  memmove(order + 1, order, at * sizeof *order);
  order[0] = test;
}

/* The latest answer is the test that was tried last. */
static void finish(struct child *child) {
  unsigned test = test_count, next;
  while (read(child->answer, &next, sizeof next) == sizeof next)
    test = next;
  close(child->answer);
  printf("%u\t%s\n", child->number, test < test_count ? tests[test].image : "-");
  struct trax_mutant_text text = {.image = ""};
  describe(child->number, &text);
  if (test < test_count && !text.mnemonic[0] && !text.image[0])
    move_to_front(test);
  child->pid = 0;
}

static void run_mutants(unsigned jobs) {
  struct child *children = check(calloc(jobs, sizeof *children));
  unsigned running = 0, number;
  bool more = true;
  while (more || running) {
    while (more && running < jobs) {
      more = scanf("%u", &number) == 1;
      for (unsigned i = 0; more && i < jobs; i++)
        if (!children[i].pid) {
          start(&children[i], number);
          running++;
          break;
        }
    }
    if (!running)
      break;
    int status;
    const pid_t ended = wait(&status);
    for (unsigned i = 0; i < jobs; i++)
      if (children[i].pid == ended) {
        if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
          fail("mutant %u: not done after %d s", children[i].number, SECONDS);
        finish(&children[i]);
        running--;
      }
  }
  free(children);
}

int main(int argc, char **argv) {
  if (argc == 2 && strcmp(argv[1], "--version") == 0) {
    puts("trax-isa-mutants " TRAX_VERSION);
    return 0;
  }
  if (argc == 2 && strcmp(argv[1], "--list") == 0) {
    for (unsigned number = 1; number <= mutant_count(); number++) {
      struct trax_mutant_text text = {.image = ""};
      describe(number, &text);
      printf("%u\t%s\t%s\n", number, text.mnemonic, text.what);
    }
    return 0;
  }
  if (argc != 4)
    fail("usage: trax-isa-mutants --list | --version | TESTS MEMORY_MIB JOBS");
  memory_mib = argv[2];
  scratch = argv[1];
  mutant_count(); /* the tables are made before the processes part */
  read_tests(argv[1]);
  run_unmutated();
  const unsigned long jobs = strtoul(argv[3], NULL, 10);
  run_mutants(jobs ? (unsigned)jobs : 1);
  return 0;
}
