// RUN: %run_c %s %t --simflags "--config 1x32"
// RUN: %run_c %s %t --turns -O0,-O2 --cflags "-mstack=global" --simflags "--config 1x32"
// Initialised thread-local objects: every thread finds the values, and changes its own. (Expected output by hand.)
#include <stdatomic.h>
#include <stdio.h>
#include <trax.h>

static int target;
static _Thread_local int number = 17;
_Thread_local char text[7] = "values";
static _Thread_local int *pointer = &target;
static _Thread_local double fraction = 0.5;
static _Thread_local struct {
  short a;
  char b;
  long long c;
} record = {-2, 'x', 1234567890123};
static _Thread_local int zero;
static atomic_uint right, arrived;

int main(void) {
  const int thread = (int)trax_thread();
  int good = number == 17 && text[0] == 'v' && text[6] == 0 && pointer == &target && fraction == 0.5 && zero == 0 &&
             record.a == -2 && record.b == 'x' && record.c == 1234567890123;
  number += thread;
  text[0] = (char)('a' + thread % 20);
  zero -= thread;
  atomic_fetch_add(&arrived, 1);
  while (atomic_load(&arrived) < trax_threads())
    ;
  if (good && number == 17 + thread && text[0] == 'a' + thread % 20 && zero == -thread)
    atomic_fetch_add(&right, 1);
  while (thread == 0 && atomic_load(&right) < trax_threads())
    ;
  if (thread == 0)
    printf("%u\n", atomic_load(&right));
  return 0;
}
