/* lgamma with 64 significant bits: a polynomial from 1.5 to 2.5, logarithms that lead there, Stirling's series from 8
   on, and the reflection for negative arguments. lgamma's sign is that of gamma. */
#include "coefficients64.h"
#include "scaled.h"

#include <math.h>

_Thread_local int signgam;

/* A number of either sign; magnitude.significand is 0 if it is 0. */
struct number {
  struct scaled magnitude;
  int negative;
};

static const struct scaled two = {DOUBLE_SIGN, 1};

static struct number sum(struct number a, struct number b) {
  if (a.magnitude.significand == 0)
    return b;
  if (b.magnitude.significand == 0)
    return a;
  if (a.negative == b.negative)
    return (struct number){trax_plus(a.magnitude, b.magnitude), a.negative};
  int less = a.magnitude.exponent < b.magnitude.exponent;
  if (a.magnitude.exponent == b.magnitude.exponent) {
    if (a.magnitude.significand == b.magnitude.significand)
      return (struct number){{0, 0}, 0};
    less = a.magnitude.significand < b.magnitude.significand;
  }
  if (less)
    return (struct number){trax_minus(b.magnitude, a.magnitude), b.negative};
  return (struct number){trax_minus(a.magnitude, b.magnitude), a.negative};
}

static struct number logarithm(struct scaled x) {
  struct number result = {{0, 0}, 0};
  if (x.significand != DOUBLE_SIGN || x.exponent != 0)
    result.magnitude = trax_log_scaled(x, &result.negative);
  return result;
}

static struct number negated(struct number a) {
  a.negative = !a.negative;
  return a;
}

/* lgamma(2 + t) for |t| <= 1/2. */
static struct number near_two(struct number t) {
  if (t.magnitude.significand == 0)
    return t;
  int64_t fraction = (int64_t)scaled_fraction(t.magnitude);
  if (fraction < 0) /* 1/2 as Q64 has no sign */
    fraction = INT64_MAX;
  int64_t p =
      trax_signed_polynomial(lgamma_coefficients, LENGTH(lgamma_coefficients), t.negative ? -fraction : fraction);
  return (struct number){trax_times(t.magnitude, normalised((uint64_t)p, 0)), t.negative};
}

static struct number difference(struct scaled a, struct scaled b) {
  return sum((struct number){a, 0}, (struct number){b, 1});
}

/* (x - 1/2) (ln x - 1) + (ln(2 pi) - 1) / 2 + w(x) */
static struct number stirling(struct scaled x) {
  static const struct scaled half = {DOUBLE_SIGN, -1}, rest = {LN_2PI_HALF_64, -1};
  struct scaled product = trax_times(trax_minus(x, half), logarithm(x).magnitude);
  struct scaled inverse = trax_quotient(scaled_one, x), y = trax_times(inverse, inverse);
  uint64_t w = trax_alternating_polynomial(stirling_coefficients, LENGTH(stirling_coefficients), scaled_fraction(y));
  struct scaled total = trax_plus(trax_minus(product, x), rest);
  return (struct number){trax_plus(total, trax_times(inverse, normalised(w, -1))), 0};
}

static struct number lgamma_positive(struct scaled x) {
  if (x.exponent >= 3) /* 8 */
    return stirling(x);
  if (x.exponent < -1) /* gamma(x + 2) / (x (x + 1)) */
    return sum(near_two((struct number){x, 0}), negated(logarithm(trax_times(x, trax_plus(scaled_one, x)))));
  struct number t = difference(x, scaled_one);
  if (t.negative || t.magnitude.significand == 0 || t.magnitude.exponent < -1) { /* from 1/2 to 3/2: gamma(x + 1) / x */
    if (t.magnitude.significand == 0)
      return t;
    struct number log = {trax_log1p_scaled(t.magnitude, t.negative), t.negative};
    return sum(near_two(t), negated(log));
  }
  struct scaled product = scaled_one;
  while (x.exponent > 1 || (x.exponent == 1 && x.significand >= 0xA000000000000000u)) { /* 5/2 */
    x = trax_minus(x, scaled_one);
    product = trax_times(product, x);
  }
  return sum(near_two(difference(x, two)), logarithm(product));
}

/* ln(pi / (x |sin pi x|)) for x not an integer. *odd: sin pi x is negative. */
static struct number reflected(struct scaled x, int *odd) {
  uint64_t fraction = x.exponent < 0 ? scaled_fraction(x) : x.significand << 1 << x.exponent;
  *odd = x.exponent >= 0 && (x.significand >> (63 - x.exponent) & 1);
  struct scaled f = x;
  if (x.exponent >= 0 || fraction >> 63)
    f = normalised(fraction >> 63 ? 0 - fraction : fraction, -1);
  fraction = scaled_fraction(f);
  struct scaled sine;
  uint64_t z = trax_mul_high64(fraction, fraction);
  sine = trax_times(f, normalised(trax_alternating_polynomial(sin_pi_coefficients, LENGTH(sin_pi_coefficients), z), 2));
  static const struct scaled pi = {PI_Q62, 1};
  return logarithm(trax_quotient(pi, trax_times(x, sine)));
}

double lgamma_r(double x, int *sign) {
  uint64_t bits = double_bits(x), m = double_magnitude(bits);
  *sign = 1;
  if (m >= DOUBLE_INFINITY)
    return bits_double(m == DOUBLE_INFINITY ? DOUBLE_INFINITY : DOUBLE_NAN);
  if (m == 0) {
    *sign = double_sign(bits) ? -1 : 1;
    return HUGE_VAL;
  }
  struct scaled n = scaled_of(m);
  struct number result;
  if (!double_sign(bits)) {
    result = lgamma_positive(n);
  } else if (n.exponent < -70) { /* gamma x is 1 / x */
    *sign = -1;
    result = negated(logarithm(n));
  } else {
    if (n.exponent >= 52 || (n.exponent >= 0 && n.significand << 1 << n.exponent == 0)) /* an integer */
      return HUGE_VAL;
    int odd;
    result = reflected(n, &odd);
    *sign = odd ? 1 : -1;
    result = sum(result, negated(lgamma_positive(n)));
  }
  if (result.magnitude.significand == 0)
    return 0;
  return scaled_to_double((uint32_t)result.negative, result.magnitude);
}

double lgamma(double x) {
  return lgamma_r(x, &signgam);
}

/* In binary64: newlib's function of binary32 overflows on the way, and is far off near its zeros. */
float lgammaf_r(float x, int *sign) {
  return (float)lgamma_r((double)x, sign);
}

float lgammaf(float x) {
  return lgammaf_r(x, &signgam);
}
