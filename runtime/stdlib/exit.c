/* The ends of a program. */
#include "../internal/machine.h"

#include <assert.h>
#include <stdlib.h>

void exit(int status) {
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
