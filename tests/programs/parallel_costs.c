/* Costs in cycles of work for all threads, beside the same written by hand (docs/parallel.md). */
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <trax.h>
#include <trax/parallel.h>

enum { ROUNDS = 20, ITEMS = 8192, SLOTS = 16, BLOCKS = 1000 };
static unsigned next, values[ITEMS];
static atomic_uint arrived;

static void nothing(void *context) {
  (void)context;
}

static void barriers(void *context) {
  (void)context;
  for (int i = 0; i < ROUNDS; i++)
    trax_team_barrier();
}

static void barriers_by_hand(void *context) {
  (void)context;
  for (unsigned i = 1; i <= ROUNDS; i++) {
    atomic_fetch_add(&arrived, 1);
    while (atomic_load_explicit(&arrived, memory_order_relaxed) < i * trax_team_size())
      ;
    atomic_thread_fence(memory_order_acquire);
  }
}

static void item(unsigned i) {
  values[i] = i * 3 + 1;
}

static void items(unsigned begin, unsigned end, void *context) {
  (void)context;
  for (unsigned i = begin; i < end; i++)
    item(i);
}

static void items_by_hand(void *context) {
  (void)context;
  for (unsigned i; (i = trax_atomic_inc(&next)) < ITEMS;)
    item(i);
}

static void sum(unsigned begin, unsigned end, void *context, void *result) {
  (void)context;
  for (unsigned i = begin; i < end; i++)
    *(unsigned *)result += values[i];
}

static void plus(void *result, const void *part) {
  *(unsigned *)result += *(const unsigned *)part;
}

static void task(void *context) {
  if (context)
    for (int i = 0; i < 200; i++)
      trax_add_task(task, NULL);
}

/* Each thread keeps 16 blocks of 1 to 128 bytes, and replaces one of them at random. */
static void blocks(void *context) {
  (void)context;
  static _Thread_local void *slots[SLOTS]; /* in local memory, since the heap is measured, not the stack */
  unsigned x = trax_team_rank() * 77 + 1;
  for (int i = 0; i < BLOCKS; i++) {
    x = x * 1664525 + 1013904223;
    void **slot = &slots[x >> 8 & (SLOTS - 1)];
    free(*slot);
    *slot = malloc(1 + (x >> 25));
  }
  for (int i = 0; i < SLOTS; i++) {
    free(slots[i]);
    slots[i] = NULL;
  }
}

/* On one thread: so many blocks, every second one freed and made again, all freed. */
static void many_blocks(unsigned count) {
  static void *block[8000];
  for (unsigned i = 0; i < count; i++)
    block[i] = malloc(16 + i * 37 % 100);
  for (unsigned i = 0; i < count; i += 2)
    free(block[i]);
  for (unsigned i = 0; i < count; i += 2)
    block[i] = malloc(16 + i * 53 % 100);
  for (unsigned i = 0; i < count; i++)
    free(block[i]);
}

static void omp_static(void) {
#pragma omp parallel for
  for (unsigned i = 0; i < ITEMS; i++)
    item(i);
}

static void omp_dynamic(void) {
#pragma omp parallel for schedule(dynamic)
  for (unsigned i = 0; i < ITEMS; i++)
    item(i);
}

static unsigned omp_sum(void) {
  unsigned total = 0;
#pragma omp parallel for reduction(+ : total)
  for (unsigned i = 0; i < ITEMS; i++)
    total += values[i];
  return total;
}

#define COST(WHAT, NUMBER, STATEMENT)                                                                                  \
  do {                                                                                                                 \
    const unsigned start = trax_cycles();                                                                              \
    STATEMENT;                                                                                                         \
    printf("%s|%u\n", WHAT, (trax_cycles() - start + (NUMBER) / 2) / (NUMBER));                                        \
  } while (0)

int main(void) {
  trax_parallel(nothing, NULL);
  unsigned total = 0;
  trax_parallel(barriers, NULL);
  trax_parallel(blocks, NULL);
  COST("trax_parallel, nothing to do", 1, trax_parallel(nothing, NULL));
  COST("trax_team_barrier", ROUNDS, trax_parallel(barriers, NULL));
  COST("a barrier by hand", ROUNDS, trax_parallel(barriers_by_hand, NULL));
  COST("trax_parallel_for, grain 1, an item", ITEMS, trax_parallel_for(0, ITEMS, 1, items, NULL));
  COST("the same by hand", ITEMS, trax_parallel(items_by_hand, NULL));
  COST("grain 16", ITEMS, trax_parallel_for(0, ITEMS, 16, items, NULL));
  COST("trax_parallel_for_static", ITEMS, trax_parallel_for_static(0, ITEMS, 0, items, NULL));
  COST("omp for schedule(static), an item", ITEMS, omp_static());
  COST("omp for schedule(dynamic), an item", ITEMS, omp_dynamic());
  COST("trax_parallel_reduce, all", 1, trax_parallel_reduce(0, ITEMS, sum, NULL, &total, sizeof total, plus));
  COST("omp for reduction, all", 1, total += omp_sum());
  COST("a task", 200, trax_run_tasks(task, &next));
  COST("1,000 pairs of malloc and free on each thread", 1, trax_parallel(blocks, NULL));
  COST("1,000 blocks on thread 0, each", 1000, many_blocks(1000));
  COST("8,000 blocks on thread 0, each", 8000, many_blocks(8000));
  return total == 0;
}
