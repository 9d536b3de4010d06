/* The power of two that expf, exp2f and powf end with. */
#include "coefficients.h"
#include "fixed.h"

float trax_exp2_fixed(uint32_t sign_bit, int64_t t) {
  uint32_t fraction = low_word((uint64_t)t);
  /* 2^fraction - 1, Q32 */
  uint32_t above_one = mul_high(polynomial(exp2_coefficients, 8, fraction), fraction);
  return make_float(sign_bit, 0x80000000u | above_one >> 1, (int)(t >> 32) - 31);
}
