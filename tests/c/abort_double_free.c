// RUN: %run_c %s %t --levels -O0,-O2 --status 134
// RUN: not %trax_sim %t-O2 2>&1 | FileCheck %s
// Freeing twice is found. (Expected output by hand.)
#include <stdlib.h>

static void *volatile memory;

int main(void) {
  memory = malloc(10);
  free(memory);
  // CHECK: free or realloc: not the address of an allocated block
  free(memory);
  return 0;
}
