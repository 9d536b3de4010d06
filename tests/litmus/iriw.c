/* Two readers agree on the order of two independent writes. */
#define ROLES 4
#include "litmus.h"

static struct {
  struct shared word[2];
} at[RUNS];

void part(unsigned role, unsigned run) {
  const unsigned which = role % 2;
  if (role < 2) {
    STORE(at[run].word[which].word, 1, SEQ_CST);
    return;
  }
  const unsigned first = LOAD(at[run].word[which].word, SEQ_CST);
  const unsigned second = LOAD(at[run].word[!which].word, SEQ_CST);
  wait(4);
  SEE(run, role, 0, first);
  SEE(run, role, 1, second);
}

enum outcome outcome(unsigned run) {
  return SAW(run, 2, 0) && !SAW(run, 2, 1) && SAW(run, 3, 0) && !SAW(run, 3, 1) ? WEAK : ALLOWED;
}
