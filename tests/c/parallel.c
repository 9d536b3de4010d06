// clang-format off
// RUN: %run_c %s %t --levels -O2 --also -O0 --cflags "-mstack=global" --simflags "--set chip.tms=2 --set chip.tps_per_tm=8 --main-on 0 --max-cycles 9000000"
// RUN: %run_c %s %t --levels -O2 --cflags "-mstack=global" --simflags "--max-cycles 9000000"
// RUN: %trax_sim --set chip.tms=2 --set chip.tps_per_tm=8 --main-on 0 --check-races %t-O2 | diff %S/parallel.expected -
// clang-format on
// Work for all threads, again and again. (Expected output by hand; it does not depend on the number of threads.)
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <trax.h>
#include <trax/parallel.h>

enum { N = 700 };
static unsigned values[N], calls, wrong;
static struct trax_barrier barrier = TRAX_BARRIER(1);

static void add(unsigned begin, unsigned end, void *context) {
  trax_atomic_inc(&calls);
  for (unsigned i = begin; i < end; i++)
    values[i] += i * *(unsigned *)context;
}

static void check(const char *what, unsigned factor) {
  for (unsigned i = 0; i < N; i++)
    if (values[i] != i * factor) {
      printf("%s: value %u is %u\n", what, i, values[i]);
      break;
    }
  memset(values, 0, sizeof values);
}

static void sum(unsigned begin, unsigned end, void *context, void *result) {
  (void)context;
  for (unsigned i = begin; i < end; i++)
    *(unsigned long long *)result += (unsigned long long)i * i;
}

static void plus(void *result, const void *part) {
  *(unsigned long long *)result += *(const unsigned long long *)part;
}

/* Each thread writes, and after the barrier reads what its neighbour wrote. */
static unsigned slots[256];
static void neighbours(void *nothing) {
  (void)nothing;
  const unsigned self = trax_team_rank(), team = trax_team_size();
  for (unsigned round = 1; round < 20; round++) {
    slots[self] = round * 100 + self;
    trax_team_barrier();
    if (slots[(self + 1) % team] != round * 100 + (self + 1) % team)
      trax_atomic_inc(&wrong);
    if (round % 2)
      trax_barrier_wait(&barrier);
    else
      trax_team_barrier();
  }
}

static void nothing(void *context) {
  (void)context;
}

/* A tree of tasks, more than the queue holds. */
static unsigned leaves;
static void task(void *context) {
  unsigned *depth = context;
  if (*depth == 0) {
    trax_atomic_inc(&leaves);
    return;
  }
  for (int i = 0; i < 3; i++) {
    unsigned *below = malloc(sizeof *below);
    *below = *depth - 1;
    trax_add_task(task, below);
  }
}

/* On this thread. */
static void inside(unsigned begin, unsigned end, void *context) {
  trax_parallel_for(begin, end, 1, add, context);
}

/* Work in work in work. */
static unsigned deepest[64];
static void fill(unsigned begin, unsigned end, void *context) {
  for (unsigned i = begin; i < end; i++)
    *(unsigned *)context += i;
}

static void third(void *context) {
  unsigned long long total = 0;
  trax_parallel_for(0, 4, 1, fill, context);
  trax_parallel_reduce(0, 100, sum, NULL, &total, sizeof total, plus);
  *(unsigned *)context += (unsigned)total;
}

static void second(unsigned begin, unsigned end, void *context) {
  (void)context;
  for (unsigned i = begin; i < end; i++)
    trax_parallel(third, &deepest[i]);
}

/* A task waits for tasks of its own. */
static void below(void *count) {
  trax_atomic_inc(count);
}

static void two_below(void *count) {
  trax_add_task(below, count);
  trax_add_task(below, count);
}

static void waits(void *context) {
  unsigned *count = calloc(1, sizeof *count);
  trax_run_tasks(two_below, count);
  if (__atomic_load_n(count, __ATOMIC_RELAXED) != 2)
    trax_atomic_inc(&wrong);
  free(count);
  (void)context;
}

static void many_wait(void *context) {
  for (int i = 0; i < 9; i++)
    trax_add_task(waits, context);
}

void __trax_wait(void);
extern unsigned __trax_waiting;

int main(void) {
  if (trax_thread() != 0) { /* a machine without --main-on 0 */
    __trax_wait();
    return 0;
  }
  __trax_waiting = trax_threads() - 1;
  static unsigned factor = 3;
  for (unsigned grain = 0; grain < 9; grain += 4) {
    trax_parallel_for(0, N, grain, add, &factor);
    check("dynamic", 3);
    trax_parallel_for_static(0, N, grain, add, &factor);
    check("static", 3);
  }
  trax_parallel_for(5, 5, 1, add, &factor);
  trax_parallel_for(0, N, 50, inside, &factor);
  check("inside", 3);
  trax_parallel_for(0, 64, 1, second, NULL);
  for (int i = 0; i < 64; i++)
    wrong += deepest[i] != 6 + 328350;
  trax_run_tasks(many_wait, NULL);

  unsigned long long total = 0;
  printf("%d", trax_parallel_reduce(10, N, sum, NULL, &total, sizeof total, plus));
  printf(" %llu\n", total);

  barrier.count = trax_parallel(nothing, NULL);
  trax_parallel(neighbours, NULL);
  static unsigned depth = 6;
  trax_run_tasks(task, &depth);
  printf("%u wrong, %u leaves\n", wrong, leaves);
  void *scratch = trax_scratch(100);
  printf("%d %u %u\n", scratch && trax_scratch(50) == scratch, trax_team_size(), trax_team_rank());
  return 0;
}
