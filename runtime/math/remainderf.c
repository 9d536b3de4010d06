/* fmodf and remainderf, exact. */
#include "fixed.h"

#include <math.h>

float fmodf(float x, float y) {
  uint32_t a = float_bits(x), b = float_bits(y) & ~FLOAT_SIGN;
  uint32_t sign_bit = a & FLOAT_SIGN;
  a &= ~FLOAT_SIGN;
  if (a >= FLOAT_INFINITY || b - 1 >= FLOAT_INFINITY)
    return bits_float(FLOAT_NAN);
  if (a < b)
    return x;
  struct normal n = take_apart(a), d = take_apart(b);
  uint32_t rest = n.significand >> 8, divisor = d.significand >> 8;
  /* Eight digits of the quotient at a time: with 24 bits of remainder they fill a word. The reciprocal is short by less
     than 2, so the quotient by less than 3. */
  uint32_t inverse = reciprocal(divisor);
  int distance = n.exponent - d.exponent;
  for (;;) {
    rest -= mul_high(rest, inverse) * divisor;
    rest -= rest >= divisor ? divisor : 0;
    rest -= rest >= divisor ? divisor : 0;
    if (distance == 0)
      break;
    int step = distance < 8 ? distance : 8;
    rest <<= step;
    distance -= step;
  }
  return rest ? make_float(sign_bit, rest, d.exponent + 8) : bits_float(sign_bit);
}

float remainderf(float x, float y) {
  uint32_t sign_bit = float_bits(x) & FLOAT_SIGN;
  y = fabsf(y);
  if (y < 0x1p127f)
    x = fmodf(x, y + y); /* |x| < 2 y */
  if (x != x || y != y || fabsf(x) == HUGE_VALF)
    return bits_float(FLOAT_NAN);
  x = fabsf(x);
  /* At most one y too much above half, then once more; ties leave the quotient even. Where halving y could round, x is
   * doubled. */
  if (y < 0x1p-120f) {
    if (x + x > y) {
      x -= y;
      if (x + x >= y)
        x -= y;
    }
  } else {
    float half = 0.5f * y;
    if (x > half) {
      x -= y;
      if (x >= half)
        x -= y;
    }
  }
  return bits_float(float_bits(x) ^ sign_bit);
}
