// RUN: %run_c %s %t --turns -O0,-O2,-Os --simflags "--config 1x32 --max-cycles 3000000"
// A barrier that is used again and again: the threads sort by exchanges of neighbours and sum by halves, step by step
// together. (Expected output by hand.)
#include <stdio.h>
#include <trax.h>

enum { MOST = 256 };
static unsigned arrivals;
static volatile int values[MOST];

/* The word as it is now: an atomic load, since trax_load_nt may be moved out of a loop. */
static unsigned now(const volatile unsigned *p) {
  return __atomic_load_n(p, __ATOMIC_ACQUIRE);
}

__attribute__((noinline)) static void barrier(unsigned *phase) {
  *phase += trax_threads();
  __atomic_thread_fence(__ATOMIC_RELEASE);
  trax_atomic_inc(&arrivals);
  while (now(&arrivals) < *phase)
    ;
}

int main(void) {
  const unsigned thread = trax_thread(), N = 2 * trax_threads();
  unsigned phase = 0, wrong = 0;
  values[2 * thread] = (int)(thread * 37 % N);
  values[2 * thread + 1] = (int)(N - 1 - thread * 37 % N);
  for (unsigned step = 0; step < N; step++) {
    barrier(&phase);
    unsigned i = 2 * thread + (step & 1);
    if (i + 1 < N && values[i] > values[i + 1]) {
      int t = values[i];
      values[i] = values[i + 1];
      values[i + 1] = t;
    }
  }
  barrier(&phase);
  if (thread == 0) {
    for (unsigned i = 1; i < N; i++)
      wrong += values[i - 1] > values[i];
    printf("%u %d\n", wrong, values[N - 1]);
  }
  barrier(&phase);
  for (unsigned half = N / 2; half; half /= 2) {
    if (thread < half)
      values[thread] += values[thread + half];
    barrier(&phase);
  }
  if (thread == trax_threads() - 1)
    printf("%d\n", values[0]);
  return 0;
}
