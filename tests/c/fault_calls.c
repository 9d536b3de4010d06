// RUN: %run_c %s %t --turns -O0,-O2 --cflags -DTARGET=0 --fault execut --fault fault_calls.c:23
// RUN: %run_c %s %t --turns -O0,-O2 --cflags -DTARGET=data --fault execut --fault fault_calls.c:23
// RUN: %run_c %s %t --turns -O0,-O2 --cflags -DTARGET=local --fault execut --fault fault_calls.c:23
// RUN: %run_c %s %t --turns -O0,-O2 --cflags -DTARGET=constants --fault execut --fault fault_calls.c:23
// RUN: %run_c %s %t --turns -O0,-O2 --cflags "-DTARGET=((char*)function+2)" --fault "multiple of 4" \
// RUN:   --fault fault_calls.c:23
// Calls of what is no function: nothing, data, the stack, constants, the middle of an instruction. The report names the
// call.
#include <stdint.h>

static int data[4] = {1};
static const int constants[4] = {2};

__attribute__((noinline)) static int function(void) {
  return data[0] + constants[0];
}

int main(void) {
  volatile int local[2] = {0};
  volatile uintptr_t target = (uintptr_t)TARGET;
  if (function() != 3)
    return local[1];
  int result = ((int (*)(void))target)();
  return result + 1; /* not a tail call: ra stays */
}
