/* Taking doubles apart. */
#ifndef TRAX_RUNTIME_DOUBLE_H
#define TRAX_RUNTIME_DOUBLE_H

#include "builtins.h"

#define FRACTION_MASK 0x000FFFFFFFFFFFFFu
#define HIDDEN_BIT 0x0010000000000000u
#define EXPONENT_SPECIAL 0x7FF /* infinities and NaNs */

INLINE uint32_t double_sign(uint64_t bits) {
  return high_word(bits) >> 31;
}
INLINE int double_exponent(uint64_t bits) {
  return (int)(high_word(bits) >> 20 & 0x7FF);
}
INLINE uint64_t double_magnitude(uint64_t bits) {
  return bits & ~DOUBLE_SIGN;
}
INLINE int is_nan_bits(uint64_t bits) {
  return double_magnitude(bits) > DOUBLE_INFINITY;
}

/* The significand of a finite number with its leading bit moved to bit 52; *exponent, 1 for subnormals on entry or
   their stored 0, is lowered accordingly. The number is not 0. */
INLINE uint64_t normalised_significand(uint64_t bits, int *exponent) {
  uint64_t fraction = bits & FRACTION_MASK;
  if (*exponent)
    return fraction | HIDDEN_BIT;
  int shift = leading_zeros64(fraction) - 11;
  *exponent = 1 - shift;
  return fraction << shift;
}

#endif
