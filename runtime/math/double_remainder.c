/* fmod, remainder and remquo of binary64, exact: long division of the significands. */
#include "../builtins/double.h"

#include <math.h>

struct division {
  uint64_t rest, divisor; /* significands in units of 2^(exponent - 1075) */
  int exponent;
  uint32_t quotient; /* its low 32 bits */
};

/* Divides |x| by |y|, both finite and not 0; the rest is less than the divisor. A quotient of 0 may have the rest in
   smaller units than y's last place. */
static struct division divided(uint64_t a, uint64_t b) {
  struct division d = {0};
  int ea = double_exponent(a), eb = double_exponent(b);
  d.rest = normalised_significand(a, &ea);
  d.divisor = normalised_significand(b, &eb);
  int distance = ea - eb;
  d.exponent = eb;
  if (distance == -1) { /* |y| may still be less than 2 |x| */
    d.divisor <<= 1;
    d.exponent--;
    distance = 0;
  }
  for (;;) {
    uint64_t q = d.rest / d.divisor;
    d.rest -= q * d.divisor;
    d.quotient += (uint32_t)q;
    if (distance == 0)
      return d;
    int step = distance < 11 ? distance : 11; /* with 53 bits of remainder they fill two words */
    d.rest <<= step;
    d.quotient <<= step;
    distance -= step;
  }
}

static double packed(uint64_t sign_bit, const struct division *d) {
  if (d->rest == 0)
    return bits_double(sign_bit);
  int zeros = leading_zeros64(d->rest);
  return trax_round_double((uint32_t)(sign_bit >> 63), d->exponent + 11 - zeros, d->rest << zeros >> 1);
}

static int is_invalid(uint64_t a, uint64_t b) {
  return a >= DOUBLE_INFINITY || b == 0 || b > DOUBLE_INFINITY;
}

double fmod(double x, double y) {
  uint64_t a = double_magnitude(double_bits(x)), b = double_magnitude(double_bits(y));
  if (is_invalid(a, b))
    return bits_double(DOUBLE_NAN);
  if (a < b)
    return x;
  struct division d = divided(a, b);
  return packed(double_bits(x) & DOUBLE_SIGN, &d);
}

double remquo(double x, double y, int *quotient) {
  uint64_t a = double_magnitude(double_bits(x)), b = double_magnitude(double_bits(y));
  *quotient = 0;
  if (is_invalid(a, b))
    return bits_double(DOUBLE_NAN);
  if (a == 0 || b == DOUBLE_INFINITY || double_exponent(a) + 54 < double_exponent(b))
    return x;
  int ea = double_exponent(a), eb = double_exponent(b);
  normalised_significand(a, &ea);
  normalised_significand(b, &eb);
  if (ea < eb - 1)
    return x;
  uint64_t sign_bit = double_bits(x) & DOUBLE_SIGN;
  struct division d = divided(a, b);
  if (2 * d.rest > d.divisor || (2 * d.rest == d.divisor && d.quotient & 1)) {
    d.rest = d.divisor - d.rest;
    d.quotient++;
    sign_bit ^= DOUBLE_SIGN;
    if (d.rest == 0)
      sign_bit ^= DOUBLE_SIGN;
  }
  if (d.rest == 0)
    sign_bit = double_bits(x) & DOUBLE_SIGN;
  int low = (int)(d.quotient & 0x7FFFFFFF);
  *quotient = (double_bits(x) ^ double_bits(y)) >> 63 ? -low : low;
  return packed(sign_bit, &d);
}

double remainder(double x, double y) {
  int quotient;
  return remquo(x, y, &quotient);
}

/* Exact in binary64, and the result is a float. */
float remquof(float x, float y, int *quotient) {
  return (float)remquo((double)x, (double)y, quotient);
}
