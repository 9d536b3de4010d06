/* atan, atan2, asin and acos with 64 significant bits: of two sides of a triangle the smaller over the greater, q, is
   compared with c = 0, 1/4 .. 1, and the rest of the angle is a polynomial of (q - c) / (1 + c q), whose parts come
   from the sides themselves. */
#include "coefficients64.h"
#include "scaled.h"

#include <math.h>

#define ONE 0x3FF0000000000000u

static const struct scaled pi = {PI_Q62, 1};

/* atan s for s <= 1/8. */
static struct scaled small_atan(struct scaled s) {
  uint64_t fraction = scaled_fraction(s), z = trax_mul_high64(fraction, fraction);
  uint64_t tail = trax_mul_high64(z, trax_alternating_polynomial(atan_coefficients64, LENGTH(atan_coefficients64), z));
  return normalised(s.significand - trax_mul_high64(s.significand, tail), s.exponent);
}

/* atan(n / d) for n <= d. */
static struct scaled atan_of_quotient(struct scaled n, struct scaled d) {
  static const struct scaled quarters[5] = {
      {0, 0}, {DOUBLE_SIGN, -2}, {DOUBLE_SIGN, -1}, {0xC000000000000000u, -1}, {DOUBLE_SIGN, 0}};
  int distance = d.exponent - n.exponent, i = 0;
  if (distance < 4) /* c is the quarter next to n / d */
    while (i < 4 && (n.significand >> 32 >> distance) * 8 >= (d.significand >> 32) * (unsigned)(2 * i + 1))
      i++;
  if (i == 0)
    return small_atan(trax_quotient(n, d));
  struct scaled angle = normalised(atan_table[i], -1), product = trax_times(d, quarters[i]);
  if (n.exponent == product.exponent && n.significand == product.significand)
    return angle;
  int less = n.exponent < product.exponent || (n.exponent == product.exponent && n.significand < product.significand);
  struct scaled rest = less ? trax_minus(product, n) : trax_minus(n, product);
  rest = small_atan(trax_quotient(rest, trax_plus(d, trax_times(n, quarters[i]))));
  return less ? trax_minus(angle, rest) : trax_plus(angle, rest);
}

/* The angle at the origin of (+-x, y), 0 to pi. */
static struct scaled angle_of(struct scaled y, struct scaled x, uint32_t left) {
  int steep = y.exponent > x.exponent || (y.exponent == x.exponent && y.significand > x.significand);
  struct scaled angle = steep ? atan_of_quotient(x, y) : atan_of_quotient(y, x);
  if (steep)
    return left ? trax_plus(times_power(pi, -1), angle) : trax_minus(times_power(pi, -1), angle);
  return left ? trax_minus(pi, angle) : angle;
}

double atan2(double y, double x) {
  uint64_t a = double_bits(y), b = double_bits(x);
  uint32_t sign = double_sign(a), left = double_sign(b);
  a = double_magnitude(a);
  b = double_magnitude(b);
  if (a > DOUBLE_INFINITY || b > DOUBLE_INFINITY)
    return bits_double(DOUBLE_NAN);
  if (a == DOUBLE_INFINITY && b == DOUBLE_INFINITY)
    a = b = ONE;
  if (a == 0 || b == DOUBLE_INFINITY)
    return left ? scaled_to_double(sign, pi) : bits_double((uint64_t)sign << 63);
  if (b == 0 || a == DOUBLE_INFINITY)
    return scaled_to_double(sign, times_power(pi, -1));
  return scaled_to_double(sign, angle_of(scaled_of(a), scaled_of(b), left));
}

double atan(double x) {
  uint64_t bits = double_bits(x), m = double_magnitude(bits);
  if (m < 0x3E40000000000000u) /* 2^-27: x^3/3 is lost in rounding */
    return x;
  if (m >= DOUBLE_INFINITY)
    return m > DOUBLE_INFINITY ? bits_double(DOUBLE_NAN) : scaled_to_double(double_sign(bits), times_power(pi, -1));
  return scaled_to_double(double_sign(bits), angle_of(scaled_of(m), scaled_one, 0));
}

/* sqrt(1 - x^2) for x < 1. */
static struct scaled other_side(struct scaled x) {
  return trax_root(trax_times(trax_minus(scaled_one, x), trax_plus(scaled_one, x)));
}

double asin(double x) {
  uint64_t bits = double_bits(x), m = double_magnitude(bits);
  uint32_t sign = double_sign(bits);
  if (m < 0x3E40000000000000u)
    return x;
  if (m >= ONE)
    return m == ONE ? scaled_to_double(sign, times_power(pi, -1)) : bits_double(DOUBLE_NAN);
  struct scaled n = scaled_of(m);
  return scaled_to_double(sign, angle_of(n, other_side(n), 0));
}

double acos(double x) {
  uint64_t bits = double_bits(x), m = double_magnitude(bits);
  uint32_t left = double_sign(bits);
  if (m >= ONE) {
    if (m > ONE)
      return bits_double(DOUBLE_NAN);
    return left ? scaled_to_double(0, pi) : 0;
  }
  if (m == 0)
    return scaled_to_double(0, times_power(pi, -1));
  struct scaled n = scaled_of(m);
  return scaled_to_double(0, angle_of(other_side(n), n, left));
}
