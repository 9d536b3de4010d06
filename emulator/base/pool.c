#define _GNU_SOURCE
#include "trax/pool.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>

/* A round takes some 10 microseconds. A thread that waits, for a round or for its end, spins for about as long, then
   yields the processor, and sleeps in the end. It takes items of late threads only after some time, since it takes
   their data from their threads' caches. */
enum { STEAL_AFTER = 200 /* polls */, SPINS = 2000, YIELDS = 200 };

struct item {
  _Alignas(64) atomic_uint taken; /* the latest round in which a thread took it */
};

struct worker {
  struct trax_pool *pool;
  pthread_t thread;
  unsigned number;
};

struct trax_pool {
  void (*work)(void *context, uint32_t item);
  void *context;
  uint32_t items;
  unsigned threads;      /* the owner included */
  unsigned running;      /* number of workers that were started */
  unsigned target;       /* of `done` in the current round */
  struct worker *worker; /* [threads - 1] */

  _Alignas(64) atomic_uint round; /* the current round, an even number; odd: the workers end */
  _Alignas(64) atomic_uint done;  /* items finished in all rounds */
  struct item *item;              /* [items] */

  _Alignas(64) atomic_uint sleepers; /* number of sleeping workers */
  atomic_bool owner_sleeps;
  pthread_mutex_t mutex;
  pthread_cond_t wakened, finished;
};

static void wake_owner(struct trax_pool *pool) {
  pthread_mutex_lock(&pool->mutex);
  pthread_cond_signal(&pool->finished);
  pthread_mutex_unlock(&pool->mutex);
}

static void take_items(struct trax_pool *pool, uint32_t first, uint32_t end, unsigned round) {
  for (uint32_t i = first; i < end; i++) {
    unsigned before = round - 2;
    if (atomic_load_explicit(&pool->item[i].taken, memory_order_relaxed) == before &&
        atomic_compare_exchange_strong(&pool->item[i].taken, &before, round)) {
      pool->work(pool->context, i);
      atomic_fetch_add(&pool->done, 1);
      if (atomic_load(&pool->owner_sleeps))
        wake_owner(pool);
    }
  }
}

static void take_part(struct trax_pool *pool, unsigned number, unsigned round) {
  take_items(pool, (uint32_t)((uint64_t)pool->items * number / pool->threads),
             (uint32_t)((uint64_t)pool->items * (number + 1) / pool->threads), round);
}

static unsigned wait_for_round(struct trax_pool *pool, unsigned last) {
  unsigned round;
  for (unsigned i = 0; i < SPINS + YIELDS; i++) {
    if ((round = atomic_load(&pool->round)) != last)
      return round;
    if (i == STEAL_AFTER)
      take_items(pool, 0, pool->items, last);
    if (i < SPINS)
      trax_pause();
    else
      sched_yield();
  }
  pthread_mutex_lock(&pool->mutex);
  atomic_fetch_add(&pool->sleepers, 1);
  while ((round = atomic_load(&pool->round)) == last)
    pthread_cond_wait(&pool->wakened, &pool->mutex);
  atomic_fetch_sub(&pool->sleepers, 1);
  pthread_mutex_unlock(&pool->mutex);
  return round;
}

static void begin_round(struct trax_pool *pool, unsigned round) {
  atomic_store(&pool->round, round);
  if (atomic_load(&pool->sleepers)) {
    pthread_mutex_lock(&pool->mutex);
    pthread_cond_broadcast(&pool->wakened);
    pthread_mutex_unlock(&pool->mutex);
  }
}

static void *run_worker(void *argument) {
  const struct worker *worker = argument;
  unsigned round = 0;
  while (!((round = wait_for_round(worker->pool, round)) & 1))
    take_part(worker->pool, worker->number, round);
  return NULL;
}

void trax_pool_run(struct trax_pool *pool) {
  const unsigned round = atomic_load(&pool->round) + 2;
  pool->target += pool->items;
  begin_round(pool, round);
  take_part(pool, 0, round);
  for (unsigned i = 0; i < SPINS + YIELDS; i++) {
    if (atomic_load(&pool->done) == pool->target)
      return;
    if (i == STEAL_AFTER)
      take_items(pool, 0, pool->items, round);
    if (i < SPINS)
      trax_pause();
    else
      sched_yield();
  }
  pthread_mutex_lock(&pool->mutex);
  atomic_store(&pool->owner_sleeps, true);
  while (atomic_load(&pool->done) != pool->target)
    pthread_cond_wait(&pool->finished, &pool->mutex);
  atomic_store(&pool->owner_sleeps, false);
  pthread_mutex_unlock(&pool->mutex);
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
  for (uint32_t i = 0; i < items; i++)
    atomic_init(&pool->item[i].taken, 0);
  pthread_mutex_init(&pool->mutex, NULL);
  pthread_cond_init(&pool->wakened, NULL);
  pthread_cond_init(&pool->finished, NULL);
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
  begin_round(pool, atomic_load(&pool->round) + 1);
  for (unsigned i = 0; i < pool->running; i++)
    pthread_join(pool->worker[i].thread, NULL);
  pthread_cond_destroy(&pool->wakened);
  pthread_cond_destroy(&pool->finished);
  pthread_mutex_destroy(&pool->mutex);
  free(pool->item);
  free(pool->worker);
  free(pool);
}
