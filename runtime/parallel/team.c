/* trax_parallel: thread 0 announces a job by a number, the others poll the number, do the job and count themselves. */
#include "team.h"

#ifdef __trax__

#include <trax.h>

int __cxa_thread_atexit(void (*function)(void *), void *argument, void *image);

static struct {
  void (*function)(void *);
  void *context;
  unsigned size; /* 0: the end */
} job;
static unsigned number, arrived, others;
static struct trax_barrier barrier;
_Thread_local unsigned __trax_team_members;

/* Polls less often after a while, so that thread 0 has the memory's bandwidth. */
static void serve(void) {
  enum { MOST = 64 /* turns of an empty loop */ };
  for (unsigned seen = 0, pause = 1;;) {
    const unsigned now = load_shared(&number);
    if (now == seen) {
      if (__trax_errand)
        __trax_errand();
      for (unsigned i = 0; i < pause; i++)
        __asm__ volatile("");
      if (pause < MOST)
        pause *= 2;
      continue;
    }
    acquire_fence();
    seen = now;
    pause = 1;
    if (job.size == 0)
      return;
    if (trax_thread() < job.size) {
      __trax_team_members = job.size;
      job.function(job.context);
      __trax_team_members = 0;
    }
    release_fence();
    trax_atomic_inc(&arrived);
  }
}

static void announce(void (*function)(void *), void *context, unsigned size) {
  job.function = function;
  job.context = context;
  job.size = size;
  release_fence();
  store_shared(&number, load_shared(&number) + 1);
}

static void end(void *nothing) {
  (void)nothing;
  announce(NULL, NULL, 0);
}

unsigned __trax_team_open(void) {
  if (!others && trax_thread() == 0) {
    others = trax_start_threads(serve);
    if (others)
      __cxa_thread_atexit(end, NULL, NULL);
  }
  return others;
}

unsigned __trax_team_available(void) {
  const int alone =
      __trax_team_members || trax_thread() != 0 || !__trax_team_open() || (__trax_errands && __trax_errands());
  return alone ? 1 : others + 1;
}

unsigned __trax_team_run(void (*function)(void *), void *context, unsigned size) {
  const unsigned before = __trax_team_members, available = size == 1 ? 1 : __trax_team_available();
  if (available == 1) {
    __trax_team_members = 1;
    function(context);
    __trax_team_members = before;
    return 1;
  }
  __trax_team_members = barrier.count = size - 1 < available ? size : available;
  announce(function, context, __trax_team_members);
  function(context);
  const unsigned all = __trax_team_members;
  __trax_team_members = 0;
  while (load_shared(&arrived) != others * load_shared(&number))
    ;
  acquire_fence();
  return all;
}

unsigned trax_parallel(void (*function)(void *), void *context) {
  return __trax_team_run(function, context, 0);
}

unsigned trax_team_size(void) {
  return __trax_team_members ? __trax_team_members : 1;
}

unsigned trax_team_rank(void) {
  return __trax_team_members > 1 ? trax_thread() : 0;
}

/* The last one lets the others go on. Nobody arrives for the next time before that. */
void trax_barrier_wait(struct trax_barrier *b) {
  const unsigned released = load_shared(&b->released);
  release_fence();
  if (trax_atomic_inc(&b->arrived) == b->count - 1) {
    store_shared(&b->arrived, 0);
    release_fence();
    store_shared(&b->released, released + 1);
  } else {
    while (load_shared(&b->released) == released)
      ;
  }
  acquire_fence();
}

void trax_team_barrier(void) {
  if (__trax_team_members > 1)
    trax_barrier_wait(&barrier);
}

void *trax_scratch(size_t size) {
  static _Thread_local void *memory;
  static _Thread_local size_t bytes;
  if (size > bytes) {
    free(memory);
    memory = malloc(size);
    bytes = memory ? size : 0;
  }
  return memory;
}

#endif
