/* All see the stores to one word in one order, in which a thread's own order, and what it knows of others, is kept. */
#define ROLES 4
#include "litmus.h"

static struct {
  struct shared word, stored, looked;
} at[RUNS];

void part(unsigned role, unsigned run) {
  unsigned first = 0, second = 0;
  switch (role) {
  case 0: /* the first store */
    first = LOAD(at[run].word.word, memory_order_relaxed);
    STORE(at[run].word.word, 1, memory_order_relaxed);
    STORE(at[run].stored.word, 1, RELEASE);
    second = LOAD(at[run].word.word, memory_order_relaxed);
    break;
  case 1: /* a second one, behind it */
    first = LOAD(at[run].stored.word, ACQUIRE);
    if (first)
      STORE(at[run].word.word, 2, memory_order_relaxed);
    second = LOAD(at[run].word.word, memory_order_relaxed);
    break;
  case 2: /* looks twice, and says so */
    first = LOAD(at[run].word.word, memory_order_relaxed);
    second = LOAD(at[run].word.word, memory_order_relaxed);
    STORE(at[run].looked.word, 1, RELEASE);
    break;
  default: /* looks behind it */
    first = LOAD(at[run].looked.word, ACQUIRE);
    second = LOAD(at[run].word.word, memory_order_relaxed);
  }
  wait(4);
  SEE(run, role, 0, first);
  SEE(run, role, 1, second);
}

enum outcome outcome(unsigned run) {
  /* One thread and one word: whatever the orders. */
  if (SAW(run, 0, 0) == 1 || !SAW(run, 0, 1) || (SAW(run, 1, 0) && !SAW(run, 1, 1)))
    return BROKEN;
  const unsigned last = LOAD(at[run].word.word, memory_order_relaxed);
  if (last != 1 && last != 2)
    return BROKEN;
  if (SAW(run, 2, 0) && !SAW(run, 2, 1))
    return BROKEN;
  if (SAW(run, 1, 0) && (last != 2 || (SAW(run, 2, 0) == 2 && SAW(run, 2, 1) == 1)))
    return WEAK; /* the second store went before the first */
  if (SAW(run, 3, 0) && SAW(run, 3, 1) < SAW(run, 2, 1))
    return WEAK;
  return ALLOWED;
}
