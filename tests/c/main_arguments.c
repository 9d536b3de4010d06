// RUN: %run_c %s %t
// RUN: %run_c %s %t --cflags "-mstack=global" --simflags "--set chip.tps_per_tm=4" --turns -O0,-O2
// Expected output by hand.
// Without arguments argc is 1, and argv has the program's name and the null pointer that ends the list.
#include <stdio.h>
#include <string.h>
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
  const int is_name =
      argc == 1 && argv[argc] == NULL && count == 1 && strstr(argv[0], "main_arguments") && !strchr(argv[0], '/');
  if (is_name && before[2] == 3)
    __atomic_fetch_add(&good, 1, __ATOMIC_RELEASE);
  if (trax_thread() == 0) {
    while (__atomic_load_n(&good, __ATOMIC_ACQUIRE) != trax_threads())
      ;
    printf("no arguments\n");
  }
  return 0;
}
