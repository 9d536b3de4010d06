// RUN: %run_c %s %t --turns -O0,-O2,-Os \
// RUN:   --simflags "--config 2x32 --set memory.bandwidth_gbps=0.5 --max-cycles 3000000"
// A store that announces an increment comes after it, also while the memory is busy with other threads' requests.
// (Expected output by hand.)
#include <stdatomic.h>
#include <stdio.h>
#include <trax.h>

enum { ROUNDS = 20, WORDS = 512 };

static atomic_uint counted, announced, seen, wrong, ended;
unsigned noise[WORDS][16];

// One thread counts and announces, one of the other TM looks, and another of the first TM fills its queue.
int main(void) {
  const unsigned thread = trax_thread(), last = trax_threads() - 1;
  for (unsigned round = 1; round <= ROUNDS; round++) {
    if (thread == 0) {
      atomic_fetch_add_explicit(&counted, 1, memory_order_relaxed);
      atomic_store_explicit(&announced, round, memory_order_release);
      while (atomic_load_explicit(&seen, memory_order_acquire) != round)
        ;
    } else if (thread == last) {
      while (atomic_load_explicit(&announced, memory_order_acquire) != round)
        ;
      if (atomic_load_explicit(&counted, memory_order_relaxed) != round)
        atomic_fetch_add(&wrong, 1);
      atomic_store_explicit(&seen, round, memory_order_release);
    } else if (thread == 1)
      for (unsigned i = 0; i < WORDS; i++)
        trax_store_nt(&noise[i][0], round);
  }
  atomic_fetch_add(&ended, 1);
  if (thread == 0) {
    while (atomic_load(&ended) != last + 1)
      ;
    printf("%u increments announced, %u of them too early\n", atomic_load(&counted), atomic_load(&wrong));
  }
  return 0;
}
