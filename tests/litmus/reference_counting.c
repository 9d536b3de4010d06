/* The thread that drops the last reference sees all owners' stores to the object. */
#define ROLES 2
#include "litmus.h"

static struct {
  struct data data[ROLES];
} at[RUNS];
static struct shared dropped[RUNS]; /* references to 0 - ROLES */

void part(unsigned role, unsigned run) {
  (void)at[run].data[!role].beside;
  at[run].data[role].value = 1;
  if (atomic_fetch_sub_explicit(&dropped[run].word, 1, (memory_order)RELEASE) != 1u - ROLES)
    return;
  FENCE(memory_order_acquire);
  SEE(run, role, 0, 1 + at[run].data[!role].value);
}

enum outcome outcome(unsigned run) {
  const unsigned last = SAW(run, 0, 0) + SAW(run, 1, 0); /* of them, only one saw something */
  return last == 2 ? ALLOWED : last == 1 ? WEAK : BROKEN;
}
