// RUN: %run_c %s %t --simflags "--config 1x32"
// A spinlock from atomic_flag, and one from exchange and store: what they protect is never torn. (Expected output by
// hand.)
#include <stdatomic.h>
#include <stdio.h>
#include <trax.h>

static atomic_flag flag = ATOMIC_FLAG_INIT;
static atomic_int word;
static volatile unsigned a, b;
static unsigned arrived;

int main(void) {
  for (int i = 0; i < 3; i++) {
    while (atomic_flag_test_and_set(&flag))
      ;
    a++;
    atomic_flag_clear(&flag);
    while (atomic_exchange(&word, 1))
      ;
    b++;
    atomic_store(&word, 0);
  }
  if (__atomic_fetch_add(&arrived, 1, __ATOMIC_ACQ_REL) != trax_threads() - 1)
    return 0;
  printf("%u %u\n", a, b);
  return 0;
}
