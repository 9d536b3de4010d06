/* A thread's work before main, in programs that have initialised thread-local data or constructors. The linker takes
   this file only for them, and the start file calls it if it is there. */
#include "../internal/machine.h"

#ifdef __trax__

void __trax_prepare(void);

extern void (*const __init_array_start[])(void);
extern void (*const __init_array_end[])(void);
extern unsigned __tdata_start[], __tdata_end[];
extern const unsigned __tdata_load[];

/* The state that the other threads wait for: constructed, or thread 0 called exit in a constructor. */
enum { CONSTRUCTING, CONSTRUCTED, ENDED };
static unsigned construction;
void __trax_end_construction(void);

void __trax_end_construction(void) {
  if (load_shared(&construction) == CONSTRUCTING)
    store_shared(&construction, ENDED);
}

void __trax_prepare(void) {
  const unsigned *from = __tdata_load;
  for (unsigned *to = __tdata_start; to < __tdata_end; to++)
    *to = *from++;

  const uintptr_t bytes = (uintptr_t)__init_array_end - (uintptr_t)__init_array_start;
  if (bytes == 0)
    return;
  /* All threads share the objects: thread 0 constructs them, the others wait. */
  if (trax_thread() == 0) {
    for (unsigned i = 0; i < bytes / sizeof *__init_array_start; i++)
      __init_array_start[i]();
    release_fence();
    store_shared(&construction, CONSTRUCTED);
  } else {
    unsigned state;
    while ((state = load_shared(&construction)) == CONSTRUCTING)
      ;
    if (state == ENDED)
      machine_exit(0);
    acquire_fence();
  }
}

/* Called by crt0. In programs with arguments.S, its __trax_start calls __trax_prepare instead. */
__attribute__((weak, alias("__trax_prepare"))) void __trax_start(void);

#endif
