// RUN: %run_c %s %t
// The primes below 10,000.
#include <stdio.h>
#include <string.h>

static unsigned char composite[10000];

int main(void) {
  int count = 0, last = 0;
  for (int i = 2; i < 10000; i++) {
    if (composite[i])
      continue;
    count++;
    last = i;
    for (int j = i * i; j < 10000; j += i)
      composite[j] = 1;
  }
  printf("%d %d\n", count, last);
  return 0;
}
