/* Arithmetic of numbers of 64 significant bits. */
#include "scaled.h"
#include "root128.h"

uint64_t trax_mul_high64(uint64_t a, uint64_t b) {
  uint64_t middle = mul_wide(high_word(a), low_word(b)) + mul_high(low_word(a), low_word(b));
  uint64_t other = mul_wide(low_word(a), high_word(b)) + low_word(middle);
  return mul_wide(high_word(a), high_word(b)) + high_word(middle) + high_word(other);
}

int64_t trax_mul_high64_signed(int64_t a, int64_t b) {
  uint64_t product = trax_mul_high64((uint64_t)a, (uint64_t)b);
  return (int64_t)(product - (a < 0 ? (uint64_t)b : 0) - (b < 0 ? (uint64_t)a : 0));
}

uint64_t trax_polynomial(const uint64_t *c, int count, uint64_t x) {
  uint64_t p = c[count - 1];
  for (int i = count - 2; i >= 0; i--)
    p = c[i] + trax_mul_high64(p, x);
  return p;
}

uint64_t trax_alternating_polynomial(const uint64_t *c, int count, uint64_t x) {
  uint64_t p = c[count - 1];
  for (int i = count - 2; i >= 0; i--)
    p = c[i] - trax_mul_high64(p, x);
  return p;
}

int64_t trax_signed_polynomial(const int64_t *c, int count, int64_t x) {
  int64_t p = c[count - 1];
  for (int i = count - 2; i >= 0; i--)
    p = c[i] + trax_mul_high64_signed(p, x);
  return p;
}

struct scaled trax_times(struct scaled a, struct scaled b) {
  uint64_t product = trax_mul_high64(a.significand, b.significand);
  int low = !(product >> 63);
  return (struct scaled){product << low, a.exponent + b.exponent + 1 - low};
}

struct scaled trax_plus(struct scaled a, struct scaled b) {
  struct scaled more = a.exponent >= b.exponent ? a : b, less = a.exponent >= b.exponent ? b : a;
  int distance = more.exponent - less.exponent;
  if (distance > 63)
    return more;
  uint64_t sum = more.significand + (less.significand >> distance);
  if (sum >= more.significand)
    return (struct scaled){sum, more.exponent};
  return (struct scaled){sum >> 1 | DOUBLE_SIGN, more.exponent + 1};
}

struct scaled trax_minus(struct scaled a, struct scaled b) {
  int distance = a.exponent - b.exponent;
  return distance > 63 ? a : normalised(a.significand - (b.significand >> distance), a.exponent);
}

struct scaled trax_quotient(struct scaled n, struct scaled d) {
  uint32_t v = reciprocal_3by2(d.significand);
  struct divided_3by2 first = divide_3by2(n.significand >> 1, (uint32_t)n.significand << 31, d.significand, v);
  struct divided_3by2 second = divide_3by2(first.remainder, 0, d.significand, v);
  uint64_t q = words(first.quotient, second.quotient); /* of n / 2d: bit 63 or 62 leads */
  int low = !(q >> 63);
  return (struct scaled){q << low, n.exponent - d.exponent - low};
}

struct scaled trax_root(struct scaled a) {
  int inexact, even = !(a.exponent & 1);
  return (struct scaled){root128(a.significand >> even, &inexact), (a.exponent - !even) / 2};
}
