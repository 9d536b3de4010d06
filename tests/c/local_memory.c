// RUN: %run_c %s %t --turns -O0,-O2,-Os --simflags "--config 2x32 --max-cycles 3000000"
// Local memory: locals and thread-local objects lie in the last 512 bytes, at the same addresses in every thread and
// yet apart, and all of it can be used. (Expected output by hand.)
#include <stdint.h>
#include <stdio.h>
#include <trax.h>

static _Thread_local unsigned own[8];
static unsigned outside, differing, mixed, arrived;
static volatile uintptr_t place, thread_place;

__attribute__((noinline)) static void wait_for(unsigned n) {
  __atomic_fetch_add(&arrived, 1, __ATOMIC_RELEASE);
  while (__atomic_load_n(&arrived, __ATOMIC_ACQUIRE) < n)
    ;
}

/* Fills the memory between the thread-local objects and its own frame, and reads
 * it back after all have. */
__attribute__((noinline)) static unsigned fill(unsigned thread, volatile unsigned *from) {
  volatile unsigned last = 0;
  unsigned sum = 0;
  volatile unsigned *end = &last - 24; /* the frame, and that of wait_for */
  for (volatile unsigned *p = from; p < end; p++)
    *p = thread * 1000 + (unsigned)(p - from);
  wait_for(2 * trax_threads());
  for (volatile unsigned *p = from; p < end; p++)
    sum += *p != thread * 1000 + (unsigned)(p - from);
  return sum + (end - from < 60);
}

int main(void) {
  unsigned thread = trax_thread();
  volatile unsigned local = thread * 3;
  if (thread == 0) {
    place = (uintptr_t)&local;
    thread_place = (uintptr_t)own;
  }
  own[thread % 8] = thread;
  wait_for(trax_threads());
  if ((uintptr_t)&local < 0xFFFFFE00u || (uintptr_t)own != 0xFFFFFE00u)
    trax_atomic_inc(&outside);
  if ((uintptr_t)&local != place || (uintptr_t)own != thread_place)
    trax_atomic_inc(&differing);
  if (local != thread * 3 || own[thread % 8] != thread || own[(thread + 1) % 8] != 0)
    trax_atomic_inc(&mixed);
  if (fill(thread, own + 8))
    trax_atomic_inc(&mixed);
  if (__atomic_fetch_add(&arrived, 1, __ATOMIC_ACQ_REL) == trax_threads() * 3 - 1)
    printf("%u %u %u\n", outside, differing, mixed);
  return 0;
}
