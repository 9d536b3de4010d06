// RUN: %run_c %s %t --levels -O2 --simflags "--config 2x32" --fault "37 (TM 1, TP 5)" --fault fault_thread.c:8
// The report tells which of the threads it was, and the others do not go on for ever.
#include <trax.h>

int main(void) {
  for (;;)
    if (trax_thread() == 37)
      *(volatile int *)(trax_tp() * 4) = 1;
}
