#define _GNU_SOURCE /* getopt_long, fork */
/* The fast engine against the reference, and the functional mode against both: random programs on random machines, to
   the last count and byte. A case follows from its seed alone. One that differs is made small and printed.

     timing-engines-test --seed 1 --count 2000 --jobs 2
     timing-engines-test --seed 4711                         that one
     timing-engines-test --set memory.queue_depth=1 ...      on machines with that
     timing-engines-test --engine fast-any ...               a variant of the fast engine (control/engines.h)
     timing-engines-test --stop ...                          ends with the first case that differs, as it is

   Every case runs in a process of its own, so that a crash or an endless loop of an engine is a finding like others. */
#include "cases.h"
#include "control/engines.h"
#include "minimise.h"

#include <errno.h>
#include <getopt.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { MOST_JOBS = 64, MOST_KEYS = 64, CASE_SECONDS = 300 };

struct options {
  unsigned seed, count, jobs;
  const char *set[MOST_KEYS]; /* "key=value": of every case */
  unsigned set_count;
  bool stop; /* at the first case that differs, as it is */
};

struct tally {
  unsigned cases[CASE_KINDS], ended[TRAX_STUCK + 1], faults[TRAX_FAULT_COUNT];
  unsigned different;
  uint64_t cycles, instructions;
};

struct job {
  pid_t pid; /* 0: none */
  unsigned seed;
  int result; /* end of a pipe */
};

static void set_keys(const struct options *options, struct trax_config *config) {
  for (unsigned i = 0; i < options->set_count; i++) {
    const char *equals = strchr(options->set[i], '=');
    char key[64];
    trax_error error;
    snprintf(key, sizeof key, "%.*s", equals ? (int)(equals - options->set[i]) : 0, options->set[i]);
    if (!equals || trax_config_set(config, key, equals + 1, &error)) {
      fprintf(stderr, "timing-engines-test: --set %s: %s\n", options->set[i], equals ? error.message : "no value");
      exit(2);
    }
  }
}

static struct random_case prepare(const struct options *options, unsigned seed) {
  struct random_case c = case_of_seed(seed);
  const struct trax_config initial = TRAX_CONFIG_DEFAULT;
  trax_error error;
  set_keys(options, &c.config);
  if (trax_config_validate(&c.config, NULL)) { /* other values of the case do not go with them */
    const uint32_t tms = c.config.chip.tms, tps = c.config.chip.tps_per_tm, rays = c.config.ray.units_per_group;
    c.config = initial;
    c.config.ray.units_per_group = rays; /* the program may need them */
    c.config.chip.tms = tms;
    c.config.chip.tps_per_tm = tps;
    c.config.memory.size_mib = 1;
    set_keys(options, &c.config);
  }
  if (c.one_thread)
    c.config.chip.tms = c.config.chip.tps_per_tm = 1;
  if (trax_config_validate(&c.config, &error)) {
    fprintf(stderr, "timing-engines-test: %s\n", error.message);
    exit(2);
  }
  return c;
}

static void run_case(const struct options *options, unsigned seed, int result) {
  const struct random_case c = prepare(options, seed);
  alarm(CASE_SECONDS);
  const struct comparison comparison = compare_case(&c);
  if (write(result, &comparison, sizeof comparison) != sizeof comparison)
    _exit(2);
  _exit(0);
}

static void begin(const struct options *options, struct job *job, unsigned seed) {
  int ends[2];
  fflush(NULL);
  if (pipe(ends) || (job->pid = fork()) < 0) {
    perror("timing-engines-test");
    exit(2);
  }
  if (job->pid == 0) {
    close(ends[0]);
    run_case(options, seed, ends[1]);
  }
  close(ends[1]);
  job->seed = seed;
  job->result = ends[0];
}

static void report(const struct options *options, const struct job *job, const char *difference) {
  const unsigned kind = job->seed % CASE_KINDS;
  printf("seed %u (%s) differs: %s\n", job->seed, case_kind_names[kind], difference);
  fflush(stdout);
  if (options->stop)
    return;
  struct random_case c = prepare(options, job->seed);
  minimise(&c);
  print_case(&c, stdout);
}

static void finish(const struct options *options, struct job *job, int status, struct tally *tally) {
  struct comparison comparison = {.status = TRAX_ERROR};
  const ssize_t got = read(job->result, &comparison, sizeof comparison);
  close(job->result);
  job->pid = 0;
  if (status != 0 || got != sizeof comparison) {
    comparison = (struct comparison){.status = TRAX_ERROR};
    if (WIFSIGNALED(status))
      snprintf(comparison.difference.text, sizeof comparison.difference.text, "%s",
               WTERMSIG(status) == SIGALRM ? "it does not end" : strsignal(WTERMSIG(status)));
    else
      snprintf(comparison.difference.text, sizeof comparison.difference.text, "exit status %d", WEXITSTATUS(status));
  }
  tally->cases[job->seed % CASE_KINDS]++;
  tally->ended[comparison.status]++;
  tally->faults[comparison.fault]++;
  tally->cycles += comparison.cycles;
  tally->instructions += comparison.instructions;
  if (comparison.difference.text[0]) {
    tally->different++;
    report(options, job, comparison.difference.text);
  }
}

static void run_all(const struct options *options, struct tally *tally) {
  struct job jobs[MOST_JOBS] = {0};
  unsigned next = 0, running = 0;
  while (true) {
    const unsigned end = options->stop && tally->different ? next : options->count;
    if (next >= end && !running)
      break;
    if (next < end && running < options->jobs) {
      struct job *job = jobs;
      while (job->pid)
        job++;
      begin(options, job, options->seed + next++);
      running++;
      continue;
    }
    int status;
    const pid_t pid = wait(&status);
    for (struct job *job = jobs; job < jobs + MOST_JOBS; job++)
      if (pid > 0 && job->pid == pid) {
        finish(options, job, status, tally);
        running--;
      }
  }
}

static unsigned number(const char *option, const char *text, unsigned least, unsigned most) {
  char *end;
  errno = 0;
  const unsigned long value = strtoul(text, &end, 10);
  if (errno || end == text || *end || *text == '-' || value < least || value > most) {
    fprintf(stderr, "timing-engines-test: %s %s: must be a number from %u to %u\n", option, text, least, most);
    exit(2);
  }
  return (unsigned)value;
}

static const char *engine(const char *name) {
  const struct trax_engine *found;
  trax_error error;
  if (trax_engine_find(name, &found, &error) != TRAX_OK) {
    fprintf(stderr, "timing-engines-test: the engine %s %s\n", name, error.message);
    exit(2);
  }
  return name;
}

static void help(void) {
  puts("Usage: timing-engines-test [OPTION...]\n"
       "Compares the engines on random programs and machines. A case follows from its seed.\n\n"
       "  --seed N         the first case; default 1\n"
       "  --count N        how many cases; default 1\n"
       "  --jobs N         cases at the same time, 1 to 64; default 1\n"
       "  --set KEY=VALUE  on machines with that value; may be repeated\n"
       "  --engine NAME    the engine that is compared with the reference; default fast\n"
       "  --stop           end with the first case that differs, as it is, instead of making it small\n"
       "  --help           print this text, and end\n\n"
       "Exit status: 0 if nothing differs, 1 if a case differs, 2 for an error of use.");
  exit(0);
}

static struct options parse(int argc, char **argv) {
  static const struct option known[] = {
      {"seed", required_argument, NULL, 's'}, {"count", required_argument, NULL, 'c'},
      {"jobs", required_argument, NULL, 'j'}, {"set", required_argument, NULL, 'k'},
      {"stop", no_argument, NULL, 'x'},       {"engine", required_argument, NULL, 'e'},
      {"help", no_argument, NULL, 'h'},       {NULL, 0, NULL, 0},
  };
  struct options options = {.seed = 1, .count = 1, .jobs = 1};
  int option;
  while ((option = getopt_long(argc, argv, "", known, NULL)) != -1)
    switch (option) {
    case 's':
      options.seed = number("--seed", optarg, 0, UINT32_MAX / 2);
      break;
    case 'c':
      options.count = number("--count", optarg, 1, INT32_MAX);
      break;
    case 'j':
      options.jobs = number("--jobs", optarg, 1, MOST_JOBS);
      break;
    case 'k':
      if (options.set_count == MOST_KEYS) {
        fprintf(stderr, "timing-engines-test: at most %d --set\n", MOST_KEYS);
        exit(2);
      }
      options.set[options.set_count++] = optarg;
      break;
    case 'e':
      tested_engine = engine(optarg);
      break;
    case 'x':
      options.stop = true;
      break;
    case 'h':
      help();
      break;
    default:
      exit(2);
    }
  prepare(&options, options.seed); /* or its message */
  if (optind < argc) {
    fprintf(stderr, "timing-engines-test: %s: there are only options\n", argv[optind]);
    exit(2);
  }
  return options;
}

/* Whether the cases were of enough kinds to say something. */
static bool is_rich(const struct tally *tally) {
  unsigned kinds_of_faults = 0;
  for (unsigned kind = TRAX_FAULT_NONE + 1; kind < TRAX_FAULT_COUNT; kind++)
    kinds_of_faults += tally->faults[kind] != 0;
  return tally->ended[TRAX_OK] && tally->ended[TRAX_FAULT] && tally->ended[TRAX_STUCK] && kinds_of_faults >= 4 &&
         tally->instructions > 100000;
}

int main(int argc, char **argv) {
  const struct options options = parse(argc, argv);
  struct tally tally = {0};
  struct timespec from, to;
  clock_gettime(CLOCK_MONOTONIC, &from);
  run_all(&options, &tally);
  clock_gettime(CLOCK_MONOTONIC, &to);
  const bool rich = options.count < 100 || options.set_count || tally.different || is_rich(&tally);
  printf(
      "seeds %u to %u: %u of %u cases differ; %u ended, %u faulted, %u were stopped; %llu instructions in %llu cycles; "
      "%.1f s%s\n",
      options.seed, options.seed + options.count - 1, tally.different, options.count, tally.ended[TRAX_OK],
      tally.ended[TRAX_FAULT], tally.ended[TRAX_STUCK], (unsigned long long)tally.instructions,
      (unsigned long long)tally.cycles, (double)(to.tv_sec - from.tv_sec) + 1e-9 * (double)(to.tv_nsec - from.tv_nsec),
      rich ? "" : "; too few kinds of cases to prove anything");
  return tally.different || !rich;
}
