#include "../internal/machine.h"

#ifdef __trax__

#include <stdatomic.h>
#include <stdlib.h>
#include <threads.h>

int mtx_init(mtx_t *mutex, int kind) {
  *mutex = (mtx_t){.kind = kind};
  return thrd_success;
}

void mtx_destroy(mtx_t *mutex) {
  (void)mutex;
}

/* Locks a recursive mutex once more if the thread has it already. Returns whether it has. */
static int has(mtx_t *mutex) {
  if (!(mutex->kind & mtx_recursive) || load_shared(&mutex->owner) != trax_thread() + 1)
    return 0;
  mutex->depth++;
  return 1;
}

static int own(mtx_t *mutex) {
  store_shared(&mutex->owner, trax_thread() + 1);
  mutex->depth = 1;
  return thrd_success;
}

int mtx_lock(mtx_t *mutex) {
  if (has(mutex))
    return thrd_success;
  unsigned ticket = atomic_fetch_add_explicit(&mutex->next, 1, memory_order_relaxed);
  while (atomic_load_explicit(&mutex->serving, memory_order_relaxed) != ticket)
    ;
  acquire_fence();
  return own(mutex);
}

int mtx_trylock(mtx_t *mutex) {
  if (has(mutex))
    return thrd_success;
  unsigned ticket = atomic_load_explicit(&mutex->serving, memory_order_relaxed);
  if (!atomic_compare_exchange_strong(&mutex->next, &ticket, ticket + 1))
    return thrd_busy;
  acquire_fence();
  return own(mutex);
}

int mtx_unlock(mtx_t *mutex) {
  if (--mutex->depth)
    return thrd_success;
  store_shared(&mutex->owner, 0);
  atomic_fetch_add_explicit(&mutex->serving, 1, memory_order_release);
  return thrd_success;
}

void call_once(once_flag *flag, void (*function)(void)) {
  enum { NEW, RUNNING, DONE };
  unsigned state = NEW;
  if (atomic_load(&flag->state) == DONE)
    return;
  if (atomic_compare_exchange_strong(&flag->state, &state, RUNNING)) {
    function();
    atomic_store(&flag->state, DONE);
  }
  while (atomic_load(&flag->state) != DONE)
    ;
}

thrd_t thrd_current(void) {
  return trax_thread();
}

int thrd_equal(thrd_t a, thrd_t b) {
  return a == b;
}

void thrd_yield(void) {}

int thrd_sleep(const struct timespec *duration, struct timespec *left) {
  return nanosleep(duration, left);
}

#endif
