#define _GNU_SOURCE
#include "trax/pool.h"

#include <assert.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>

/* A round takes some 10 microseconds. A thread that finds nothing to do spins for about as long, then yields the
   processor, and sleeps in the end. It takes an item of another thread only after some time, and keeps it, since the
   item's data come from that thread's caches. */
enum { STEAL_AFTER = 200 /* polls */, SPINS = 2000, YIELDS = 200 };

enum { MOST_JOBS = 4 };

struct item {
  _Alignas(64) atomic_uint at; /* twice the number of its next round; + 1: a thread processes it */
  atomic_uint thread;          /* that processed it last; at first they are shared out evenly */
};

struct job {
  void (*work)(void *context, uint32_t item);
  void *context;
  uint32_t items;
  struct item *item; /* [items] */

  /* The call that runs: its first round, and its functions if they are not `work` alone. A thread reads them while it
     has an item, or finishes a round. */
  unsigned begin;
  void (*work_at)(void *context, uint32_t item, unsigned round);
  void (*finish)(void *context, unsigned round);

  _Alignas(64) atomic_uint end;      /* rounds of all calls so far, modulo 2^32 */
  _Alignas(64) atomic_uint finished; /* rounds */
  atomic_bool finishing;
  _Alignas(64) atomic_uint complete[2]; /* items that are done in an even or odd round that is not finished */
};

struct worker {
  struct trax_pool *pool;
  pthread_t thread;
  unsigned number; /* 0 is the owner */
};

struct trax_pool {
  unsigned threads;           /* the owner included */
  unsigned running;           /* number of workers that were started */
  struct worker *worker;      /* [threads - 1] */
  struct job jobs[MOST_JOBS]; /* [job_count] */
  unsigned job_count;

  _Alignas(64) atomic_uint current; /* the job of the latest call */
  atomic_bool closes;               /* the workers end */
  _Alignas(64) atomic_uint sleepers;
  pthread_mutex_t mutex;
  pthread_cond_t changed;
};

/* What a thread sees of the latest call. */
struct view {
  unsigned job, finished, end;
};

static struct view look(struct trax_pool *pool) {
  const unsigned job = atomic_load(&pool->current);
  return (struct view){job, atomic_load(&pool->jobs[job].finished), atomic_load(&pool->jobs[job].end)};
}

/* To be called after a change of what a thread sees, or of `closes`. */
static void wake(struct trax_pool *pool) {
  if (atomic_load(&pool->sleepers)) {
    pthread_mutex_lock(&pool->mutex);
    pthread_cond_broadcast(&pool->changed);
    pthread_mutex_unlock(&pool->mutex);
  }
}

static void sleep_until_change(struct trax_pool *pool, struct view seen) {
  pthread_mutex_lock(&pool->mutex);
  atomic_fetch_add(&pool->sleepers, 1);
  for (struct view now = look(pool);
       now.job == seen.job && now.finished == seen.finished && now.end == seen.end && !atomic_load(&pool->closes);
       now = look(pool))
    pthread_cond_wait(&pool->changed, &pool->mutex);
  atomic_fetch_sub(&pool->sleepers, 1);
  pthread_mutex_unlock(&pool->mutex);
}

/* Finishes the first round that is not, if all items are done and no other thread does so. */
static bool finish(struct trax_pool *pool, struct job *job, unsigned round) {
  if (atomic_load(&job->complete[round % 2]) != job->items || atomic_exchange(&job->finishing, true))
    return false;
  const bool found = atomic_load(&job->finished) == round; /* no other thread has done so meanwhile */
  if (found) {
    if (job->finish)
      job->finish(job->context, round - job->begin);
    atomic_store(&job->complete[round % 2], 0);
    atomic_store(&job->finished, round + 1);
    wake(pool);
  }
  atomic_store(&job->finishing, false);
  return found;
}

/* Processes an item of the thread, an earlier round first, and searches from *last on. `any`: of any thread. False:
   there is none. */
static bool process(struct job *job, unsigned thread, bool any, struct view seen, uint32_t *last) {
  for (unsigned round = seen.finished; round != seen.end && round - seen.finished <= 1; round++)
    for (uint32_t i = 0; i < job->items; i++) {
      const uint32_t number = (*last + i) % job->items;
      struct item *const item = &job->item[number];
      unsigned expected = 2 * round;
      if (atomic_load_explicit(&item->at, memory_order_relaxed) == expected &&
          (any || atomic_load_explicit(&item->thread, memory_order_relaxed) == thread) &&
          atomic_compare_exchange_strong(&item->at, &expected, expected + 1)) {
        atomic_store_explicit(&item->thread, thread, memory_order_relaxed);
        *last = number;
        if (job->work_at)
          job->work_at(job->context, number, round - job->begin);
        else
          job->work(job->context, number);
        atomic_store(&item->at, 2 * (round + 1));
        atomic_fetch_add(&job->complete[round % 2], 1);
        return true;
      }
    }
  return false;
}

/* Works until the call that runs is over; a worker until the pool is destroyed. */
static void work(struct trax_pool *pool, unsigned thread) {
  struct view call = {0};
  uint32_t last = 0;
  for (unsigned polls = 0;;) {
    const struct view seen = look(pool);
    struct job *const job = &pool->jobs[seen.job];
    if (thread ? atomic_load(&pool->closes) : seen.finished == seen.end)
      return;
    if (seen.job != call.job || seen.end != call.end) { /* items may wait for earlier ones */
      call = seen;
      last = polls = 0;
    }
    if (seen.finished != seen.end &&
        (finish(pool, job, seen.finished) || process(job, thread, polls >= STEAL_AFTER, seen, &last)))
      polls = 0;
    else if (++polls < SPINS)
      trax_pause();
    else if (polls < SPINS + YIELDS)
      sched_yield();
    else
      sleep_until_change(pool, seen);
  }
}

static void *run_worker(void *argument) {
  const struct worker *worker = argument;
  work(worker->pool, worker->number);
  return NULL;
}

void trax_pool_run_rounds(struct trax_pool *pool, unsigned number, unsigned rounds,
                          void (*work_at)(void *context, uint32_t item, unsigned round),
                          void (*finish_round)(void *context, unsigned round)) {
  struct job *const job = &pool->jobs[number];
  job->begin = atomic_load(&job->end);
  job->work_at = work_at;
  job->finish = finish_round;
  atomic_store(&job->end, job->begin + rounds);
  atomic_store(&pool->current, number);
  wake(pool);
  work(pool, 0);
}

void trax_pool_run(struct trax_pool *pool, unsigned job) {
  trax_pool_run_rounds(pool, job, 1, NULL, NULL);
}

/* The rounds of a job that has not run are 0, and workers may read them already. */
trax_status trax_pool_add(struct trax_pool *pool, uint32_t items, void (*work)(void *context, uint32_t item),
                          void *context, unsigned *number, trax_error *error) {
  assert(pool->job_count < MOST_JOBS);
  struct job *const job = &pool->jobs[pool->job_count];
  if (!(job->item = aligned_alloc(_Alignof(struct item), items * sizeof *job->item)))
    return trax_fail(error, "out of memory");
  for (uint32_t i = 0; i < items; i++) {
    atomic_init(&job->item[i].at, 0);
    atomic_init(&job->item[i].thread, (unsigned)((uint64_t)i * pool->threads / items));
  }
  job->work = work;
  job->context = context;
  job->items = items;
  *number = pool->job_count++;
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
  pthread_cond_init(&pool->changed, NULL);
  for (; pool->running + 1 < threads; pool->running++) {
    struct worker *worker = &pool->worker[pool->running];
    *worker = (struct worker){.pool = pool, .number = pool->running + 1};
    if (pthread_create(&worker->thread, NULL, run_worker, worker) != 0) {
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
  for (unsigned i = 0; i < pool->job_count; i++)
    free(pool->jobs[i].item);
  free(pool->worker);
  free(pool);
}
