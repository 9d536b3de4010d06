// RUN: %run_c %s %t
// RUN: %run_c %s %t --cflags "-mstack=global" --simflags "--set chip.tps_per_tm=4" --levels -O0,-O2
// Expected output by hand.
// A program has no arguments: argc is 0, and argv[0] is the null pointer that ends the list. Each thread may change its
// own.
#include <stdio.h>
#include <trax.h>

_Thread_local int before[3] = {1, 2, 3};

__attribute__((constructor)) static void construct(void) {
  before[1] = 7;
}

int main(int argc, char **argv) {
  static unsigned good;
  int count = 0;
  for (char **p = argv; *p; p++)
    count++;
  char own[4] = "own";
  const int is_empty = argc == 0 && argv[argc] == NULL && count == 0;
  argv[0] = own;
  if (is_empty && argv[0][0] == 'o' && before[2] == 3)
    __atomic_fetch_add(&good, 1, __ATOMIC_RELEASE);
  if (trax_thread() == 0) {
    while (__atomic_load_n(&good, __ATOMIC_ACQUIRE) != trax_threads())
      ;
    printf("no arguments\n");
  }
  return 0;
}
