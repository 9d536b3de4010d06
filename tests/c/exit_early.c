// RUN: %run_c %s %t --turns -O0,-O2 --simflags "--config 1x32 --max-cycles 3000000" --status 4
// A thread that exits ends alone: the others go on, and the run ends with the last. Its status counts before those of
// later threads. (Expected output by hand.)
#include <stdio.h>
#include <stdlib.h>
#include <trax.h>

static unsigned gone;

__attribute__((noinline)) static void deep(int n) {
  if (n == 0) {
    __atomic_fetch_add(&gone, 1, __ATOMIC_RELEASE);
    exit(4);
  }
  deep(n - 1);
  puts("not reached");
}

int main(void) {
  unsigned thread = trax_thread();
  if (thread == 1)
    deep(4);
  while (__atomic_load_n(&gone, __ATOMIC_ACQUIRE) == 0)
    ;
  if (thread == 0)
    puts("still here");
  return (int)thread;
}
