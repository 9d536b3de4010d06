/* Further sequences of pseudo-random numbers: those of POSIX with 48 bits, and glibc's random. */
#include <stdint.h>
#include <stdlib.h>

#include "../internal/machine.h"

/* --- 48 bits: x = a * x + 11 --- */

static unsigned short common[3];

static uint64_t next48(unsigned short state[3]) {
  uint64_t x = (uint64_t)state[2] << 32 | (uint32_t)state[1] << 16 | state[0];
  x = (x * 0x5DEECE66Du + 11) & 0xFFFFFFFFFFFFu;
  for (unsigned i = 0; i < 3; i++)
    state[i] = (unsigned short)(x >> 16 * i);
  return x;
}

double erand48(unsigned short state[3]) {
  return (double)next48(state) * 0x1p-48;
}
long nrand48(unsigned short state[3]) {
  return (long)(next48(state) >> 17);
}
long jrand48(unsigned short state[3]) {
  return (long)(int32_t)(next48(state) >> 16);
}
double drand48(void) {
  return erand48(common);
}
long lrand48(void) {
  return nrand48(common);
}
long mrand48(void) {
  return jrand48(common);
}
void srand48(long seed) {
  common[0] = 0x330E;
  common[1] = (unsigned short)seed;
  common[2] = (unsigned short)(seed >> 16);
}
unsigned short *seed48(unsigned short state[3]) {
  static unsigned short before[3];
  for (unsigned i = 0; i < 3; i++) {
    before[i] = common[i];
    common[i] = state[i];
  }
  return before;
}

/* --- random: x[i] = x[i - 3] + x[i - 31] --- */

enum { TERMS = 31, APART = 3, DISCARDED = 310 };
static uint32_t terms[TERMS];
static unsigned at;
static int seeded;
static struct ticket_lock terms_lock;

static uint32_t next_term(void) {
  uint32_t sum = terms[at] += terms[(at + TERMS - APART) % TERMS];
  at = at + 1 < TERMS ? at + 1 : 0;
  return sum >> 1;
}

static void seed_terms(unsigned seed) {
  int32_t x = seed ? (int32_t)seed : 1;
  for (at = 0; at < TERMS; at++) {
    terms[at] = (uint32_t)x;
    x = 16807 * (x % 127773) - 2836 * (x / 127773);
    x += x < 0 ? 2147483647 : 0;
  }
  at = APART;
  for (unsigned i = 0; i < DISCARDED; i++)
    next_term();
  seeded = 1;
}

void srandom(unsigned seed) {
  lock(&terms_lock);
  seed_terms(seed);
  unlock(&terms_lock);
}

long random(void) {
  lock(&terms_lock);
  if (!seeded)
    seed_terms(1);
  long result = (long)next_term();
  unlock(&terms_lock);
  return result;
}
