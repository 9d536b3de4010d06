/* The integer square root of two words of 64 bits, for sqrt and scaled numbers. */
#ifndef TRAX_RUNTIME_ROOT128_H
#define TRAX_RUNTIME_ROOT128_H

#include "fixed.h"

/* floor(sqrt(m * 2^64)) for m >= 2^62, word by word (after Zimmermann, "Karatsuba square root", INRIA report 3805,
   1999); *inexact is 0 if that is all. */
INLINE uint64_t root128(uint64_t m, int *inexact) {
  uint32_t high = trax_sqrt64(m);
  uint64_t rest = m - mul_wide(high, high); /* at most 2 high */
  /* The next word is rest * 2^32 / (2 high), or all ones if that is more than a word. */
  uint64_t dividend = rest << 31;
  uint32_t low, remainder_high = 0, remainder;
  if (high_word(dividend) >= high) {
    low = 0xFFFFFFFFu;
    uint64_t r = dividend - mul_wide(low, high);
    remainder = low_word(r);
    remainder_high = high_word(r);
  } else {
    struct divided d = divide_2by1(high_word(dividend), low_word(dividend), high, reciprocal_2by1(high));
    low = d.quotient;
    remainder = d.remainder;
  }
  /* m * 2^64 - root^2 = 2^33 remainder - low^2; one too many if that is negative. */
  uint64_t root = words(high, low);
  uint64_t square = mul_wide(low, low);
  *inexact = 1;
  if (remainder_high == 0 && remainder >> 31 == 0) { /* else the first term is the greater */
    uint64_t first = (uint64_t)remainder << 33;
    root -= first < square;
    *inexact = first != square;
  }
  return root;
}

#endif
