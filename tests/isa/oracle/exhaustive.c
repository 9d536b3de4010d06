/* isa-exhaustive: the arithmetic that the emulator executes, and the library's sqrtf, against the oracle. Output does
   not depend on the number of threads. */
#include <errno.h>
#include <fenv.h>
#include <getopt.h>
#include <inttypes.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "operations.h"

#define PIECE ((uint64_t)1 << 20) /* cases that a thread takes at a time */
#define PAIRS 1000000000          /* of each operation of two operands, by default */
#define MOST_JOBS 1024

static const char usage[] =
    "usage: isa-exhaustive [OPTION...]\n"
    "\n"
    "Compares the TP's floating-point arithmetic (trax/semantics.h), and the library's sqrtf compiled\n"
    "for the host, with an oracle that computes in integers: over all operands if there is one, over\n"
    "numbered pairs if there are two. Exit status: 0 if all agree, 1 otherwise.\n"
    "\n"
    "  --operation NAME  only this one; may be given several times\n"
    "  --first N         the number of the first case; default 0\n"
    "  --count N         cases of each operation; default all, and 1000000000 where they are pairs\n"
    "  --jobs N          threads; default one for each core\n"
    "  --round-to-zero   let the host round so, which is wrong: to see that differences are found\n"
    "  --help            print this, and end\n";

struct task {
  const struct operation *operation;
  uint64_t first, count;
  struct differences found;
};

struct run {
  struct task tasks[32];
  unsigned task_count;
  bool round_to_zero;
  pthread_mutex_t lock; /* of what follows, and of the tasks' differences */
  pthread_cond_t piece_done;
  unsigned task; /* the next piece */
  uint64_t offset;
  uint64_t done, total; /* cases */
};

static bool next_piece(struct run *run, struct task **task, uint64_t *first, uint64_t *count) {
  while (run->task < run->task_count && run->offset >= run->tasks[run->task].count) {
    run->task++;
    run->offset = 0;
  }
  if (run->task == run->task_count)
    return false;
  *task = &run->tasks[run->task];
  *first = (*task)->first + run->offset;
  uint64_t left = (*task)->count - run->offset;
  *count = left < PIECE ? left : PIECE;
  run->offset += *count;
  return true;
}

static void *work(void *argument) {
  struct run *run = argument;
  if (run->round_to_zero)
    fesetround(FE_TOWARDZERO);
  struct task *task;
  uint64_t first, count;
  pthread_mutex_lock(&run->lock);
  while (next_piece(run, &task, &first, &count)) {
    pthread_mutex_unlock(&run->lock);
    struct differences found = {0};
    task->operation->compare(first, count, &found);
    pthread_mutex_lock(&run->lock);
    for (unsigned i = 0; i < MOST_KEPT && i < found.count; i++)
      add_difference(&task->found, found.kept[i]);
    task->found.count += found.count > MOST_KEPT ? found.count - MOST_KEPT : 0;
    run->done += count;
    pthread_cond_signal(&run->piece_done);
  }
  pthread_mutex_unlock(&run->lock);
  return NULL;
}

/* Until all is done, a line on a terminal: what is done, and the time left. */
static void show_progress(struct run *run) {
  time_t start = time(NULL), last = start;
  bool terminal = isatty(STDERR_FILENO);
  pthread_mutex_lock(&run->lock);
  while (run->done < run->total) {
    pthread_cond_wait(&run->piece_done, &run->lock);
    time_t now = time(NULL);
    if (!terminal || now == last || run->task == run->task_count)
      continue;
    last = now;
    double share = (double)run->done / (double)run->total;
    unsigned left = (unsigned)((double)(now - start) * (1 - share) / share);
    fprintf(stderr, "\r%s, %.1f %% of %" PRIu64 " cases, %u:%02u left\033[K", run->tasks[run->task].operation->name,
            100 * share, run->total, left / 60, left % 60);
  }
  pthread_mutex_unlock(&run->lock);
  if (terminal)
    fprintf(stderr, "\r\033[K");
}

/* Returns how many operations differ. */
static unsigned report(const struct run *run) {
  unsigned wrong = 0;
  printf("%-10s %13s %12s  operands\n", "operation", "compared", "differences");
  for (unsigned i = 0; i < run->task_count; i++) {
    const struct task *task = &run->tasks[i];
    bool all = task->operation->all && task->count == task->operation->all;
    printf("%-10s %13" PRIu64 " %12" PRIu64 "  ", task->operation->name, task->count, task->found.count);
    if (all)
      printf("%s\n", task->operation->operands);
    else
      printf("%s, from number %" PRIu64 "\n", task->operation->all ? "some" : task->operation->operands, task->first);
    for (unsigned k = 0; k < MOST_KEPT && k < task->found.count; k++) {
      const struct difference *d = &task->found.kept[k];
      printf("  number %" PRIu64 ": %s of %08" PRIx32, d->number, task->operation->name, d->a);
      if (task->operation->arity == 2)
        printf(" %08" PRIx32, d->b);
      printf(" gives %08" PRIx32 ", the oracle %08" PRIx32 "\n", d->result, d->oracle);
    }
    wrong += task->found.count != 0;
  }
  printf("%u operations, %" PRIu64 " cases, %u operations differ\n", run->task_count, run->total, wrong);
  return wrong;
}

static uint64_t number(const char *option, const char *text, uint64_t least, uint64_t most) {
  char *end;
  errno = 0;
  unsigned long long n = strtoull(text, &end, 10);
  if (text[0] < '0' || text[0] > '9' || *end || errno || n < least || n > most) {
    fprintf(stderr, "isa-exhaustive: --%s must be a number from %" PRIu64 " to %" PRIu64 ", not '%s'\n", option, least,
            most, text);
    exit(1);
  }
  return n;
}

static bool *chosen_operation(bool *chosen, const char *name) {
  for (unsigned i = 0; i < operation_count; i++)
    if (strcmp(operations[i].name, name) == 0)
      return &chosen[i];
  fprintf(stderr, "isa-exhaustive: there is no operation '%s', but:", name);
  for (unsigned i = 0; i < operation_count; i++)
    fprintf(stderr, " %s", operations[i].name);
  fprintf(stderr, "\n");
  exit(1);
}

/* The cases first .. first + count - 1, as far as they exist; count 0: all from the first on. */
static void add_task(struct run *run, const struct operation *operation, uint64_t first, uint64_t count) {
  struct task task = {operation, first, count, {0}};
  if (operation->all) {
    uint64_t left = first < operation->all ? operation->all - first : 0;
    task.count = count == 0 || count > left ? left : count;
  } else if (count == 0) {
    task.count = PAIRS;
  }
  run->tasks[run->task_count++] = task;
  run->total += task.count;
}

int main(int argc, char **argv) {
  static const struct option options[] = {{"operation", required_argument, NULL, 'o'},
                                          {"first", required_argument, NULL, 'f'},
                                          {"count", required_argument, NULL, 'c'},
                                          {"jobs", required_argument, NULL, 'j'},
                                          {"round-to-zero", no_argument, NULL, 'z'},
                                          {"help", no_argument, NULL, 'h'},
                                          {0}};
  static struct run run = {.lock = PTHREAD_MUTEX_INITIALIZER, .piece_done = PTHREAD_COND_INITIALIZER};
  bool chosen[32] = {false}, any_chosen = false;
  uint64_t first = 0, count = 0;
  long cores = sysconf(_SC_NPROCESSORS_ONLN);
  unsigned jobs = cores < 1 ? 1 : cores > MOST_JOBS ? MOST_JOBS : (unsigned)cores;
  for (int option; (option = getopt_long(argc, argv, "", options, NULL)) != -1;)
    switch (option) {
    case 'o':
      *chosen_operation(chosen, optarg) = any_chosen = true;
      break;
    case 'f':
      first = number("first", optarg, 0, UINT64_MAX >> 4);
      break;
    case 'c':
      count = number("count", optarg, 1, UINT64_MAX >> 4);
      break;
    case 'j':
      jobs = (unsigned)number("jobs", optarg, 1, MOST_JOBS);
      break;
    case 'z':
      run.round_to_zero = true;
      break;
    case 'h':
      return fputs(usage, stdout) == EOF || fflush(stdout) == EOF;
    default:
      return 1;
    }
  if (optind < argc) {
    fprintf(stderr, "isa-exhaustive: '%s' is not an option; --help lists them\n", argv[optind]);
    return 1;
  }
  for (unsigned i = 0; i < operation_count; i++)
    if (!any_chosen || chosen[i])
      add_task(&run, &operations[i], first, count);

  if (run.total == 0) {
    fprintf(stderr, "isa-exhaustive: there is no case of number %" PRIu64 " or above\n", first);
    return 1;
  }

  pthread_t threads[MOST_JOBS];
  unsigned started = 0;
  while (started < jobs && pthread_create(&threads[started], NULL, work, &run) == 0)
    started++;
  if (started == 0) {
    fprintf(stderr, "isa-exhaustive: no thread can be started\n");
    return 1;
  }
  show_progress(&run);
  for (unsigned i = 0; i < started; i++)
    pthread_join(threads[i], NULL);
  bool failed = report(&run) != 0;
  return fflush(stdout) == EOF || failed;
}
