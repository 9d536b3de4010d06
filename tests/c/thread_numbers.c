// RUN: %run_c %s %t --simflags "--config 2x32 --max-cycles 3000000"
// Special registers on two TMs, or four of 32 TPs; the library's names and the instruction agree. Threads print in turn.
// (Expected output by hand.)
#include <stdio.h>
#include <trax.h>

static volatile unsigned turn;
static unsigned wrong, arrived;

__attribute__((noinline)) static unsigned check(unsigned tps) {
  unsigned thread, tm, tp, threads, low, high;
  __asm__("rdsr %0, 0" : "=r"(thread));
  __asm__("rdsr %0, 1" : "=r"(tm));
  __asm__("rdsr %0, 2" : "=r"(tp));
  __asm__("rdsr %0, 3" : "=r"(threads));
  __asm__ volatile("rdsr %0, 4\n\trdsr %1, 5" : "=&r"(low), "=r"(high));
  return thread != tm * tps + tp || tp >= tps || tm * tps >= threads || high != 0 || low > trax_cycles() ||
         thread != trax_thread() || tm != trax_tm() || tp != trax_tp() || threads != trax_threads();
}

int main(void) {
  unsigned thread = trax_thread();
  if (check(trax_threads() / (trax_threads() == 128 ? 4 : 2)))
    trax_atomic_inc(&wrong);
  __atomic_fetch_add(&arrived, 1, __ATOMIC_RELEASE);
  if (thread % 9)
    return 0;
  while (__atomic_load_n(&turn, __ATOMIC_ACQUIRE) != thread)
    ;
  printf("%u:%u.%u ", thread, trax_tm(), trax_tp());
  __atomic_store_n(&turn, thread + 9, __ATOMIC_RELEASE);
  if (thread + 9 < trax_threads())
    return 0;
  while (__atomic_load_n(&arrived, __ATOMIC_ACQUIRE) != trax_threads())
    ;
  printf("wrong %u\n", wrong);
  return 0;
}
