#define _GNU_SOURCE
#include "trax/pool.h"

#include <assert.h>
#include <limits.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>

/* A round takes some 10 microseconds. A thread that waits, for a round or for its end, spins for about as long, then
   yields the processor, and sleeps in the end. It takes items of late threads only after some time, since it takes
   their data from their threads' caches. */
enum { STEAL_AFTER = 200 /* polls */, SPINS = 2000, YIELDS = 200 };

enum { MOST_JOBS = 4 };

static const unsigned long long END = ULLONG_MAX; /* a round: the workers end */

struct item {
  _Alignas(64) atomic_ullong taken; /* the latest round in which a thread took it */
};

struct job {
  void (*work)(void *context, uint32_t item);
  void *context;
  uint32_t items;
  unsigned threads;  /* that have a part of the items */
  struct item *item; /* [items] */
};

struct worker {
  struct trax_pool *pool;
  pthread_t thread;
  unsigned number;
};

struct trax_pool {
  unsigned threads;           /* the owner included */
  unsigned running;           /* number of workers that were started */
  unsigned target;            /* of `done` in the current round */
  struct worker *worker;      /* [threads - 1] */
  struct job jobs[MOST_JOBS]; /* [job_count] */
  unsigned job_count;

  _Alignas(64) atomic_ullong round; /* the current round: MOST_JOBS times its number, from 1 on, + that of its job */
  _Alignas(64) atomic_uint done;    /* items finished in all rounds */

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

/* A late thread may ask for items of a round that is over: they were taken in it, or in a later one. */
static void take_items(struct trax_pool *pool, uint32_t first, uint32_t end, unsigned long long round) {
  const struct job *job = &pool->jobs[round % MOST_JOBS];
  for (uint32_t i = first; i < end; i++) {
    unsigned long long before = atomic_load_explicit(&job->item[i].taken, memory_order_relaxed);
    if (before < round && atomic_compare_exchange_strong(&job->item[i].taken, &before, round)) {
      job->work(job->context, i);
      atomic_fetch_add(&pool->done, 1);
      if (atomic_load(&pool->owner_sleeps))
        wake_owner(pool);
    }
  }
}

static void take_part(struct trax_pool *pool, unsigned number, unsigned long long round) {
  const struct job *job = &pool->jobs[round % MOST_JOBS];
  if (number < job->threads)
    take_items(pool, (uint32_t)((uint64_t)job->items * number / job->threads),
               (uint32_t)((uint64_t)job->items * (number + 1) / job->threads), round);
}

static void take_any(struct trax_pool *pool, unsigned long long round) {
  if (round)
    take_items(pool, 0, pool->jobs[round % MOST_JOBS].items, round);
}

static unsigned long long wait_for_round(struct trax_pool *pool, unsigned long long last) {
  unsigned long long round;
  for (unsigned i = 0; i < SPINS + YIELDS; i++) {
    if ((round = atomic_load(&pool->round)) != last)
      return round;
    if (i == STEAL_AFTER)
      take_any(pool, last);
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

static void begin_round(struct trax_pool *pool, unsigned long long round) {
  atomic_store(&pool->round, round);
  if (atomic_load(&pool->sleepers)) {
    pthread_mutex_lock(&pool->mutex);
    pthread_cond_broadcast(&pool->wakened);
    pthread_mutex_unlock(&pool->mutex);
  }
}

static void *run_worker(void *argument) {
  const struct worker *worker = argument;
  unsigned long long round = 0;
  while ((round = wait_for_round(worker->pool, round)) != END)
    take_part(worker->pool, worker->number, round);
  return NULL;
}

void trax_pool_run(struct trax_pool *pool, unsigned job) {
  const unsigned long long round = (atomic_load(&pool->round) / MOST_JOBS + 1) * MOST_JOBS + job;
  pool->target += pool->jobs[job].items;
  begin_round(pool, round);
  take_part(pool, 0, round);
  for (unsigned i = 0; i < SPINS + YIELDS; i++) {
    if (atomic_load(&pool->done) == pool->target)
      return;
    if (i == STEAL_AFTER)
      take_any(pool, round);
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

trax_status trax_pool_add(struct trax_pool *pool, uint32_t items, void (*work)(void *context, uint32_t item),
                          void *context, unsigned *job, trax_error *error) {
  assert(pool->job_count < MOST_JOBS);
  struct item *item = aligned_alloc(_Alignof(struct item), items * sizeof *item);
  if (!item)
    return trax_fail(error, "out of memory");
  for (uint32_t i = 0; i < items; i++)
    atomic_init(&item[i].taken, 0);
  *job = pool->job_count++;
  pool->jobs[*job] = (struct job){work, context, items, items < pool->threads ? items : pool->threads, item};
  return TRAX_OK;
}

unsigned trax_pool_threads(const struct trax_pool *pool) {
  return pool->threads;
}

struct trax_pool *trax_pool_create(unsigned threads, trax_error *error) {
  struct trax_pool *pool = aligned_alloc(64, sizeof *pool);
  if (pool)
    *pool = (struct trax_pool){.threads = threads};
  if (!pool || !(pool->worker = calloc(threads, sizeof *pool->worker))) {
    trax_fail(error, "out of memory");
    free(pool);
    return NULL;
  }
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
  begin_round(pool, END);
  for (unsigned i = 0; i < pool->running; i++)
    pthread_join(pool->worker[i].thread, NULL);
  pthread_cond_destroy(&pool->wakened);
  pthread_cond_destroy(&pool->finished);
  pthread_mutex_destroy(&pool->mutex);
  for (unsigned i = 0; i < pool->job_count; i++)
    free(pool->jobs[i].item);
  free(pool->worker);
  free(pool);
}
