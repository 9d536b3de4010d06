#define _GNU_SOURCE
#include "trax/pool.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>

/* A round takes some 10 microseconds. A thread that finds nothing to do spins for about as long, then yields the
   processor, and sleeps in the end. It takes an item of another thread only after some time, and keeps it, since the
   item's data come from that thread's caches. */
enum { STEAL_AFTER = 200 /* polls */, SPINS = 2000, YIELDS = 200 };

struct item {
  _Alignas(64) atomic_uint at; /* twice the number of its next round; + 1: a thread processes it */
  atomic_uint thread;          /* that processed it last; at first they are shared out evenly */
};

struct worker {
  struct trax_pool *pool;
  pthread_t thread;
  unsigned number; /* 0 is the owner */
};

struct trax_pool {
  void (*work)(void *context, uint32_t item);
  void *context;
  uint32_t items;
  unsigned threads;      /* the owner included */
  unsigned running;      /* number of workers that were started */
  struct worker *worker; /* [threads - 1] */
  struct item *item;     /* [items] */

  /* The call that runs: its first round, and its functions if they are not `work` alone. A thread reads them while it
     has an item, or finishes a round. */
  unsigned begin;
  void (*work_at)(void *context, uint32_t item, unsigned round);
  void (*finish)(void *context, unsigned round);

  _Alignas(64) atomic_uint end;      /* rounds of all calls so far, modulo 2^32 */
  atomic_bool closes;                /* the workers end */
  _Alignas(64) atomic_uint finished; /* rounds */
  atomic_bool finishing;
  _Alignas(64) atomic_uint complete[2]; /* items that are done in an even or odd round that is not finished */
  _Alignas(64) atomic_uint sleepers;
  pthread_mutex_t mutex;
  pthread_cond_t changed;
};

/* To be called after a change of `end`, `finished` or `closes`. */
static void wake(struct trax_pool *pool) {
  if (atomic_load(&pool->sleepers)) {
    pthread_mutex_lock(&pool->mutex);
    pthread_cond_broadcast(&pool->changed);
    pthread_mutex_unlock(&pool->mutex);
  }
}

static void sleep_until_change(struct trax_pool *pool, unsigned finished, unsigned end) {
  pthread_mutex_lock(&pool->mutex);
  atomic_fetch_add(&pool->sleepers, 1);
  while (atomic_load(&pool->finished) == finished && atomic_load(&pool->end) == end && !atomic_load(&pool->closes))
    pthread_cond_wait(&pool->changed, &pool->mutex);
  atomic_fetch_sub(&pool->sleepers, 1);
  pthread_mutex_unlock(&pool->mutex);
}

/* Finishes the first round that is not, if all items are done and no other thread does so. */
static bool finish(struct trax_pool *pool, unsigned round) {
  if (atomic_load(&pool->complete[round % 2]) != pool->items || atomic_exchange(&pool->finishing, true))
    return false;
  const bool found = atomic_load(&pool->finished) == round; /* no other thread has done so meanwhile */
  if (found) {
    if (pool->finish)
      pool->finish(pool->context, round - pool->begin);
    atomic_store(&pool->complete[round % 2], 0);
    atomic_store(&pool->finished, round + 1);
    wake(pool);
  }
  atomic_store(&pool->finishing, false);
  return found;
}

/* Processes an item of the thread, an earlier round first, and searches from *last on. `any`: of any thread. False:
   there is none. */
static bool process(struct trax_pool *pool, unsigned thread, bool any, unsigned finished, unsigned end,
                    uint32_t *last) {
  for (unsigned round = finished; round != end && round - finished <= 1; round++)
    for (uint32_t i = 0; i < pool->items; i++) {
      const uint32_t number = (*last + i) % pool->items;
      struct item *const item = &pool->item[number];
      unsigned expected = 2 * round;
      if (atomic_load_explicit(&item->at, memory_order_relaxed) == expected &&
          (any || atomic_load_explicit(&item->thread, memory_order_relaxed) == thread) &&
          atomic_compare_exchange_strong(&item->at, &expected, expected + 1)) {
        atomic_store_explicit(&item->thread, thread, memory_order_relaxed);
        *last = number;
        if (pool->work_at)
          pool->work_at(pool->context, number, round - pool->begin);
        else
          pool->work(pool->context, number);
        atomic_store(&item->at, 2 * (round + 1));
        atomic_fetch_add(&pool->complete[round % 2], 1);
        return true;
      }
    }
  return false;
}

/* Works until the call that runs is over; a worker until the pool is destroyed. */
static void work(struct trax_pool *pool, unsigned thread) {
  unsigned call = 0; /* its `end` */
  uint32_t last = 0;
  for (unsigned polls = 0;;) {
    const unsigned finished = atomic_load(&pool->finished), end = atomic_load(&pool->end);
    if (thread ? atomic_load(&pool->closes) : finished == end)
      return;
    if (end != call) { /* items may wait for earlier ones */
      call = end;
      last = polls = 0;
    }
    if (finished != end &&
        (finish(pool, finished) || process(pool, thread, polls >= STEAL_AFTER, finished, end, &last)))
      polls = 0;
    else if (++polls < SPINS)
      trax_pause();
    else if (polls < SPINS + YIELDS)
      sched_yield();
    else
      sleep_until_change(pool, finished, end);
  }
}

static void *run_worker(void *argument) {
  const struct worker *worker = argument;
  work(worker->pool, worker->number);
  return NULL;
}

void trax_pool_run_rounds(struct trax_pool *pool, unsigned rounds,
                          void (*work_at)(void *context, uint32_t item, unsigned round),
                          void (*finish_round)(void *context, unsigned round)) {
  pool->begin = atomic_load(&pool->end);
  pool->work_at = work_at;
  pool->finish = finish_round;
  atomic_store(&pool->end, pool->begin + rounds);
  wake(pool);
  work(pool, 0);
}

void trax_pool_run(struct trax_pool *pool) {
  trax_pool_run_rounds(pool, 1, NULL, NULL);
}

struct trax_pool *trax_pool_create(unsigned threads, uint32_t items, void (*work)(void *context, uint32_t item),
                                   void *context, trax_error *error) {
  struct trax_pool *pool = aligned_alloc(64, sizeof *pool);
  if (pool)
    *pool = (struct trax_pool){.work = work, .context = context, .items = items, .threads = threads};
  if (!pool || !(pool->worker = calloc(threads, sizeof *pool->worker)) ||
      !(pool->item = aligned_alloc(_Alignof(struct item), items * sizeof *pool->item))) {
    trax_fail(error, "out of memory");
    if (pool)
      free(pool->worker);
    free(pool);
    return NULL;
  }
  for (uint32_t i = 0; i < items; i++) {
    atomic_init(&pool->item[i].at, 0);
    atomic_init(&pool->item[i].thread, (unsigned)((uint64_t)i * threads / items));
  }
  pthread_mutex_init(&pool->mutex, NULL);
  pthread_cond_init(&pool->changed, NULL);
  for (; pool->running + 1 < threads; pool->running++) {
    struct worker *worker = &pool->worker[pool->running];
    *worker = (struct worker){.pool = pool, .number = pool->running + 1};
    if (pthread_create(&worker->thread, NULL, run_worker, worker)) {
      trax_fail(error, "cannot start a thread of the host");
      trax_pool_destroy(pool);
      return NULL;
    }
  }
  return pool;
}

void trax_pool_destroy(struct trax_pool *pool) {
  if (!pool)
    return;
  atomic_store(&pool->closes, true);
  wake(pool);
  for (unsigned i = 0; i < pool->running; i++)
    pthread_join(pool->worker[i].thread, NULL);
  pthread_cond_destroy(&pool->changed);
  pthread_mutex_destroy(&pool->mutex);
  free(pool->item);
  free(pool->worker);
  free(pool);
}
