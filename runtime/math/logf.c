/* logf, log2f and log10f: the logarithm to base 2 times a constant. */
#include "coefficients.h"
#include "fixed.h"

#include <math.h>

/* For x that is not a positive finite number. */
static float extreme(uint32_t bits) {
  if (bits << 1 == 0)
    return bits_float(FLOAT_SIGN | FLOAT_INFINITY);
  return bits_float(bits == FLOAT_INFINITY ? FLOAT_INFINITY : FLOAT_NAN);
}

/* log2(x) * factor * 2^-scale; a factor of 0 means 2^32. */
static inline __attribute__((always_inline)) float scaled_log2(float x, uint32_t factor, int scale) {
  uint32_t bits = float_bits(x);
  if (bits - 1 >= FLOAT_INFINITY - 1)
    return extreme(bits);
  struct logarithm l = trax_log2_fixed(bits);
  if (l.value == 0)
    return 0;
  uint32_t sign_bit = high_word((uint64_t)l.value) & FLOAT_SIGN;
  uint64_t magnitude = (uint64_t)(sign_bit ? -l.value : l.value);
  int zeros = leading_zeros64(magnitude);
  uint32_t top = high_word(magnitude << zeros);
  return make_float(sign_bit, factor ? mul_high(top, factor) : top, 32 - zeros - l.scale - scale);
}

float log2f(float x) {
  return scaled_log2(x, 0, 0);
}

float logf(float x) {
  return scaled_log2(x, LN_2 >> 32, 0);
}

float log10f(float x) {
  return scaled_log2(x, LOG10_2 >> 32, 1);
}
