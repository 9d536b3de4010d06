// RUN: %run_c %s %t --simflags "--config 1x32"
// Numbers of threads, items handed out by the atomic increment, and output that is not torn. (Expected
// output by hand.)
#include <stdio.h>
#include <trax.h>

enum { ITEMS = 500 };
static unsigned next, arrived;
static volatile unsigned char done[ITEMS], seen[256];

int main(void) {
  unsigned thread = trax_thread();
  seen[thread] = (unsigned char)(1 + (trax_tm() ? trax_tp() < thread : trax_tp() == thread));
  for (unsigned i; (i = trax_atomic_inc(&next)) < ITEMS;)
    done[i]++;
  if (thread % 8 == 0)
    printf("one line of text\n");
  if (__atomic_fetch_add(&arrived, 1, __ATOMIC_ACQ_REL) != trax_threads() - 1)
    return 0;
  unsigned all = 0, once = 0;
  for (int i = 0; i < (int)trax_threads(); i++)
    all += seen[i] == 2;
  for (int i = 0; i < ITEMS; i++)
    once += done[i] == 1;
  printf("%u threads, %u items, %u\n", all, once, next);
  return 0;
}
