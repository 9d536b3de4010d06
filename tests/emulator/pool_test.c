/* The pool of host threads (trax/pool.h): all work is done once a round, rounds are finished in order, and who waits
 * for long sleeps. */
#define _POSIX_C_SOURCE 200809L
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "trax/pool.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { MOST_ITEMS = 64, ROUNDS = 300, THREADS = 4 };

static void count(void *context, uint32_t item) {
  atomic_uint *counts = context;
  atomic_fetch_add(&counts[item], 1);
}

static struct trax_pool *create_pool(unsigned threads, uint32_t items, void (*work)(void *context, uint32_t item),
                                     void *context, unsigned *job) {
  struct trax_pool *pool = trax_pool_create(threads, NULL);
  assert_non_null(pool);
  assert_int_equal(trax_pool_threads(pool), threads);
  assert_int_equal(trax_pool_add(pool, items, work, context, job, NULL), TRAX_OK);
  return pool;
}

static void every_item_once(void **state) {
  (void)state;
  for (unsigned threads = 1; threads <= 5; threads++)
    for (uint32_t items = 1; items <= MOST_ITEMS; items = 3 * items + 1) {
      atomic_uint counts[MOST_ITEMS] = {0};
      unsigned job;
      struct trax_pool *pool = create_pool(threads, items, count, counts, &job);
      for (unsigned round = 1; round <= ROUNDS; round++) {
        trax_pool_run(pool, job);
        for (uint32_t item = 0; item < items; item++)
          assert_int_equal(atomic_load(&counts[item]), round);
      }
      trax_pool_destroy(pool);
    }
}

struct rounds {
  uint32_t items;
  atomic_uint counts[MOST_ITEMS], finished, errors;
};

/* An item is at most one round ahead of the first one that is not finished, and does not skip any. */
static void count_round(void *context, uint32_t item, unsigned round) {
  struct rounds *rounds = context;
  if (item == round % 37) /* so that others are ahead */
    sched_yield();
  rounds->errors += atomic_fetch_add(&rounds->counts[item], 1) != round || round > atomic_load(&rounds->finished) + 1;
}

static void finish_round(void *context, unsigned round) {
  struct rounds *rounds = context;
  for (uint32_t item = 0; item < rounds->items; item++)
    rounds->errors += atomic_load(&rounds->counts[item]) <= round;
  rounds->errors += atomic_fetch_add(&rounds->finished, 1) != round;
}

static void finishes_rounds_in_order(void **state) {
  (void)state;
  for (unsigned threads = 1; threads <= 3; threads++)
    for (uint32_t items = 1; items <= MOST_ITEMS; items = 5 * items + 1) {
      struct rounds rounds = {.items = items};
      unsigned job;
      struct trax_pool *pool = create_pool(threads, items, count, &rounds, &job);
      trax_pool_run_rounds(pool, job, ROUNDS, count_round, finish_round);
      assert_int_equal(rounds.finished, ROUNDS);
      assert_int_equal(rounds.errors, 0);
      trax_pool_destroy(pool);
    }
}

/* Jobs of different numbers of items, in turns that repeat and skip. Late threads of a round do not take items of the
   next one, be it of another job. */
static void jobs_in_turns(void **state) {
  (void)state;
  static const uint32_t items[] = {3, MOST_ITEMS, 1, 17};
  for (unsigned threads = 1; threads <= 5; threads++) {
    atomic_uint counts[4][MOST_ITEMS] = {0};
    unsigned jobs[4], rounds[4] = {0};
    struct trax_pool *pool = trax_pool_create(threads, NULL);
    assert_non_null(pool);
    for (unsigned i = 0; i < 2; i++)
      assert_int_equal(trax_pool_add(pool, items[i], count, counts[i], &jobs[i], NULL), TRAX_OK);
    for (unsigned i = 0; i < 2; i++)
      trax_pool_run(pool, jobs[i]), rounds[i]++;
    for (unsigned i = 2; i < 4; i++) /* between rounds */
      assert_int_equal(trax_pool_add(pool, items[i], count, counts[i], &jobs[i], NULL), TRAX_OK);
    for (unsigned round = 0; round < ROUNDS; round++) {
      const unsigned i = round * round / 3 % 4;
      trax_pool_run(pool, jobs[i]);
      rounds[i]++;
      for (unsigned k = 0; k < 4; k++)
        for (uint32_t item = 0; item < MOST_ITEMS; item++)
          assert_int_equal(atomic_load(&counts[k][item]), item < items[k] ? rounds[k] : 0);
    }
    trax_pool_destroy(pool);
  }
}

/* How many threads of this process sleep: the third field of their stat, behind a name in brackets. */
static unsigned sleepers(void) {
  unsigned asleep = 0;
  DIR *tasks = opendir("/proc/self/task");
  assert_non_null(tasks);
  for (const struct dirent *entry; (entry = readdir(tasks));) {
    char path[300], text[256] = "";
    snprintf(path, sizeof path, "/proc/self/task/%s/stat", entry->d_name);
    FILE *file = entry->d_name[0] == '.' ? NULL : fopen(path, "r");
    if (!file)
      continue;
    const char *name_end = fgets(text, sizeof text, file) ? strrchr(text, ')') : NULL;
    asleep += name_end && name_end[1] && name_end[2] == 'S';
    fclose(file);
  }
  closedir(tasks);
  return asleep;
}

static const struct timespec nap = {.tv_nsec = 10000000};

/* The work of one item goes on until all other threads sleep, for a minute at most. */
static void wait_for_sleepers(void *context, uint32_t item) {
  unsigned *asleep = context;
  for (unsigned i = 0; item == THREADS - 1 && (*asleep = sleepers()) < THREADS - 1 && i < 6000; i++)
    nanosleep(&nap, NULL);
}

static void sleeps_while_waiting(void **state) {
  (void)state;
  unsigned asleep = 0;
  unsigned job;
  struct trax_pool *pool = create_pool(THREADS, THREADS, wait_for_sleepers, &asleep, &job);
  for (unsigned i = 0; i < 3; i++) {
    trax_pool_run(pool, job);
    assert_int_equal(asleep, THREADS - 1);
  }
  trax_pool_destroy(pool);
}

static double processor_seconds(void) {
  struct timespec time;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* Between rounds, as when a debugger has stopped the run, threads take no time of the processors, be there more of them
   than of those. */
static void idles_without_cost(void **state) {
  (void)state;
  const struct timespec long_nap = {.tv_nsec = 400000000};
  for (unsigned threads = 2; threads <= 32; threads *= 4) {
    atomic_uint counts[MOST_ITEMS] = {0};
    unsigned job;
    struct trax_pool *pool = create_pool(threads, MOST_ITEMS, count, counts, &job);
    for (unsigned i = 0; i < 2; i++) {
      trax_pool_run(pool, job);
      for (unsigned j = 0; sleepers() < threads - 1 && j < 500; j++) /* on a busy host it takes a while */
        nanosleep(&nap, NULL);
      const double before = processor_seconds();
      nanosleep(&long_nap, NULL);
      const double used = processor_seconds() - before;
      if (used > 0.02)
        fail_msg("%u threads took %g s of the processors while there was nothing to do", threads, used);
    }
    trax_pool_destroy(pool);
  }
}

static unsigned startable = UINT_MAX, joined; /* number of threads that the host lets start, and of those that ended */

int __real_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *argument);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *argument);
int __real_pthread_join(pthread_t thread, void **result);
int __wrap_pthread_join(pthread_t thread, void **result);

int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *argument) {
  return startable && startable-- ? __real_pthread_create(thread, attributes, run, argument) : EAGAIN;
}

int __wrap_pthread_join(pthread_t thread, void **result) {
  joined++;
  return __real_pthread_join(thread, result);
}

/* If the host has no more threads, those that were started end. */
static void refuses_without_threads(void **state) {
  (void)state;
  for (unsigned most = 0; most < THREADS - 1; most++) {
    trax_error error;
    startable = most;
    joined = 0;
    assert_null(trax_pool_create(THREADS, &error));
    assert_string_equal(error.message, "cannot start a thread of the host");
    assert_int_equal(joined, most);
  }
  startable = UINT_MAX;
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_item_once),    cmocka_unit_test(finishes_rounds_in_order),
                                     cmocka_unit_test(jobs_in_turns),      cmocka_unit_test(sleeps_while_waiting),
                                     cmocka_unit_test(idles_without_cost), cmocka_unit_test(refuses_without_threads)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
