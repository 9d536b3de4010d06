/* The common part of the litmus tests: RUNS runs of ROLES roles each, on fresh locations, many at once on a machine
   of many threads. A test defines ROLES, before this file, and after it `part`, a role's work in a run, and `outcome`,
   a run's result. It prints how many outcomes no order allowed (`weak`) and how many no machine of docs/isa.md gives,
   fences or not (`broken`).

   With RELAXED all orders are relaxed and there are no fences: then weak outcomes must come. */
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <trax.h>

#ifndef RUNS
#define RUNS 1000
#endif

#ifdef RELAXED
enum { ACQUIRE, RELEASE = 0, ACQ_REL = 0, SEQ_CST = 0 };
#define FENCE(ORDER) ((void)0)
#else
enum {
  ACQUIRE = memory_order_acquire,
  RELEASE = memory_order_release,
  ACQ_REL = memory_order_acq_rel,
  SEQ_CST = memory_order_seq_cst
};
#define FENCE(ORDER) atomic_thread_fence(ORDER)
#endif
_Static_assert(memory_order_relaxed == 0, "what RELAXED makes of all orders");

#define LOAD(OBJECT, ORDER) atomic_load_explicit(&(OBJECT), (memory_order)(ORDER))
#define STORE(OBJECT, VALUE, ORDER) atomic_store_explicit(&(OBJECT), VALUE, (memory_order)(ORDER))

/* Data that atomics protect, and a word of its line that nobody writes: to read it brings the line into the TM's cache.
 */
struct data {
  _Alignas(64) volatile unsigned value;
  volatile unsigned beside;
};
struct shared {
  _Alignas(64) _Atomic unsigned word;
};
/* A role's observations; always read and written as atomic words. */
struct seen {
  _Alignas(64) _Atomic unsigned word[ROLES][2];
};
static struct seen seen[RUNS];

#define SEE(RUN, ROLE, NUMBER, VALUE) atomic_store_explicit(&seen[RUN].word[ROLE][NUMBER], VALUE, memory_order_relaxed)
#define SAW(RUN, ROLE, NUMBER) atomic_load_explicit(&seen[RUN].word[ROLE][NUMBER], memory_order_relaxed)

enum outcome { ALLOWED, WEAK, BROKEN };
static void part(unsigned role, unsigned run);
static enum outcome outcome(unsigned run);

/* A ticket lock for each run, and for those whose test is about something else one with all orders. */
struct ticket {
  _Alignas(64) _Atomic unsigned next, serving;
};
#define TAKE(TICKET, ORDER)                                                                                            \
  do {                                                                                                                 \
    const unsigned number = atomic_fetch_add_explicit(&(TICKET).next, 1, memory_order_relaxed);                        \
    while (LOAD((TICKET).serving, ORDER) != number)                                                                    \
      ;                                                                                                                \
  } while (0)
#define GIVE(TICKET, ORDER) STORE((TICKET).serving, LOAD((TICKET).serving, memory_order_relaxed) + 1, ORDER)

static _Atomic unsigned arrived;

/* All threads come to the next round. */
static void meet(unsigned round) {
  atomic_fetch_add(&arrived, 1);
  while (atomic_load(&arrived) < (round + 1) * trax_threads())
    ;
}

/* Between an access and the first use of its result: the machine may perform it late. */
static void wait(unsigned turns) {
  for (volatile unsigned i = 0; i < turns; i++)
    ;
}

int main(void) {
  const unsigned threads = trax_threads(), self = trax_thread();
  const unsigned groups = threads < ROLES ? 1 : threads / ROLES; /* runs of a round */
  unsigned random = self * 2654435761u + 1, round = 0;
  for (; round * groups < RUNS; round++) {
    meet(round);
    const bool within_tms = round % 2; /* else the roles of a run are far apart */
    for (unsigned t = self; t < groups * ROLES; t += threads) {
      const unsigned run = round * groups + (within_tms ? t / ROLES : t % groups);
      random ^= random << 13;
      random ^= random >> 17;
      random ^= random << 5;
      wait(random % 4);
      if (run < RUNS)
        part(within_tms ? t % ROLES : t / groups, run);
    }
  }
  meet(round);
  if (self)
    return 0;
  wait(1000); /* all stores are in memory, fences or not */
  unsigned count[3] = {0, 0, 0};
  for (unsigned run = 0; run < RUNS; run++)
    count[outcome(run)]++;
  printf("%u runs: %u weak, %u broken\n", (unsigned)RUNS, count[WEAK], count[BROKEN]);
  return 0;
}
