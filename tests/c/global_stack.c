// RUN: %run_c %s %t --cflags "-mstack=global" --simflags "--config 1x32"
// Stacks in global memory: every thread recurses to 40 kB, keeps large arrays apart from the others', and prints
// doubles. (Expected output by hand.)
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <trax.h>

static atomic_uint arrived;
static atomic_int *volatile shared; /* on the stack of thread 0 */
static unsigned failures;

__attribute__((noinline)) static unsigned depth_sum(unsigned n) {
  volatile unsigned kept[7] = {n, 0, 0, 0, 0, 0, 0};
  return n == 0 ? 0 : depth_sum(n - 1) + kept[0];
}

__attribute__((noinline)) static unsigned own_array(unsigned char with) {
  unsigned char a[8192];
  memset(a, with, sizeof a);
  unsigned sum = 0;
  for (unsigned i = 0; i < sizeof a; i++)
    sum += ((volatile unsigned char *)a)[i];
  return sum == sizeof a * with;
}

static void meet(unsigned round) {
  atomic_fetch_add(&arrived, 1);
  while (atomic_load(&arrived) < round * trax_threads())
    ;
}

int main(void) {
  const unsigned thread = trax_thread();
  atomic_int counter = 0;
  if (thread == 0)
    shared = &counter;
  meet(1);
  if (depth_sum(1000) != 500500 || !own_array((unsigned char)thread))
    trax_atomic_inc(&failures);
  atomic_fetch_add(shared, 1); /* ainc, or a lock: other threads' automatic objects are in reach */
  meet(2);
  atomic_fetch_sub(shared, 3);
  meet(3);
  if (thread == 0) {
    atomic_fetch_add(&counter, 1);
    printf("%d %u %.3f %e\n", atomic_load(&counter), failures, 2.0 / 3, 1e300);
  }
  meet(4);
  return 0;
}
