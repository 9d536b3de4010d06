// RUN: %run_c %s %t --simflags "--config 1x32"
// Constructors run once, by priority, before any thread enters main. (Expected output by hand.)
#include <stdio.h>
#include <trax.h>

static volatile int order, early, late;
static unsigned arrived, ready;

__attribute__((constructor(102))) static void second(void) {
  late = ++order;
}
__attribute__((constructor(101))) static void first(void) {
  early = ++order;
}
__attribute__((constructor)) static void third(void) {
  order *= 10;
}

int main(void) {
  if (order == 20)
    trax_atomic_inc(&ready);
  if (__atomic_fetch_add(&arrived, 1, __ATOMIC_ACQ_REL) == trax_threads() - 1)
    printf("%d %d %d %u\n", early, late, order, ready);
  return 0;
}
