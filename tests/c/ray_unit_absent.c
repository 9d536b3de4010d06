// RUN: %run_c %s %t --fault "(this machine has no ray unit)"
// The paper's machine has no ray unit: an instruction that needs one is illegal, and the report says why.
#include <stdio.h>

int main(void) {
  volatile float x = 1;
  printf("before\n");
  printf("%g\n", __builtin_trax_box(x, x, x, x, x, x, x, x, x, x, x, x, x));
  return 0;
}
