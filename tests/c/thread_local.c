// RUN: %run_c %s %t --simflags "--config 1x32"
// Thread-local objects: each thread counts in its own; the sum is what all of them did. (Expected output by
// hand.)
#include <stdio.h>
#include <trax.h>

static _Thread_local int counter;
static _Thread_local struct {
  unsigned square;
  char name[4];
} own;
static volatile unsigned results[256];
static unsigned arrived;

__attribute__((noinline)) static void work(unsigned n) {
  for (unsigned i = 0; i < n; i++)
    counter += (int)i;
  own.square = n * n;
  own.name[1] = (char)n;
}

int main(void) {
  unsigned thread = trax_thread();
  work(thread);
  results[thread] = (unsigned)counter + own.square + (unsigned)own.name[1];
  if (__atomic_fetch_add(&arrived, 1, __ATOMIC_ACQ_REL) != trax_threads() - 1)
    return 0;
  unsigned sum = 0, wrong = 0;
  for (unsigned i = 0; i < trax_threads(); i++) {
    sum += results[i];
    wrong += results[i] != i * (i - 1) / 2 + i * i + i;
  }
  printf("%u %u\n", sum, wrong);
  return 0;
}
