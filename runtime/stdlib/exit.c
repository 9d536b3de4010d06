/* The ends of a program. */
#include "../internal/machine.h"

#include <assert.h>
#include <stdlib.h>

/* Each is linked only into programs that need it. */
__attribute__((weak)) void __trax_end_construction(void);
__attribute__((weak)) void __trax_end_thread(void);
__attribute__((weak)) void __trax_end_program(void);

void exit(int status) {
  if (__trax_end_construction)
    __trax_end_construction();
  if (__trax_end_thread)
    __trax_end_thread();
  if (__trax_end_program)
    __trax_end_program();
  machine_exit(status);
}

void _Exit(int status) {
  machine_exit(status);
}

void abort(void) {
  machine_abort("abort");
}

void __trax_assert_fail(const char *message) {
  machine_abort(message);
}
