/* The same with a lock of which the library takes part: atomic_flag. */
#define ROLES 2
#include "litmus.h"

static atomic_flag taken[RUNS];
static struct data data[RUNS];

void part(unsigned role, unsigned run) {
  for (unsigned turn = 0; turn < 2; turn++) {
    (void)data[run].beside;
    while (atomic_flag_test_and_set_explicit(&taken[run], (memory_order)ACQUIRE))
      ;
    SEE(run, role, 0, data[run].value);
    data[run].value = data[run].value + 1;
    atomic_flag_clear_explicit(&taken[run], (memory_order)RELEASE);
  }
}

enum outcome outcome(unsigned run) {
  return SAW(run, 0, 0) == 3 || SAW(run, 1, 0) == 3 ? ALLOWED : WEAK;
}
