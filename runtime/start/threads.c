/* trax_start_threads: the threads that do not call main wait for it, or for thread 0's end. */
#include "../internal/machine.h"

#ifdef __trax__

#include <stdlib.h>
#include <trax.h>

void __trax_others(void);
void __trax_wait(void);
int __cxa_thread_atexit(void (*function)(void *), void *argument, void *image);

/* The number of waiting threads; the loader stores it here if there are any. */
unsigned __trax_waiting;

enum { WAITING, STARTED, ENDED };
static unsigned state;
static void (*work)(void);

static void release(void *nothing) {
  (void)nothing;
  if (load_shared(&state) == WAITING)
    store_shared(&state, ENDED);
}

/* Runs before main, on thread 0. It also keeps __trax_others in the program. */
__attribute__((constructor)) static void register_release(void) {
  __asm__ volatile("" : : "r"(__trax_others));
  __cxa_thread_atexit(release, NULL, NULL);
}

/* Polls seldom, to leave the memory's bandwidth to main. */
void __trax_wait(void) {
  enum { PAUSE = 500 /* turns of an empty loop */ };
  unsigned now;
  while ((now = load_shared(&state)) == WAITING)
    for (int i = 0; i < PAUSE; i++)
      __asm__ volatile("");
  if (now == ENDED)
    return;
  acquire_fence();
  work();
}

unsigned trax_start_threads(void (*function)(void)) {
  if (trax_thread() != 0 || load_shared(&state) != WAITING)
    return 0;
  work = function;
  release_fence();
  store_shared(&state, STARTED);
  return __trax_waiting;
}

#endif
