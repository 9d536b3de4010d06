/* A thread that has seen the flag sees the data. */
#define ROLES 2
#include "litmus.h"

static struct {
  struct data data;
  struct shared flag;
} at[RUNS];

void part(unsigned role, unsigned run) {
  if (role == 0) {
    at[run].data.value = 1;
    if (run % 2) {
      STORE(at[run].flag.word, 1, RELEASE);
    } else {
      FENCE(memory_order_release);
      STORE(at[run].flag.word, 1, memory_order_relaxed);
    }
    return;
  }
  (void)at[run].data.beside;
  unsigned flag;
  if (run % 2) {
    flag = LOAD(at[run].flag.word, ACQUIRE);
  } else {
    flag = LOAD(at[run].flag.word, memory_order_relaxed);
    FENCE(memory_order_acquire);
  }
  SEE(run, 1, 1, at[run].data.value);
  SEE(run, 1, 0, flag);
}

enum outcome outcome(unsigned run) {
  return SAW(run, 1, 0) && !SAW(run, 1, 1) ? WEAK : ALLOWED;
}
