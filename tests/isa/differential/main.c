#define _GNU_SOURCE /* argp, MAP_ANONYMOUS */
/* Random programs from the description of the ISA, run in the reference engine, the fast engine, the functional mode
   and the model made from the manual. What differs is made small and printed as assembly. A case follows from its seed
   alone.

     isa-differential --count 300
     isa-differential --seed 4711 --count 1        that one
     isa-differential --count 100000 --jobs 2
     isa-differential --count 300 --words FILE     runs nothing: writes words for reassemble.py */
#include "case.h"
#include "words.h"

#include <argp.h>
#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { MOST_JOBS = 64, RANDOM_WORDS = 300 /* of an instruction */ };

struct options {
  unsigned seed, count, jobs;
  bool stop;
  const char *manual, *words;
};

struct tally {
  unsigned seed; /* of the case that is being run */
  unsigned cases[PROGRAM_KINDS], faults[MODEL_FAULT_ABORT + 1], unended, different;
  uint64_t instructions, executed[TRAX_OP_COUNT];
};

static volatile sig_atomic_t interrupted; /* Ctrl-C: the finished part is reported */

static void interrupt(int signal) {
  (void)signal;
  interrupted = 1;
}

static void run_case(const struct options *options, const struct model_isa *isa, unsigned seed, struct tally *tally) {
  struct differential_case c;
  struct differential_outcome outcome;
  tally->seed = seed;
  differential_case_of_seed(&c, seed);
  differential_compare(isa, &c, &outcome);
  tally->instructions += outcome.instructions;
  tally->unended += outcome.unended;
  if (!outcome.unended)
    tally->faults[outcome.fault]++;
  for (unsigned op = 0; op < TRAX_OP_COUNT; op++)
    tally->executed[op] += outcome.executed[op];
  if (*outcome.difference.text) {
    tally->different++;
    printf("seed %u (%s): %s\n", seed, program_kind_names[c.kind], outcome.difference.text);
    fflush(stdout);
    if (options->stop)
      _exit(0);
    differential_minimise(isa, &c);
    differential_compare(isa, &c, &outcome);
    printf("made smaller: %s\n", outcome.difference.text);
    differential_print(&c, stdout);
    fflush(stdout);
  }
  tally->cases[c.kind]++;
}

static unsigned done(const struct tally *tally) {
  unsigned sum = 0;
  for (unsigned kind = 0; kind < PROGRAM_KINDS; kind++)
    sum += tally->cases[kind];
  return sum;
}

static void show_progress(const struct options *options, const struct tally *tallies, time_t begin) {
  unsigned sum = 0;
  for (unsigned i = 0; i < options->jobs; i++)
    sum += done(&tallies[i]);
  const double passed = difftime(time(NULL), begin);
  fprintf(stderr, "\r%u of %u programs, %.0f s left ", sum, options->count,
          sum ? passed / sum * (options->count - sum) : 0.0);
}

/* Every job runs the seeds of its residue. Returns how many jobs came to an end that was not theirs. */
static unsigned run_jobs(const struct options *options, const struct model_isa *isa, struct tally *tallies) {
  pid_t pids[MOST_JOBS];
  unsigned lost = 0, left = options->jobs;
  const time_t begin = time(NULL);
  for (unsigned job = 0; job < options->jobs; job++) {
    fflush(NULL);
    pids[job] = fork();
    if (pids[job] < 0) {
      perror("isa-differential");
      exit(1);
    }
    if (pids[job] == 0) {
      for (unsigned i = job; i < options->count && !interrupted; i += options->jobs)
        run_case(options, isa, options->seed + i, &tallies[job]);
      _exit(0);
    }
  }
  while (left) {
    int status;
    const pid_t pid = waitpid(-1, &status, isatty(STDERR_FILENO) ? WNOHANG : 0);
    if (pid < 0) { /* a signal came: to the others too, unless it went to all */
      for (unsigned job = 0; job < options->jobs; job++)
        if (pids[job])
          kill(pids[job], SIGINT);
      continue;
    }
    if (pid == 0) {
      show_progress(options, tallies, begin);
      nanosleep(&(struct timespec){.tv_nsec = 200000000}, NULL);
      continue;
    }
    left--;
    for (unsigned job = 0; job < options->jobs; job++) {
      if (pids[job] != pid)
        continue;
      pids[job] = 0;
      if (status == 0)
        continue;
      printf("seed %u: the job ended with %s %d\n", tallies[job].seed, WIFSIGNALED(status) ? "signal" : "status",
             WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status));
      lost++;
    }
  }
  if (isatty(STDERR_FILENO))
    fprintf(stderr, "\n");
  return lost;
}

static struct tally sum_of(const struct tally *tallies, unsigned jobs) {
  struct tally sum = {0};
  for (unsigned job = 0; job < jobs; job++) {
    for (unsigned kind = 0; kind < PROGRAM_KINDS; kind++)
      sum.cases[kind] += tallies[job].cases[kind];
    for (unsigned kind = 0; kind <= MODEL_FAULT_ABORT; kind++)
      sum.faults[kind] += tallies[job].faults[kind];
    for (unsigned op = 0; op < TRAX_OP_COUNT; op++)
      sum.executed[op] += tallies[job].executed[op];
    sum.unended += tallies[job].unended;
    sum.different += tallies[job].different;
    sum.instructions += tallies[job].instructions;
  }
  return sum;
}

/* Returns whether every instruction was executed at all. */
static bool print_sum(const struct tally *sum) {
  const char *separator = "";
  unsigned rarest = 1;
  for (unsigned kind = 0; kind < PROGRAM_KINDS; kind++)
    printf("%s%u of %s", kind ? ", " : "programs: ", sum->cases[kind], program_kind_names[kind]);
  printf("; %u did not end and were not compared\nends: %u without a fault", sum->unended, sum->faults[0]);
  for (enum model_fault_kind kind = 1; kind <= MODEL_FAULT_ABORT; kind++)
    printf(", %u %s", sum->faults[kind], model_fault_word(kind));
  for (unsigned op = 1; op < TRAX_OP_COUNT; op++)
    if (sum->executed[op] < sum->executed[rarest])
      rarest = op;
  printf("\n%llu instructions in the model; the rarest of all %u, %s, %llu times",
         (unsigned long long)sum->instructions, TRAX_OP_COUNT - 1, trax_op_table[rarest].mnemonic,
         (unsigned long long)sum->executed[rarest]);
  for (unsigned op = 1; op < TRAX_OP_COUNT; op++)
    if (!sum->executed[op]) {
      printf("%s%s", *separator ? separator : "\nnever executed: ", trax_op_table[op].mnemonic);
      separator = ", ";
    }
  printf("\ndifferences between reference, fast, functional and model: %u\n", sum->different);
  return sum->executed[rarest] != 0;
}

static int run_all(const struct options *options) {
  struct model_error error;
  struct model_isa *isa = model_isa_read(options->manual, &error);
  if (!isa) {
    fprintf(stderr, "isa-differential: %s\n", error.message);
    return 1;
  }
  if (isa->count != TRAX_OP_COUNT - 1) {
    fprintf(stderr, "isa-differential: %s describes %zu instructions, the emulator has %d\n", options->manual,
            isa->count, TRAX_OP_COUNT - 1);
    return 1;
  }
  struct tally *tallies =
      mmap(NULL, MOST_JOBS * sizeof *tallies, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (tallies == MAP_FAILED) {
    perror("isa-differential");
    return 1;
  }
  const struct sigaction on_interrupt = {.sa_handler = interrupt};
  sigaction(SIGINT, &on_interrupt, NULL);
  sigaction(SIGTERM, &on_interrupt, NULL);
  const unsigned lost = run_jobs(options, isa, tallies);
  const struct tally sum = sum_of(tallies, options->jobs);
  const bool all = print_sum(&sum) || options->count < 100 || interrupted; /* so few need not have every instruction */
  munmap(tallies, MOST_JOBS * sizeof *tallies);
  model_isa_free(isa);
  return lost || sum.different || !all ? 1 : interrupted ? 130 : 0;
}

static int write_all(const struct options *options) {
  FILE *out = fopen(options->words, "wb");
  for (unsigned i = 0; out && i < options->count; i++) {
    struct differential_case c;
    differential_case_of_seed(&c, options->seed + i);
    write_words(out, c.words, c.count);
  }
  if (out) {
    write_extreme_words(out);
    random_state = 0x9E3779B97F4A7C15u * (options->seed + 1);
    write_random_words(out, RANDOM_WORDS);
  }
  const bool good = out && !ferror(out);
  if (!out || fclose(out) != 0 || !good) {
    fprintf(stderr, "isa-differential: %s: cannot be written: %s\n", options->words, strerror(errno));
    return 1;
  }
  return 0;
}

static unsigned number(struct argp_state *state, const char *option, const char *text, unsigned least, unsigned most) {
  char *end;
  errno = 0;
  const unsigned long value = strtoul(text, &end, 10);
  if (errno || end == text || *end || *text == '-' || value < least || value > most)
    argp_error(state, "--%s %s: expected a number from %u to %u", option, text, least, most);
  return (unsigned)value;
}

static error_t parse(int key, char *text, struct argp_state *state) {
  struct options *options = state->input;
  switch (key) {
  case 's':
    options->seed = number(state, "seed", text, 0, INT32_MAX);
    return 0;
  case 'c':
    options->count = number(state, "count", text, 1, INT32_MAX);
    return 0;
  case 'j':
    options->jobs = number(state, "jobs", text, 1, MOST_JOBS);
    return 0;
  case 'x':
    options->stop = true;
    return 0;
  case 'd':
    options->manual = text;
    return 0;
  case 'w':
    options->words = text;
    return 0;
  }
  return ARGP_ERR_UNKNOWN;
}

int main(int argc, char **argv) {
  static const struct argp_option table[] = {
      {"seed", 's', "N", 0, "of the first program; default 1", 0},
      {"count", 'c', "N", 0, "programs; default 1", 0},
      {"jobs", 'j', "N", 0, "processes; default 1", 0},
      {"stop", 'x', NULL, 0, "end with the first program that differs, as it is", 0},
      {"manual", 'd', "FILE", 0, "instead of the project's docs/isa.md", 0},
      {"words", 'w', "FILE", 0, "run nothing, write the programs' words and every format's extremes", 0},
      {0}};
  static const struct argp argp = {
      table, parse, NULL, "Random programs in the engines of the emulator and in the model made from the manual.",
      NULL,  NULL,  NULL};
  struct options options = {.seed = 1, .count = 1, .jobs = 1, .manual = MODEL_MANUAL};
  argp_err_exit_status = 1;
  argp_parse(&argp, argc, argv, 0, NULL, &options);
  return options.words ? write_all(&options) : run_all(&options);
}
