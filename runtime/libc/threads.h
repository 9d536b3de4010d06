/* C's threads, as far as the machine has them: its threads are there from the start, so none can be created; mutexes
   and once work between them. Whoever waits, asks again and again. */
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

#define ONCE_FLAG_INIT                                                                                                 \
  { 0 }
#ifndef __cplusplus
#define thread_local _Thread_local
#endif

enum { mtx_plain = 0, mtx_recursive = 1, mtx_timed = 2 };
enum { thrd_success, thrd_busy, thrd_error, thrd_nomem, thrd_timedout };

#ifdef __cplusplus
extern "C" {
#endif

int mtx_init(mtx_t *mutex, int kind); /* thrd_error for timed ones */
void mtx_destroy(mtx_t *mutex);
int mtx_lock(mtx_t *mutex);
int mtx_trylock(mtx_t *mutex);
int mtx_unlock(mtx_t *mutex);
void call_once(once_flag *flag, void (*function)(void));
int thrd_create(thrd_t *thread, thrd_start_t function, void *argument); /* thrd_error */
thrd_t thrd_current(void);
int thrd_equal(thrd_t a, thrd_t b);
void thrd_yield(void);
int thrd_sleep(const struct timespec *duration, struct timespec *left);
__attribute__((noreturn)) void thrd_exit(int status);

#ifdef __cplusplus
}
#endif

#endif
