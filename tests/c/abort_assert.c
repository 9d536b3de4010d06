// RUN: %run_c %s %t --levels -O0,-O2 --status 134
// RUN: not %trax_sim %t-O2 2>&1 | FileCheck %s
// A false assertion stops the machine and shows its place. (Expected output by hand.)
#include <assert.h>
#include <stdio.h>

static volatile int two = 2;

int main(void) {
  puts("before");
  assert(two == 2);
  // CHECK: abort_assert.c:[[@LINE+1]]: assertion failed: two + two == 5
  assert(two + two == 5);
  puts("after");
  return 0;
}
