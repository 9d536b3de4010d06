/* POSIX's threads over C11's. */
#include <errno.h>
#include <pthread.h>
#include <stdint.h>
#include <threads.h>

_Static_assert(sizeof(pthread_mutex_t) == sizeof(mtx_t) && PTHREAD_MUTEX_RECURSIVE == mtx_recursive, "of <pthread.h>");
_Static_assert(sizeof(pthread_cond_t) == sizeof(cnd_t) && sizeof(pthread_once_t) == sizeof(once_flag), "too");

static mtx_t *c11(pthread_mutex_t *mutex) {
  return (mtx_t *)mutex;
}

static cnd_t *condition_of(pthread_cond_t *condition) {
  return (cnd_t *)condition;
}

static int error_of(int result) {
  return result == thrd_success    ? 0
         : result == thrd_busy     ? EBUSY
         : result == thrd_timedout ? ETIMEDOUT
         : result == thrd_nomem    ? ENOMEM
                                   : EAGAIN;
}

int pthread_attr_init(pthread_attr_t *attributes) {
  *attributes = PTHREAD_CREATE_JOINABLE;
  return 0;
}

int pthread_attr_setdetachstate(pthread_attr_t *attributes, int state) {
  *attributes = state;
  return 0;
}

int pthread_attr_setstacksize(pthread_attr_t *attributes, size_t size) {
  (void)attributes;
  (void)size;
  return 0;
}

int pthread_attr_destroy(pthread_attr_t *attributes) {
  (void)attributes;
  return 0;
}

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*function)(void *), void *argument) {
  const int result = thrd_create(thread, (thrd_start_t)(void (*)(void))function, argument);
  if (result == thrd_success && attributes && *attributes == PTHREAD_CREATE_DETACHED)
    thrd_detach(*thread);
  return error_of(result);
}

int pthread_join(pthread_t thread, void **value) {
  int result;
  const int status = error_of(thrd_join(thread, &result));
  if (value && !status)
    *value = (void *)(intptr_t)result;
  return status;
}

int pthread_detach(pthread_t thread) {
  return error_of(thrd_detach(thread));
}

pthread_t pthread_self(void) {
  return thrd_current();
}

int pthread_equal(pthread_t a, pthread_t b) {
  return thrd_equal(a, b);
}

void pthread_exit(void *value) {
  thrd_exit((int)(intptr_t)value);
}

int pthread_mutexattr_init(pthread_mutexattr_t *attributes) {
  *attributes = PTHREAD_MUTEX_NORMAL;
  return 0;
}

int pthread_mutexattr_settype(pthread_mutexattr_t *attributes, int kind) {
  *attributes = kind;
  return 0;
}

int pthread_mutexattr_destroy(pthread_mutexattr_t *attributes) {
  (void)attributes;
  return 0;
}

int pthread_mutex_init(pthread_mutex_t *mutex, const pthread_mutexattr_t *attributes) {
  return error_of(
      mtx_init(c11(mutex), attributes && *attributes == PTHREAD_MUTEX_RECURSIVE ? mtx_recursive : mtx_plain));
}

int pthread_mutex_destroy(pthread_mutex_t *mutex) {
  mtx_destroy(c11(mutex));
  return 0;
}

int pthread_mutex_lock(pthread_mutex_t *mutex) {
  return error_of(mtx_lock(c11(mutex)));
}

int pthread_mutex_trylock(pthread_mutex_t *mutex) {
  return error_of(mtx_trylock(c11(mutex)));
}

int pthread_mutex_unlock(pthread_mutex_t *mutex) {
  return error_of(mtx_unlock(c11(mutex)));
}

/* A recursive mutex, so that a thread may read twice. */
int pthread_rwlock_init(pthread_rwlock_t *lock, const pthread_rwlockattr_t *attributes) {
  (void)attributes;
  return error_of(mtx_init(c11(lock), mtx_recursive));
}

int pthread_rwlock_destroy(pthread_rwlock_t *lock) {
  return pthread_mutex_destroy(lock);
}

int pthread_rwlock_rdlock(pthread_rwlock_t *lock) {
  return pthread_mutex_lock(lock);
}

int pthread_rwlock_tryrdlock(pthread_rwlock_t *lock) {
  return pthread_mutex_trylock(lock);
}

int pthread_rwlock_wrlock(pthread_rwlock_t *lock) {
  return pthread_mutex_lock(lock);
}

int pthread_rwlock_trywrlock(pthread_rwlock_t *lock) {
  return pthread_mutex_trylock(lock);
}

int pthread_rwlock_unlock(pthread_rwlock_t *lock) {
  return pthread_mutex_unlock(lock);
}

int pthread_cond_init(pthread_cond_t *condition, const pthread_condattr_t *attributes) {
  (void)attributes;
  return error_of(cnd_init(condition_of(condition)));
}

int pthread_cond_destroy(pthread_cond_t *condition) {
  cnd_destroy(condition_of(condition));
  return 0;
}

int pthread_cond_signal(pthread_cond_t *condition) {
  return error_of(cnd_signal(condition_of(condition)));
}

int pthread_cond_broadcast(pthread_cond_t *condition) {
  return error_of(cnd_broadcast(condition_of(condition)));
}

int pthread_cond_wait(pthread_cond_t *condition, pthread_mutex_t *mutex) {
  return error_of(cnd_wait(condition_of(condition), c11(mutex)));
}

int pthread_cond_timedwait(pthread_cond_t *condition, pthread_mutex_t *mutex, const struct timespec *until) {
  return error_of(cnd_timedwait(condition_of(condition), c11(mutex), until));
}

int pthread_once(pthread_once_t *once, void (*function)(void)) {
  call_once((once_flag *)once, function);
  return 0;
}

int pthread_key_create(pthread_key_t *key, void (*destructor)(void *)) {
  return error_of(tss_create(key, destructor));
}

int pthread_key_delete(pthread_key_t key) {
  tss_delete(key);
  return 0;
}

void *pthread_getspecific(pthread_key_t key) {
  return tss_get(key);
}

int pthread_setspecific(pthread_key_t key, const void *value) {
  return error_of(tss_set(key, (void *)(uintptr_t)value));
}
