/* isa-exhaustive: the arithmetic that the emulator executes, and the library's sqrtf, against the oracle. Output does
   not depend on the number of threads. */
#include <fenv.h>
#include <inttypes.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "operations.h"
#include "trax/options.h"

#define PIECE ((uint64_t)1 << 20) /* cases that a thread takes at a time */
#define PAIRS 1000000000          /* of each operation of two operands, by default */
#define MOST_JOBS 1024

enum { MOST_OPERATIONS = 32 };

static struct options {
  bool chosen[MOST_OPERATIONS], any_chosen;
  uint64_t first, count; /* count 0: the default */
  unsigned jobs;
  bool round_to_zero;
} options;

static trax_status take_operation(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct options *given = target;
  char known[256] = "";
  for (unsigned i = 0; i < operation_count; i++) {
    if (strcmp(operations[i].name, value) == 0) {
      given->chosen[i] = given->any_chosen = true;
      return TRAX_OK;
    }
    snprintf(known + strlen(known), sizeof known - strlen(known), " %s", operations[i].name);
  }
  (void)option;
  return trax_fail(error, "there is no operation '%s', but:%s", value, known);
}

#define FIELD(member) TRAX_OPTION_FIELD(struct options, member)
static const trax_option rows[] = {
    {"operation", .argument = "NAME", .parse = take_operation, .meaning = "only this one (repeatable)"},
    {"first", .argument = "N", FIELD(first), .most = UINT64_MAX >> 4, .meaning = "the number of the first case"},
    {"count", .argument = "N", FIELD(count), .least = 1, .most = UINT64_MAX >> 4,
     .meaning = "cases of each operation; default all, and 1000000000 where they are pairs"},
    {"jobs", .argument = "N", FIELD(jobs), .least = 1, .most = MOST_JOBS,
     .meaning = "threads; default one for each core"},
    {"round-to-zero", FIELD(round_to_zero),
     .meaning = "let the host round so, which is wrong: to see that differences are found"},
    TRAX_OPTION_HELP(0),
    {0}};

static const trax_command command = {
    .name = "isa-exhaustive",
    .synopsis = "[OPTION...]",
    .description = "Compares the TP's floating-point arithmetic (trax/semantics.h), and the library's sqrtf compiled\n"
                   "for the host, with an oracle that computes in integers: over all operands if there is one, over\n"
                   "numbered pairs if there are two. Exit status: 0 if all agree, 1 otherwise.",
    .rows = rows,
    .column = 22};

struct task {
  const struct operation *operation;
  uint64_t first, count;
  struct differences found;
};

struct run {
  struct task tasks[MOST_OPERATIONS];
  unsigned task_count;
  bool round_to_zero;
  pthread_mutex_t lock; /* protects the following members and the tasks' differences */
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

/* Prints a line of progress on a terminal until all tasks are done. */
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
  static struct run run = {.lock = PTHREAD_MUTEX_INITIALIZER, .piece_done = PTHREAD_COND_INITIALIZER};
  const long cores = sysconf(_SC_NPROCESSORS_ONLN);
  options.jobs = cores < 1 ? 1 : cores > MOST_JOBS ? MOST_JOBS : (unsigned)cores;
  trax_error error;
  const trax_parsed parsed = trax_command_parse(&command, &options, &argc, argv, &error);
  if (parsed == TRAX_PARSED_DONE)
    return 0;
  if (parsed == TRAX_PARSED_RUN && argc > 0)
    trax_fail(&error, "'%s' is not an option; --help lists them", argv[0]);
  if (parsed == TRAX_PARSED_WRONG || argc > 0) {
    fprintf(stderr, "isa-exhaustive: %s\n", error.message);
    return 1;
  }
  run.round_to_zero = options.round_to_zero;
  for (unsigned i = 0; i < operation_count; i++)
    if (!options.any_chosen || options.chosen[i])
      add_task(&run, &operations[i], options.first, options.count);

  if (run.total == 0) {
    fprintf(stderr, "isa-exhaustive: there is no case of number %" PRIu64 " or above\n", options.first);
    return 1;
  }

  pthread_t threads[MOST_JOBS];
  unsigned started = 0;
  while (started < options.jobs && pthread_create(&threads[started], NULL, work, &run) == 0)
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
