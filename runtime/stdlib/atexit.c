/* Functions that run when the program ends: those given to atexit, destructors of static C++ objects, and then those in
   .fini_array. A program ends with its last thread, which runs them, the latest first. */
#include "../internal/machine.h"

#ifdef __trax__

#include <stdlib.h>

int __cxa_atexit(void (*function)(void *), void *argument, void *image);
void __trax_end_program(void);

extern void (*const __fini_array_start[])(void);
extern void (*const __fini_array_end[])(void);

/* Identifies the only image in calls of __cxa_atexit. */
void *__dso_handle;

struct block {
  struct block *before;
  unsigned used;
  struct {
    void (*function)(void *);
    void *argument;
  } entries[32];
};

static struct block first, *last = &first;
static struct ticket_lock list_lock;
static unsigned ended_threads;

int __cxa_atexit(void (*function)(void *), void *argument, void *image) {
  (void)image;
  lock(&list_lock);
  if (last->used == sizeof last->entries / sizeof last->entries[0]) {
    struct block *fresh = calloc(1, sizeof *fresh);
    if (!fresh) {
      unlock(&list_lock);
      return -1;
    }
    fresh->before = last;
    last = fresh;
  }
  last->entries[last->used].function = function;
  last->entries[last->used++].argument = argument;
  unlock(&list_lock);
  return 0;
}

static void call(void *function) {
  ((void (*)(void))function)();
}

int atexit(void (*function)(void)) {
  return __cxa_atexit(call, (void *)function, NULL);
}

void __trax_end_program(void) {
  release_fence();
  if (trax_atomic_inc(&ended_threads) != trax_threads() - 1)
    return;
  acquire_fence();
  while (last->used || last->before) { /* a called function may register more */
    if (!last->used) {
      last = last->before; /* the memory is of no more use */
      continue;
    }
    unsigned i = --last->used;
    last->entries[i].function(last->entries[i].argument);
  }
  for (void (*const *destructor)(void) = __fini_array_end; destructor != __fini_array_start;)
    (*--destructor)();
}

#endif
