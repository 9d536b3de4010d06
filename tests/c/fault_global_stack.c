// RUN: %run_c %s %t --turns -O0,-O2 --cflags "-mstack=global -mstack-size=5000" --simflags "--set chip.tps_per_tm=4" \
// RUN:   --fault "stack overflow" --fault "fault_global_stack.c:1" --fault "deep" \
// RUN:   --fault "the thread's stack is 0x3fffb4c0 to 0x3fffc87f, 5056 bytes"
// RUN: %run_c %s %t --levels -O1 --cflags "-mstack=global" --simflags "--set chip.tps_per_tm=4 --engine fast" \
// RUN:   --fault "stack overflow" --fault "the thread's stack is 0x3ffcf000 to 0x3ffdefff, 65536 bytes"
// A thread whose stack in global memory is full stops before it reaches its neighbour's: the bytes below take no
// writes.
#include <trax.h>

static volatile int limit = 10000;

__attribute__((noinline)) static int deep(int n);

__attribute__((noinline)) static int step(int n) {
  return n >= limit ? 0 : deep(n + 1) + n;
}

static int deep(int n) {
  volatile int kept[8] = {n};
  return step(n) + kept[0];
}

int main(void) {
  return trax_thread() == 2 ? deep(0) : 0;
}
