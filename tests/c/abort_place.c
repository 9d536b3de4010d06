// RUN: %run_c %s %t --levels -O0,-O2 --status 134
// RUN: not %trax_sim %t-O0 2>&1 | FileCheck %s
// RUN: not %trax_sim %t-O2 2>&1 | FileCheck %s
// abort() stops the machine: earlier output is there, and the report names the call.
// (Expected output by hand.)
#include <stdio.h>
#include <stdlib.h>

static volatile int bad = 1;

int main(void) {
  puts("before");
  if (bad)
    // CHECK: before
    // CHECK: trax-sim: fault: {{.*}}abort
    // CHECK: abort_place.c:[[@LINE+1]]
    abort();
  puts("after");
  return 0;
}
