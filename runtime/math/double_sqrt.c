/* sqrt and fmod of binary64, correctly rounded and exact. */
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

double fmod(double x, double y) {
  uint64_t a = double_bits(x) & ~DOUBLE_SIGN, b = double_bits(y) & ~DOUBLE_SIGN;
  if (a >= DOUBLE_INFINITY || b == 0 || b > DOUBLE_INFINITY)
    return bits_double(DOUBLE_NAN);
  if (a < b)
    return x;
  int ea, eb;
  uint64_t rest = (double_bits(frexp(bits_double(a), &ea)) & 0x000FFFFFFFFFFFFFu) | 0x0010000000000000u;
  uint64_t divisor = (double_bits(frexp(bits_double(b), &eb)) & 0x000FFFFFFFFFFFFFu) | 0x0010000000000000u;
  int distance = ea - eb;
  /* Eleven digits of the quotient at a time: with 53 bits of remainder they fill two words. */
  for (rest %= divisor; distance > 0; rest %= divisor) {
    int step = distance < 11 ? distance : 11;
    rest <<= step;
    distance -= step;
  }
  uint64_t sign_bit = double_bits(x) & DOUBLE_SIGN;
  if (rest == 0)
    return bits_double(sign_bit);
  int zeros = leading_zeros64(rest);
  return trax_round_double((uint32_t)(sign_bit >> 63), eb + 1022 - 53 + 64 - zeros, rest << zeros >> 1);
}
