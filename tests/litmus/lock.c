/* The next owner of a lock sees the stores of the one before. */
#define ROLES 2
#include "litmus.h"

static struct ticket ticket[RUNS];
static struct data data[RUNS];

void part(unsigned role, unsigned run) {
  (void)data[run].beside;
  TAKE(ticket[run], ACQUIRE);
  data[run].value = data[run].value + 1;
  GIVE(ticket[run], RELEASE);
  TAKE(ticket[run], ACQUIRE);
  SEE(run, role, 0, data[run].value);
  data[run].value = data[run].value + 1;
  GIVE(ticket[run], RELEASE);
}

/* The last one saw three increments. */
enum outcome outcome(unsigned run) {
  return SAW(run, 0, 0) == 3 || SAW(run, 1, 0) == 3 ? ALLOWED : WEAK;
}
