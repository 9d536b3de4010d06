// RUN: %run_c %s %t
// RUN: %run_c %s %t --levels -O2 --simflags "--config 1x32"
// Functions that run at the end, the latest first, once for all threads; more than fit into the first block. (Expected
// output by hand.)
#include <stdio.h>
#include <stdlib.h>
#include <trax.h>

static int calls;

static void count(void) {
  calls++;
}
static void more(void) {
  printf("more: %d\n", calls);
}
static void last(void) {
  printf("last: %d\n", calls);
  atexit(more);
}
__attribute__((constructor)) static void before(void) {
  printf("before\n");
}
__attribute__((destructor)) static void after(void) {
  printf("after: %d\n", calls);
}

int main(void) {
  if (trax_thread() == trax_threads() / 2) {
    atexit(after);
    for (int i = 0; i < 100; i++)
      if (atexit(count))
        return 1;
    atexit(last);
  }
  return 0;
}
