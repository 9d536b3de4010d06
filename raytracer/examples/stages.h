/* Stages, for steps 9 and 10: all threads finish one before any thread begins the next. A counting sort of stages. */
#ifndef TRAX_EXAMPLES_STAGES_H
#define TRAX_EXAMPLES_STAGES_H

#include <stdbool.h>
#include <trax.h>

#ifndef QUEUES
#define QUEUES 4 /* as many as the chip has TMs */
#endif
#ifndef TILE_BITS
#define TILE_BITS 10 /* of the numbers that the threads of a TM take one after the other */
#endif
#define MOST_THREADS 4096u

static unsigned arrived, taken[3][QUEUES], sums[MOST_THREADS];

/* Waits for all threads, and makes their stores visible. Pauses double, since polls take bandwidth from threads that
   still work. `stage` counts barriers. The counters of the next stage are cleared. */
static __attribute__((noinline)) void barrier(unsigned *stage) {
  const unsigned goal = ++*stage * trax_threads();
  __atomic_thread_fence(__ATOMIC_RELEASE);
  trax_atomic_inc(&arrived);
  for (unsigned pause = 1; __atomic_load_n(&arrived, __ATOMIC_RELAXED) < goal; pause += pause < 64 ? pause : 0)
    for (unsigned i = 0; i < pause; i++)
      __asm__ volatile("");
  __atomic_thread_fence(__ATOMIC_ACQUIRE);
  for (unsigned queue = trax_thread(); queue < QUEUES; queue += trax_threads())
    taken[(*stage + 1) % 3][queue] = 0;
}

/* Takes a number below `count`. A TM owns every QUEUES-th tile of numbers. When its tiles are done it helps the next
   TM. */
static inline bool take(unsigned stage, unsigned count, unsigned *turn, unsigned *index) {
  for (; *turn < QUEUES; ++*turn) {
    unsigned queue = (trax_tm() + *turn) % QUEUES, number = trax_atomic_inc(&taken[stage % 3][queue]);
    *index = ((number >> TILE_BITS) * QUEUES + queue) << TILE_BITS | (number & ((1u << TILE_BITS) - 1));
    if (*index < count)
      return true;
  }
  return false;
}

/* Distributes the numbers below `count` over all threads. Allowed once in a stage. */
#define FOR_ALL(i, stage, count) for (unsigned turn = 0, i; take(stage, count, &turn, &i);)

/* Replaces each of `size` counts by the sum of those before it (an exclusive prefix sum), in two stages: each thread
   sums a part, then adds the sums of the threads before it. It also clears its part of `next`. */
static __attribute__((noinline)) void sum_counts(unsigned *counts, unsigned *next, unsigned size, unsigned *stage) {
  unsigned part = size / trax_threads() + 1, begin = part * trax_thread(), sum = 0;
  unsigned end = begin + part < size ? begin + part : size;
  for (unsigned i = begin; i < end; i++)
    sum += counts[i];
  sums[trax_thread()] = sum;
  barrier(stage);
  sum = 0;
  for (unsigned thread = 0; thread < trax_thread(); thread++)
    sum += sums[thread];
  for (unsigned i = begin; i < end; i++) {
    unsigned count = counts[i];
    counts[i] = sum;
    next[i] = 0;
    sum += count;
  }
  barrier(stage);
}

static inline void check_threads(void) {
  if (trax_threads() > MOST_THREADS)
    trax_abort("this program runs on 4096 threads at most");
}

#endif
