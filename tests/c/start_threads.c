// clang-format off
// RUN: %run_c %s %t --turns -O0,-O2 --simflags "--set chip.tms=2 --set chip.tps_per_tm=16 --main-on 0 --max-cycles 3000000"
// RUN: %run_c %s %t --levels -O2 --cflags "-mstack=global" --simflags "--set chip.tms=2 --set chip.tps_per_tm=16 --main-on 0 --max-cycles 3000000"
// clang-format on
// main on one thread, which starts the others. (Expected output by hand.)
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <trax.h>

static atomic_uint done, sum;
static int ready;
_Thread_local unsigned initial = 5;

static void work(void) {
  if (ready && initial == 5)
    atomic_fetch_add(&sum, trax_thread());
  atomic_fetch_add(&done, 1);
}

static void at_end(void) {
  printf("the end\n");
}

int main(void) {
  atexit(at_end);
  ready = 1;
  unsigned others = trax_start_threads(work);
  while (atomic_load(&done) != others)
    ;
  printf("%u %u %u\n", others, atomic_load(&sum), trax_start_threads(work));
  return 0;
}
