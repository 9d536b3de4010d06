#include "fast/quanta.h"

#include "fast/chip.h"
#include "fast/time/variant.h"
#include "trax/pool.h"

#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>

/* A thread that finds nothing to do spins for about as long as a quantum takes, and then yields the processor. It takes
   a TM of another thread only after some time, and keeps it, since its data come from that thread's caches. */
enum { STEAL_AFTER = 200 /* polls */, SPINS = 1000 };

enum { LEAST_QUANTUM = 8 /* cycles */ };

/* A TM in the epoch. */
struct progress {
  _Alignas(64) atomic_uint at; /* twice the number of its next quantum; + 1: a thread simulates it */
  atomic_uint thread;          /* that simulated it last; at first as the pool's items */
};

struct trax_quanta {
  struct trax_chip *chip;
  struct trax_merge *merge;
  unsigned threads;
  unsigned ahead;   /* quanta that may be simulated beyond the first one that has not been served */
  uint64_t latency; /* of ahead + 1 quanta */
  uint64_t begin, end;
  unsigned count;            /* of the epoch's quanta */
  struct progress *progress; /* [tms] */

  _Alignas(64) atomic_uint served; /* quanta */
  atomic_bool serving;
  _Alignas(64) atomic_uint complete[TRAX_SIDES]; /* TMs that have simulated a quantum which has not been served */
};

static uint64_t begin_of(const struct trax_quanta *quanta, unsigned quantum) {
  const uint64_t begin = quanta->begin + quantum * quanta->latency / (quanta->ahead + 1);
  return begin < quanta->end ? begin : quanta->end;
}

static unsigned side_of(const struct trax_quanta *quanta, unsigned quantum) {
  return quantum % (quanta->ahead + 1);
}

/* Returns the thread that has the TM at first: as in pool.c. */
static unsigned first_thread(const struct trax_quanta *quanta, uint32_t tm) {
  return (unsigned)((((uint64_t)tm + 1) * quanta->threads - 1) / quanta->chip->tms);
}

static void simulate(struct trax_quanta *quanta, struct trax_tm *tm, unsigned quantum) {
  const unsigned side = side_of(quanta, quantum);
  if (quantum == 0) {
    if (tm->next_cycle < quanta->begin)
      tm->next_cycle = quanta->begin;
    trax_merge_begin_tm(quanta->merge, tm);
  }
  trax_merge_give(quanta->merge, tm, side);
  quanta->chip->variant->run_quantum(tm, begin_of(quanta, quantum + 1));
  trax_merge_take(quanta->merge, tm);
  atomic_store(&quanta->progress[tm->number].at, 2 * (quantum + 1));
  atomic_fetch_add(&quanta->complete[side], 1);
}

/* Serves the first quantum that has not been served, if all TMs have simulated it and no other thread does so. */
static bool serve(struct trax_quanta *quanta) {
  const unsigned tms = quanta->chip->tms, quantum = atomic_load(&quanta->served), side = side_of(quanta, quantum);
  if (atomic_load(&quanta->complete[side]) != tms || atomic_exchange(&quanta->serving, true))
    return false;
  const bool found = atomic_load(&quanta->served) == quantum; /* no other thread has done so meanwhile */
  if (found) {
    trax_merge_quantum(quanta->merge, side, begin_of(quanta, quantum), begin_of(quanta, quantum + 1));
    atomic_store(&quanta->complete[side], 0);
    atomic_store(&quanta->served, quantum + 1);
  }
  atomic_store(&quanta->serving, false);
  return found;
}

/* Takes a TM of the thread whose next quantum may begin, an earlier quantum first, and searches from *last on. `any`:
   of any thread. NULL: there is none. */
static struct trax_tm *take(struct trax_quanta *quanta, unsigned thread, bool any, uint32_t *last) {
  const unsigned served = atomic_load(&quanta->served);
  for (unsigned quantum = served; quantum <= served + quanta->ahead && quantum < quanta->count; quantum++)
    for (uint32_t i = 0; i < quanta->chip->tms; i++) {
      const uint32_t number = (*last + i) % quanta->chip->tms;
      struct progress *const progress = &quanta->progress[number];
      unsigned expected = 2 * quantum;
      if (atomic_load_explicit(&progress->at, memory_order_relaxed) == expected &&
          (any || atomic_load_explicit(&progress->thread, memory_order_relaxed) == thread) &&
          atomic_compare_exchange_strong(&progress->at, &expected, expected + 1)) {
        atomic_store_explicit(&progress->thread, thread, memory_order_relaxed);
        *last = number;
        return &quanta->chip->tm[number];
      }
    }
  return NULL;
}

void trax_quanta_run(struct trax_quanta *quanta, uint32_t first) {
  const unsigned thread = first_thread(quanta, first);
  uint32_t last = first;
  for (unsigned polls = 0; atomic_load(&quanta->served) < quanta->count && !trax_merge_has_failed(quanta->merge);) {
    struct trax_tm *tm = NULL;
    if (serve(quanta) || (tm = take(quanta, thread, polls >= STEAL_AFTER, &last))) {
      if (tm)
        simulate(quanta, tm, atomic_load_explicit(&quanta->progress[tm->number].at, memory_order_relaxed) / 2);
      polls = 0;
    } else if (polls++ < SPINS) {
      trax_pause();
    } else {
      sched_yield();
    }
  }
}

void trax_quanta_begin(struct trax_quanta *quanta, uint64_t begin, uint64_t end) {
  quanta->begin = begin;
  quanta->end = end;
  for (quanta->count = 0; begin_of(quanta, quanta->count) < end;)
    quanta->count++;
  for (uint32_t i = 0; i < quanta->chip->tms; i++)
    atomic_store_explicit(&quanta->progress[i].at, 0, memory_order_relaxed);
  for (unsigned side = 0; side < TRAX_SIDES; side++)
    atomic_store_explicit(&quanta->complete[side], 0, memory_order_relaxed);
  atomic_store_explicit(&quanta->serving, false, memory_order_relaxed);
  atomic_store_explicit(&quanta->served, 0, memory_order_relaxed);
}

struct trax_quanta *trax_quanta_create(struct trax_chip *chip, struct trax_merge *merge, unsigned threads,
                                       uint64_t latency) {
  struct trax_quanta *quanta = aligned_alloc(64, sizeof *quanta);
  struct progress *progress = aligned_alloc(64, chip->tms * sizeof *progress);
  if (!quanta || !progress) {
    free(quanta);
    free(progress);
    return NULL;
  }
  const unsigned ahead = threads > 1 && latency >= TRAX_SIDES * LEAST_QUANTUM ? TRAX_SIDES - 1 : 0;
  *quanta = (struct trax_quanta){
      .chip = chip, .merge = merge, .threads = threads, .ahead = ahead, .latency = latency, .progress = progress};
  for (uint32_t i = 0; i < chip->tms; i++)
    atomic_init(&progress[i].thread, first_thread(quanta, i));
  return quanta;
}

void trax_quanta_destroy(struct trax_quanta *quanta) {
  if (quanta)
    free(quanta->progress);
  free(quanta);
}
