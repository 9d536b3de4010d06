/* Destructors of thread-local C++ objects: each thread runs its own when it ends, the latest first. */
#include "../internal/machine.h"

#ifdef __trax__

#include <stdlib.h>

int __cxa_thread_atexit(void (*function)(void *), void *argument, void *image);
void __trax_end_thread(void);

struct entry {
  struct entry *before;
  void (*function)(void *);
  void *argument;
};

static _Thread_local struct entry *last;

int __cxa_thread_atexit(void (*function)(void *), void *argument, void *image) {
  (void)image;
  struct entry *fresh = malloc(sizeof *fresh);
  if (!fresh)
    machine_abort("no memory to remember a thread-local object's destructor");
  fresh->before = last;
  fresh->function = function;
  fresh->argument = argument;
  last = fresh;
  return 0;
}

void __trax_end_thread(void) {
  while (last) {
    struct entry *entry = last;
    last = entry->before;
    entry->function(entry->argument);
    free(entry);
  }
}

#endif
