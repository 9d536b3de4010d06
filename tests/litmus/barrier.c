/* Behind a barrier everyone sees what all did before it. */
#define ROLES 2
#include "litmus.h"

static struct data data[RUNS][ROLES];
static struct shared come[RUNS];

void part(unsigned role, unsigned run) {
  (void)data[run][!role].beside;
  data[run][role].value = 1;
  atomic_fetch_add_explicit(&come[run].word, 1, (memory_order)ACQ_REL);
  while (LOAD(come[run].word, ACQUIRE) < ROLES)
    ;
  SEE(run, role, 0, data[run][!role].value);
}

enum outcome outcome(unsigned run) {
  return SAW(run, 0, 0) && SAW(run, 1, 0) ? ALLOWED : WEAK;
}
