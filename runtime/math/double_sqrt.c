/* sqrt of binary64, correctly rounded. */
#include "fixed.h"

#include <math.h>

double sqrt(double x) {
  uint64_t bits = double_bits(x);
  if (bits << 1 == 0 || bits == DOUBLE_INFINITY)
    return x;
  if (bits > DOUBLE_INFINITY)
    return bits_double(DOUBLE_NAN);
  int exponent;
  uint64_t m = double_bits(frexp(x, &exponent)); /* x = f * 2^exponent with 1/2 <= f < 1 */
  m = (m & 0x000FFFFFFFFFFFFFu) | 0x0010000000000000u;
  int odd = exponent & 1;
  m <<= 11 - odd; /* f * 2^64, halved for an odd exponent: at least 2^62 */
  exponent += odd;
  /* The root of m * 2^64, word by word (after Zimmermann, "Karatsuba square root", INRIA report 3805, 1999). */
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
  int inexact = 1;
  if (remainder_high == 0 && remainder >> 31 == 0) { /* else the first term is the greater */
    uint64_t first = (uint64_t)remainder << 33;
    root -= first < square;
    inexact = first != square;
  }
  return trax_round_double(0, exponent / 2 + 1022, (root >> 1) | (root & 1) | (uint64_t)inexact);
}
