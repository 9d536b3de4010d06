// clang-format off
// RUN: %run_c %s %t --levels -O2 --also -O0 --cflags "-mstack=global" --simflags "--set chip.tms=2 --set chip.tps_per_tm=4 --main-on 0 --max-cycles 9000000"
// RUN: %trax_sim --set chip.tms=2 --set chip.tps_per_tm=4 --main-on 0 --check-races %t-O2 | diff %S/created_threads.expected -
// clang-format on
// C11's threads: creation, conditions, values of a thread, limits of time. (Expected output by hand.)
#include <stdio.h>
#include <stdlib.h>
#include <threads.h>
#include <time.h>
#include <trax.h>
#include <trax/parallel.h>

enum { ITEMS = 60 };
static mtx_t mutex;
static cnd_t filled, emptied;
static int queue[4], count, ended, sum;
static tss_t key;
static once_flag once = ONCE_FLAG_INIT;
static int made;

static void make(void) {
  made++;
}

static void destroy(void *value) {
  mtx_lock(&mutex);
  ended += *(int *)value;
  mtx_unlock(&mutex);
  free(value);
}

static int consume(void *argument) {
  int *own = malloc(sizeof *own), took = 0;
  *own = 1;
  tss_set(key, own);
  call_once(&once, make);
  for (;;) {
    mtx_lock(&mutex);
    while (count == 0)
      cnd_wait(&filled, &mutex);
    const int item = queue[--count];
    cnd_signal(&emptied);
    if (item >= 0)
      sum += item;
    mtx_unlock(&mutex);
    if (item < 0)
      break;
    took++;
  }
  if (tss_get(key) != own)
    return -1000;
  if (*(int *)argument)
    thrd_exit(took);
  return took;
}

static int get_mutex(void *argument) {
  struct timespec until;
  timespec_get(&until, TIME_UTC);
  until.tv_nsec += 20000;
  const int result = mtx_timedlock(argument, &until);
  if (result == thrd_success)
    mtx_unlock(argument);
  return result;
}

static int nothing(void *argument) {
  return argument != NULL;
}

static void count_up(unsigned begin, unsigned end, void *context, void *result) {
  (void)context;
  *(unsigned *)result += end - begin;
}

static void plus(void *result, const void *part) {
  *(unsigned *)result += *(const unsigned *)part;
}

/* Meanwhile the caller is alone. */
static int reduce_alone(void *argument) {
  (void)argument;
  unsigned sum = 0;
  trax_parallel_reduce(0, 1000, count_up, NULL, &sum, sizeof sum, plus);
  return (int)sum;
}

void __trax_wait(void);
extern unsigned __trax_waiting;

int main(void) {
  if (trax_thread() != 0) { /* a machine without --main-on 0 */
    __trax_wait();
    return 0;
  }
  __trax_waiting = trax_threads() - 1;
  static int leaves[3] = {0, 1, 0};
  thrd_t thread[3], many[16];
  mtx_init(&mutex, mtx_timed);
  cnd_init(&filled);
  cnd_init(&emptied);
  tss_create(&key, destroy);
  for (int i = 0; i < 3; i++)
    if (thrd_create(&thread[i], consume, &leaves[i]) != thrd_success)
      return 1; /* without --main-on 0 */
  for (int i = 1; i <= ITEMS + 3; i++) {
    mtx_lock(&mutex);
    while (count == 4)
      cnd_wait(&emptied, &mutex);
    queue[count++] = i <= ITEMS ? i : -1;
    cnd_broadcast(&filled);
    mtx_unlock(&mutex);
    if (i == ITEMS) { /* the last in, first out: the ends come after all items */
      mtx_lock(&mutex);
      while (count)
        cnd_wait(&emptied, &mutex);
      mtx_unlock(&mutex);
    }
  }
  int took = 0, result;
  for (int i = 0; i < 3; i++) {
    thrd_join(thread[i], &result);
    took += result;
  }
  printf("%d items, sum %d, ended %d, made %d\n", took, sum, ended, made);

  struct timespec until;
  timespec_get(&until, TIME_UTC);
  until.tv_nsec += 5000;
  mtx_lock(&mutex);
  thrd_create(&thread[0], get_mutex, &mutex);
  thrd_join(thread[0], &result);
  printf("%d %d\n", result == thrd_timedout, cnd_timedwait(&filled, &mutex, &until) == thrd_timedout);
  mtx_unlock(&mutex);
  thrd_create(&thread[0], get_mutex, &mutex);
  thrd_join(thread[0], &result);
  printf("%d\n", result == thrd_success);

  mtx_lock(&mutex);
  thrd_create(&thread[0], get_mutex, &mutex); /* it runs until the mutex is free, or its time is over */
  printf("%d", reduce_alone(NULL));
  mtx_unlock(&mutex);
  thrd_join(thread[0], NULL);
  thrd_create(&thread[0], reduce_alone, NULL);
  thrd_join(thread[0], &result);
  printf(" %d %d\n", result, reduce_alone(NULL));

  int created = 0;
  while (created < 16 && thrd_create(&many[created], nothing, NULL) == thrd_success)
    created++;
  for (int i = 0; i < created; i += 2)
    thrd_join(many[i], NULL);
  for (int i = 1; i < created; i += 2)
    thrd_detach(many[i]);
  printf("%d\n", created == (trax_threads() > 16 ? 16 : (int)trax_threads() - 1));
  return 0;
}
