// RUN: %run_c %s %t --turns -O0,-O2 --fault "fault_local_atomic.c:8"
// The atomic increment works in global memory only.
#include <trax.h>

int main(void) {
  unsigned local = 0;
  unsigned *volatile p = &local;
  return (int)trax_atomic_inc(p);
}
