/* Nobody sees what depends on his own later store. */
#define ROLES 2
#include "litmus.h"

static struct {
  struct shared word[2];
} at[RUNS];

void part(unsigned role, unsigned run) {
  unsigned other;
  if (run % 2) {
    other = LOAD(at[run].word[!role].word, ACQUIRE);
    STORE(at[run].word[role].word, 1, RELEASE);
  } else {
    other = LOAD(at[run].word[!role].word, memory_order_relaxed);
    FENCE(memory_order_acq_rel);
    STORE(at[run].word[role].word, 1, memory_order_relaxed);
  }
  wait(4);
  SEE(run, role, 0, other);
}

enum outcome outcome(unsigned run) {
  return SAW(run, 0, 0) && SAW(run, 1, 0) ? WEAK : ALLOWED;
}
