/* C's threads. The machine's are there from the start: thrd_create gives a function to one that waits for work, with
   trax-sim --main-on 0, and fails if all are busy. Functions that wait poll. */
#ifndef TRAX_THREADS_H
#define TRAX_THREADS_H

#include <time.h>

typedef unsigned thrd_t;
typedef int (*thrd_start_t)(void *);
typedef struct {
  _Atomic unsigned next, serving;
  unsigned owner, depth; /* of a recursive one: the thread's number + 1 */
  int kind;
} mtx_t;
typedef struct {
  _Atomic unsigned state;
} once_flag;
typedef struct {
  unsigned notified;
} cnd_t;
typedef unsigned tss_t;
typedef void (*tss_dtor_t)(void *);

#define ONCE_FLAG_INIT {0}
#ifndef __cplusplus
#define thread_local _Thread_local
#endif

#define TSS_DTOR_ITERATIONS 4

enum { mtx_plain = 0, mtx_recursive = 1, mtx_timed = 2 };
enum { thrd_success, thrd_busy, thrd_error, thrd_nomem, thrd_timedout };

#ifdef __cplusplus
extern "C" {
#endif

int mtx_init(mtx_t *mutex, int kind);
void mtx_destroy(mtx_t *mutex);
int mtx_lock(mtx_t *mutex);
int mtx_trylock(mtx_t *mutex);
int mtx_timedlock(mtx_t *mutex, const struct timespec *until);
int mtx_unlock(mtx_t *mutex);
void call_once(once_flag *flag, void (*function)(void));
int cnd_init(cnd_t *condition);
void cnd_destroy(cnd_t *condition);
int cnd_signal(cnd_t *condition); /* wakes all */
int cnd_broadcast(cnd_t *condition);
int cnd_wait(cnd_t *condition, mtx_t *mutex);
int cnd_timedwait(cnd_t *condition, mtx_t *mutex, const struct timespec *until);
int tss_create(tss_t *key, tss_dtor_t destructor); /* at most 16 */
void tss_delete(tss_t key);
void *tss_get(tss_t key);
int tss_set(tss_t key, void *value);
int thrd_create(thrd_t *thread, thrd_start_t function, void *argument);
int thrd_join(thrd_t thread, int *result);
int thrd_detach(thrd_t thread);
thrd_t thrd_current(void);
int thrd_equal(thrd_t a, thrd_t b);
void thrd_yield(void);
int thrd_sleep(const struct timespec *duration, struct timespec *left);
__attribute__((noreturn)) void thrd_exit(int status);

#ifdef __cplusplus
}
#endif

#endif
