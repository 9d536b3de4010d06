/* The logarithm that logf, log2f, log10f and powf begin with. */
#include "coefficients.h"
#include "fixed.h"

struct logarithm trax_log2_fixed(uint32_t bits) {
  struct normal x = take_apart(bits);
  int exponent = x.exponent + 31; /* x = m * 2^exponent with 1 <= m < 2 */
  uint32_t m = x.significand >> 8;
  uint32_t i = ((x.significand >> 25 & 0x3F) + 1) >> 1; /* nearest 1 + i/32 */
  int32_t r = (int32_t)(m * log2_reciprocal[i] << 4);   /* m * c - 1, Q36, exact: the 1 overflows */
  uint32_t magnitude = (uint32_t)(r < 0 ? -r : r);

  /* log2(1 + r) = r / ln 2 - r^2 P(r) */
  uint64_t linear = mul_high_96(LOG2_E, magnitude); /* Q67 */
  int32_t p = (int32_t)log2_coefficients[5];
  for (int k = 4; k >= 0; k--)
    p = (int32_t)log2_coefficients[k] - (mul_high_signed(p, r) >> 4);
  uint64_t square = mul_high_96(mul_wide(magnitude, magnitude), (uint32_t)p) >> 4; /* Q67 */
  int64_t fraction = (int64_t)((r < 0 ? 0 - linear : linear) - square);

  /* If the integer part and the table's value cancel, only the fraction is left, with all its bits. */
  int64_t whole = (int64_t)(((uint64_t)(int64_t)exponent << 55) + log2_of_reciprocal[i]);
  if (whole == 0)
    return (struct logarithm){fraction, 67};
  return (struct logarithm){whole + (fraction >> 12), 55};
}
