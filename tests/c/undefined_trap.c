// RUN: %run_c %s %t --turns -O0,-O2 --cflags "-fsanitize=undefined" --status 134 --fault "undefined_trap.c:8"
// RUN: %run_c %s %t --turns -O0,-O2 --cflags "-ftrapv" --status 134 --fault "undefined_trap.c:8"
// A finding of -fsanitize=undefined stops the machine at its place; there is no library that would print and go on.
#include <limits.h>
static volatile int greatest = INT_MAX;

int main(void) {
  return greatest + 1 == INT_MIN; // overflows
}
