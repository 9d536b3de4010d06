/* fma of binary64: the exact sum in 128 bits, rounded once. */
#include "../builtins/double.h"

#include <math.h>

struct wide {
  uint64_t high, low;
};

static struct wide product(uint64_t a, uint64_t b) {
  uint64_t low = mul_wide(low_word(a), low_word(b));
  uint64_t middle = mul_wide(high_word(a), low_word(b)) + high_word(low);
  uint64_t other = mul_wide(low_word(a), high_word(b)) + low_word(middle);
  return (struct wide){mul_wide(high_word(a), high_word(b)) + high_word(middle) + high_word(other),
                       words(low_word(other), low_word(low))};
}

/* a / 2^n with the lowest bit set if anything but zeros was shifted out. */
static struct wide shifted_right(struct wide a, unsigned n) {
  if (n == 0)
    return a;
  if (n >= 64)
    return (struct wide){0, shift_right_sticky64(a.high, n - 64) | (a.low != 0)};
  return (struct wide){a.high >> n, a.low >> n | a.high << (64 - n) | (a.low << (64 - n) != 0)};
}

static struct wide shifted_left(struct wide a, unsigned n) {
  if (n == 0)
    return a;
  if (n >= 64)
    return (struct wide){a.low << (n - 64), 0};
  return (struct wide){a.high << n | a.low >> (64 - n), a.low << n};
}

static int is_less(struct wide a, struct wide b) {
  return a.high < b.high || (a.high == b.high && a.low < b.low);
}

double fma(double x, double y, double z) {
  uint64_t a = double_bits(x), b = double_bits(y), c = double_bits(z);
  uint32_t sign = double_sign(a ^ b), sign_of_z = double_sign(c);
  a = double_magnitude(a);
  b = double_magnitude(b);
  c = double_magnitude(c);
  if (a >= DOUBLE_INFINITY || b >= DOUBLE_INFINITY || c >= DOUBLE_INFINITY) {
    int infinite = a == DOUBLE_INFINITY || b == DOUBLE_INFINITY;
    if (a > DOUBLE_INFINITY || b > DOUBLE_INFINITY || c > DOUBLE_INFINITY || (infinite && (a == 0 || b == 0)) ||
        (infinite && c == DOUBLE_INFINITY && sign != sign_of_z))
      return bits_double(DOUBLE_NAN);
    return infinite ? bits_double((uint64_t)sign << 63 | DOUBLE_INFINITY) : z;
  }
  if (a == 0 || b == 0)
    return c || sign == sign_of_z ? z : 0.0;
  int ea = double_exponent(a), eb = double_exponent(b);
  /* The leading bit at 125 or 124 of 128, so that a sum has room; the value is significand * 2^(exponent - 1023 - 125).
   */
  struct wide sum = shifted_left(product(normalised_significand(a, &ea), normalised_significand(b, &eb)), 20);
  int exponent = ea + eb - 1023 + 1;
  if (c) {
    int ec = double_exponent(c);
    struct wide other = {normalised_significand(c, &ec) << 9, 0};
    /* The product has 20 zeros below it and z 72: where a shift drops bits, nothing cancels but one leading bit. */
    if (ec > exponent) {
      sum = shifted_right(sum, (unsigned)(ec - exponent));
      exponent = ec;
    } else {
      other = shifted_right(other, (unsigned)(exponent - ec));
    }
    if (sign == sign_of_z) {
      sum.low += other.low;
      sum.high += other.high + (sum.low < other.low);
    } else {
      if (is_less(sum, other)) {
        struct wide t = sum;
        sum = other;
        other = t;
        sign = sign_of_z;
      }
      sum.high -= other.high + (sum.low < other.low);
      sum.low -= other.low;
      if ((sum.high | sum.low) == 0)
        return 0.0;
    }
  }
  unsigned zeros = (unsigned)(sum.high ? leading_zeros64(sum.high) : 64 + leading_zeros64(sum.low));
  /* To bit 126, where trax_round_double wants it in the upper half. */
  sum = shifted_left(sum, zeros);
  sum = shifted_right(sum, 1);
  return trax_round_double(sign, exponent + 2 - (int)zeros, sum.high | (sum.low != 0));
}
