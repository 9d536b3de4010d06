#ifndef TRAX_GCD_H
#define TRAX_GCD_H

#include <stdint.h>

/* Returns the greatest common divisor; of a number and 0 the number. */
static inline uint64_t trax_gcd(uint64_t a, uint64_t b) {
  return b ? trax_gcd(b, a % b) : a;
}

#endif
