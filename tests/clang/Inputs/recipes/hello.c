#include <math.h>
#include <stdio.h>
#include <trax.h>

int sum(int n);

int main(void) {
  if (__builtin_trax_rdsr(TRAX_SR_THREAD) == 0)
    printf("sum %d of %u threads\n", sum(100), trax_threads());
  return sum(100) == 4950 && fabsf(sinf(1.0f)) < 1.0f ? 0 : 1;
}
