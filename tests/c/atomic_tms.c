// RUN: %run_c %s %t --simflags "--set chip.tms=2 --set chip.tps_per_tm=1"
// Threads of several TMs add to one word, and hand on data: nothing is lost, nothing old is read. (Expected output by
// hand.)
#include <stdio.h>
#include <trax.h>

enum { ADDITIONS = 200, WORDS = 16 };

static int sum, wrong;
static unsigned flag, finished;
static volatile unsigned data[WORDS];

int main(void) {
  const unsigned thread = trax_thread(), threads = trax_threads();
  const int own = ADDITIONS / (int)threads;
  for (int i = 0; i < own; i++)
    __atomic_fetch_add(&sum, 3, __ATOMIC_SEQ_CST);
  /* Each round one thread writes, and all others have the line of before in their caches. */
  for (unsigned round = 0; round < 8; round++) {
    for (unsigned i = 0; i < WORDS; i++)
      if (data[i] > round)
        __atomic_fetch_add(&wrong, 1, __ATOMIC_RELAXED);
    __atomic_fetch_add(&finished, 1, __ATOMIC_ACQ_REL);
    if (thread == round * 5 % threads) {
      while (__atomic_load_n(&finished, __ATOMIC_ACQUIRE) < (2 * round + 1) * threads)
        ;
      for (unsigned i = 0; i < WORDS; i++)
        data[i] = round + 1;
      __atomic_store_n(&flag, round + 1, __ATOMIC_RELEASE);
    }
    while (__atomic_load_n(&flag, __ATOMIC_ACQUIRE) != round + 1)
      ;
    for (unsigned i = 0; i < WORDS; i++)
      if (data[i] != round + 1)
        __atomic_fetch_add(&wrong, 1, __ATOMIC_RELAXED);
    __atomic_fetch_add(&finished, 1, __ATOMIC_ACQ_REL);
    while (__atomic_load_n(&finished, __ATOMIC_ACQUIRE) < (2 * round + 2) * threads)
      ;
  }
  if (thread == 0)
    printf("%d of %d, %d wrong\n", sum, 3 * own * (int)threads, wrong);
  return 0;
}
