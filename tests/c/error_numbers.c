// RUN: %run_c %s %t --turns -O0,-O2 --simflags "--config 1x32 --max-cycles 3000000"
// errno and the random sequence belong to the thread. (Expected output by hand.)
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <trax.h>

static const char *const texts[] = {"12", "99999999999", "-99999999999", "7"};
static volatile int sequence[256];
static unsigned wrong, arrived;

int main(void) {
  unsigned thread = trax_thread();
  long value = strtol(texts[thread % 4], NULL, 10);
  int range = thread % 4 == 1 || thread % 4 == 2;
  static const long values[] = {12, 2147483647, -2147483647 - 1, 7};
  srand(thread / 2 + 5);
  for (int i = 0; i < 3; i++)
    sequence[thread] = rand();
  __atomic_fetch_add(&arrived, 1, __ATOMIC_RELEASE);
  while (__atomic_load_n(&arrived, __ATOMIC_ACQUIRE) < trax_threads())
    ;
  /* All have set theirs by now. */
  if (errno != (range ? ERANGE : 0) || value != values[thread % 4])
    trax_atomic_inc(&wrong);
  if ((sequence[thread] == sequence[thread ^ 1]) + (sequence[thread] != sequence[thread ^ 2]) != 2)
    trax_atomic_inc(&wrong);
  if (__atomic_fetch_add(&arrived, 1, __ATOMIC_ACQ_REL) == 2 * trax_threads() - 1)
    printf("%u\n", wrong);
  return 0;
}
