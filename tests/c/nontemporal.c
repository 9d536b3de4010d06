// RUN: %run_c %s %t
// Accesses that go around the data cache and ordinary ones see each other; words and floats. (Expected output by hand.)
#include <stdio.h>
#include <trax.h>

static _Alignas(64) unsigned words[32];
static _Alignas(64) float floats[16];

int main(void) {
  unsigned wrong = 0;
  for (unsigned i = 0; i < 32; i++)
    wrong += words[i]; /* now cached */
  for (unsigned i = 0; i < 32; i++) {
    __builtin_nontemporal_store(i * 7, &words[i]);
    wrong += ((volatile unsigned *)words)[i] != i * 7;
    ((volatile unsigned *)words)[i] = i * 9;
    wrong += __builtin_nontemporal_load(&words[i]) != i * 9;
  }
  for (int i = 0; i < 16; i++)
    __builtin_nontemporal_store((float)i * 0.5f, &floats[i]);
  float sum = 0;
  for (int i = 0; i < 16; i++)
    sum += floats[i] + __builtin_nontemporal_load(&floats[15 - i]);
  printf("%u %g\n", wrong, (double)sum);
  return 0;
}
