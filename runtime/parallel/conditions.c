/* C11's conditions, values of a thread, and mutexes with a limit of time. */
#include "team.h"

#ifdef __trax__

#include <threads.h>

static int has_passed(const struct timespec *until) {
  struct timespec now;
  timespec_get(&now, TIME_UTC);
  return now.tv_sec > until->tv_sec || (now.tv_sec == until->tv_sec && now.tv_nsec >= until->tv_nsec);
}

int mtx_timedlock(mtx_t *mutex, const struct timespec *until) {
  int result;
  while ((result = mtx_trylock(mutex)) == thrd_busy)
    if (has_passed(until))
      return thrd_timedout;
  return result;
}

int cnd_init(cnd_t *condition) {
  condition->notified = 0;
  return thrd_success;
}

void cnd_destroy(cnd_t *condition) {
  (void)condition;
}

int cnd_signal(cnd_t *condition) {
  release_fence();
  trax_atomic_inc(&condition->notified);
  return thrd_success;
}

int cnd_broadcast(cnd_t *condition) {
  return cnd_signal(condition);
}

static int wait(cnd_t *condition, mtx_t *mutex, const struct timespec *until) {
  const unsigned before = load_shared(&condition->notified);
  int result = thrd_success;
  mtx_unlock(mutex);
  while (load_shared(&condition->notified) == before)
    if (until && has_passed(until)) {
      result = thrd_timedout;
      break;
    }
  mtx_lock(mutex);
  return result;
}

int cnd_wait(cnd_t *condition, mtx_t *mutex) {
  return wait(condition, mutex, NULL);
}

int cnd_timedwait(cnd_t *condition, mtx_t *mutex, const struct timespec *until) {
  return wait(condition, mutex, until);
}

enum { KEYS = 16 };
static unsigned keys; /* those made */
static tss_dtor_t destructors[KEYS];
static _Thread_local void *values[KEYS];
void __trax_tss_end(void);

int tss_create(tss_t *key, tss_dtor_t destructor) {
  *key = trax_atomic_inc(&keys);
  if (*key >= KEYS)
    return thrd_error;
  destructors[*key] = destructor;
  return thrd_success;
}

void tss_delete(tss_t key) {
  destructors[key] = NULL;
}

void *tss_get(tss_t key) {
  return values[key];
}

int tss_set(tss_t key, void *value) {
  values[key] = value;
  return thrd_success;
}

/* Called when a function of thrd_create returns, and by thrd_exit. */
void __trax_tss_end(void) {
  for (int round = 0, again = 1; again && round < TSS_DTOR_ITERATIONS; round++) {
    again = 0;
    for (unsigned key = 0; key < KEYS; key++) {
      void *value = values[key];
      values[key] = NULL;
      if (value && destructors[key]) {
        destructors[key](value);
        again = 1;
      }
    }
  }
}

#endif
