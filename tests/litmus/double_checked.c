/* A thread that finds the object initialised sees its initial values. */
#define ROLES 2
#include "litmus.h"

static struct data object[RUNS];
static struct shared initialised[RUNS];
static struct ticket ticket[RUNS];

void part(unsigned role, unsigned run) {
  (void)object[run].beside;
  if (!LOAD(initialised[run].word, ACQUIRE)) {
    TAKE(ticket[run], ACQUIRE);
    if (!LOAD(initialised[run].word, memory_order_relaxed)) {
      object[run].value = 1;
      STORE(initialised[run].word, 1, RELEASE);
    }
    GIVE(ticket[run], RELEASE);
  }
  SEE(run, role, 0, object[run].value);
}

enum outcome outcome(unsigned run) {
  return SAW(run, 0, 0) && SAW(run, 1, 0) ? ALLOWED : WEAK;
}
