// RUN: %run_c %s %t
// <trax.h>: reciprocal root, accesses beyond the cache, cycles, counters; builtins as functions. (Expected output by
// hand.)
#include <math.h>
#include <stdio.h>
#include <trax.h>

static unsigned words[4];
/* The function behind the builtin, which the compiler does not let a program name. */
extern float reciprocal_root(float) __asm__("__builtin_trax_rsqrt");
static float (*volatile root)(float) = reciprocal_root;

__attribute__((noinline)) static int is_special(float x, float want) {
  return x == want || (x != x && want != want);
}

int main(void) {
  printf("%d%d%d%d%d%d\n", is_special(trax_rsqrt(4.0f), 0.5f), is_special(trax_rsqrt(0.0f), INFINITY),
         is_special(trax_rsqrt(-0.0f), -INFINITY), is_special(trax_rsqrt(INFINITY), 0),
         is_special(trax_rsqrt(-1.0f), NAN), is_special(root(0.25f), 2.0f));
  trax_store_nt(&words[1], 0xABCD);
  printf("%x %x %u %u %u\n", trax_load_nt(&words[1]), words[1], trax_thread(), trax_threads(), trax_tm() + trax_tp());
  unsigned before = trax_cycles();
  unsigned long long before64 = trax_cycles64();
  volatile int spin = 0;
  for (int i = 0; i < 100; i++)
    spin += i;
  unsigned after = trax_cycles();
  printf("%d %d\n", after - before >= 300, trax_cycles64() - before64 >= 300);
  trax_count_rays(5);
  trax_count_items(1);
  unsigned old = trax_atomic_inc(&words[2]);
  printf("%u %u\n", old, words[2]);
  return 0;
}
