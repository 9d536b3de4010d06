// RUN: %run_c %s %t --turns -O0,-O2,-Os --simflags "--config 1x32 --max-cycles 3000000"
// RUN: %run_c %s %t --levels -O2 --simflags "--config 2x32 --max-cycles 3000000"
// A lock from two counters and the atomic increment: one thread at a time, first come, first served.
// (Expected output by hand.)
#include <stdio.h>
#include <trax.h>

enum { ROUNDS = 4 };
static unsigned next, serving, finished;
static volatile unsigned shared, previous, out_of_order, inside, intruders;

/* The word as it is now: an atomic load, since trax_load_nt may be moved out of a loop. */
static unsigned now(const volatile unsigned *p) {
  return __atomic_load_n(p, __ATOMIC_ACQUIRE);
}

__attribute__((noinline)) static void critical(unsigned ticket) {
  intruders += inside++ != 0;
  out_of_order += ticket != previous;
  previous = ticket + 1;
  shared += ticket & 3;
  inside--;
}

int main(void) {
  for (int i = 0; i < ROUNDS; i++) {
    unsigned ticket = trax_atomic_inc(&next);
    while (now(&serving) != ticket)
      ;
    critical(ticket);
    __atomic_store_n(&serving, ticket + 1, __ATOMIC_RELEASE);
  }
  unsigned threads = trax_threads();
  if (__atomic_fetch_add(&finished, 1, __ATOMIC_ACQ_REL) != threads - 1)
    return 0;
  printf("%d %d %u %u\n", next == threads * ROUNDS, shared == threads * ROUNDS / 4 * 6, out_of_order, intruders);
  return 0;
}
