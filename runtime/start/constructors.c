/* Functions that run before main (C++ constructors, __attribute__((constructor))): thread 0 runs them, the others wait,
   since all threads share the objects. */
#include "../internal/machine.h"

void __trax_run_constructors(void);

#ifdef __trax__

extern void (*const __init_array_start[])(void);
extern void (*const __init_array_end[])(void);

static unsigned done;

void __trax_run_constructors(void) {
  if (trax_thread() == 0) {
    for (void (*const *constructor)(void) = __init_array_start; constructor != __init_array_end; constructor++)
      (*constructor)();
    store_shared(&done, 1);
  } else {
    while (!load_shared(&done))
      ;
  }
}

#endif
