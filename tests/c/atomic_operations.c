// RUN: %run_c %s %t --simflags "--config 1x32"
// C11 atomics across threads: what becomes the atomic increment, and what the library does under a lock. (Expected
// output by hand.)
#include <stdatomic.h>
#include <stdio.h>
#include <trax.h>

static atomic_uint increments;
static atomic_int sum, greatest;
static _Atomic unsigned long long wide;
static atomic_uchar bytes[4];
static atomic_ushort half;
static unsigned arrived;

int main(void) {
  int thread = (int)trax_thread();
  for (int i = 0; i < 10; i++) {
    atomic_fetch_add(&increments, 1u);
    atomic_fetch_add(&sum, thread);
    atomic_fetch_sub(&sum, 3);
    wide += 0x100000001ull;
    atomic_fetch_add(&bytes[thread & 3], 1);
    atomic_fetch_xor(&half, (unsigned short)(1u << (thread & 15)));
  }
  int known = atomic_load(&greatest);
  while (known < thread && !atomic_compare_exchange_weak(&greatest, &known, thread))
    ;
  if (__atomic_fetch_add(&arrived, 1, __ATOMIC_ACQ_REL) != trax_threads() - 1)
    return 0;
  printf("%u %d %d %llx\n", atomic_load(&increments), atomic_load(&sum), atomic_load(&greatest),
         (unsigned long long)wide);
  printf("%d %d %d %d %x\n", bytes[0], bytes[1], bytes[2], bytes[3], half);
  return 0;
}
