#include "oracle.h"

#include <assert.h>
#include <stdbool.h>

__extension__ typedef unsigned __int128 uint128;

#define CANONICAL_NAN 0x7FC00000u
#define INFINITY_BITS 0x7F800000u
#define SIGN_BIT 0x80000000u
#define SIGNIFICANT_BITS 24
#define LEAST_EXPONENT (-149) /* of the last place of subnormal numbers and of the least binade */

enum kind { ZERO, FINITE, INFINITE, NOT_A_NUMBER };

/* A FINITE datum is (-1)^negative * significand * 2^exponent exactly, its significand in [2^23, 2^24) for subnormal
 * numbers too. */
struct datum {
  enum kind kind;
  bool negative;
  uint32_t significand;
  int exponent;
};

static struct datum unpack(uint32_t bits) { /* [3.4] */
  uint32_t biased = bits >> 23 & 255, fraction = bits & 0x7FFFFF;
  struct datum d = {FINITE, bits >> 31, fraction, LEAST_EXPONENT};
  if (biased == 255) {
    d.kind = fraction ? NOT_A_NUMBER : INFINITE;
  } else if (biased != 0) {
    d.significand = fraction + 0x800000;
    d.exponent = (int)biased - 1 + LEAST_EXPONENT;
  } else if (fraction == 0) {
    d.kind = ZERO;
  }
  while (d.kind == FINITE && d.significand < 0x800000) {
    d.significand *= 2;
    d.exponent--;
  }
  return d;
}

static uint32_t signed_bits(bool negative, uint32_t magnitude) {
  return negative ? magnitude | SIGN_BIT : magnitude;
}

static int length(uint128 n) {
  uint64_t high = (uint64_t)(n >> 64), low = (uint64_t)n;
  return high ? 128 - __builtin_clzll(high) : low ? 64 - __builtin_clzll(low) : 0;
}

/* The binary32 nearest to (-1)^negative * (significand + t) * 2^exponent, ties to even [4.3.1, 7.4]; t is 0, or with
   `sticky` some number with 0 < t < 1. The significand is not 0, and with `sticky` it has more than 24 bits. */
static uint32_t round_pack(bool negative, int exponent, uint128 significand, bool sticky) {
  assert(significand != 0 && length(significand) <= 126 && (!sticky || length(significand) > SIGNIFICANT_BITS));
  /* The exponent of the result's last place, before rounding. */
  int last = exponent + length(significand) - SIGNIFICANT_BITS;
  if (last < LEAST_EXPONENT)
    last = LEAST_EXPONENT;
  int dropped = last - exponent;
  uint128 kept;
  if (dropped <= 0) { /* exact; at most 24 bits */
    kept = significand << -dropped;
  } else if (dropped > 127) { /* below a quarter of the least subnormal number */
    kept = 0;
  } else {
    uint128 unit = (uint128)1 << dropped, rest = significand & (unit - 1), half = unit / 2;
    kept = significand >> dropped;
    if (rest > half || (rest == half && (sticky || kept % 2 == 1)))
      kept++;
  }
  if (kept == (uint128)1 << SIGNIFICANT_BITS) {
    kept /= 2;
    last++;
  }
  if (last > 127 - (SIGNIFICANT_BITS - 1))
    return signed_bits(negative, INFINITY_BITS);
  if (kept < 0x800000) { /* subnormal, or zero */
    assert(last == LEAST_EXPONENT);
    return signed_bits(negative, (uint32_t)kept);
  }
  return signed_bits(negative, (uint32_t)(last - LEAST_EXPONENT + 1) << 23 | ((uint32_t)kept - 0x800000));
}

/* The sum of two finite numbers that are not zero. */
static uint32_t add_finite(struct datum a, struct datum b) {
  if (a.exponent < b.exponent) {
    struct datum swap = a;
    a = b;
    b = swap;
  }
  /* Beyond this distance b is far less than a quarter of a place of the sum. Any other such number of b's sign has the
     same rounded sum, and this one fits. */
  const int far = 100;
  int distance = a.exponent - b.exponent;
  if (distance > far) {
    distance = far;
    b.significand = 1;
  }
  uint128 x = (uint128)a.significand << distance, y = b.significand;
  int exponent = a.exponent - distance;
  if (a.negative == b.negative)
    return round_pack(a.negative, exponent, x + y, false);
  if (x == y)
    return 0; /* +0 [6.3] */
  return x > y ? round_pack(a.negative, exponent, x - y, false) : round_pack(b.negative, exponent, y - x, false);
}

uint32_t oracle_fadd(uint32_t a, uint32_t b) {
  struct datum x = unpack(a), y = unpack(b);
  if (x.kind == NOT_A_NUMBER || y.kind == NOT_A_NUMBER)
    return CANONICAL_NAN;
  if (x.kind == INFINITE && y.kind == INFINITE)
    return x.negative == y.negative ? a : CANONICAL_NAN;
  if (x.kind == INFINITE || y.kind == INFINITE)
    return x.kind == INFINITE ? a : b;
  if (x.kind == ZERO && y.kind == ZERO)
    return x.negative && y.negative ? SIGN_BIT : 0;
  if (x.kind == ZERO || y.kind == ZERO)
    return x.kind == ZERO ? b : a;
  return add_finite(x, y);
}

uint32_t oracle_fsub(uint32_t a, uint32_t b) { /* a + -b; that turns a NaN's sign too, which shows in no result */
  return oracle_fadd(a, b ^ SIGN_BIT);
}

uint32_t oracle_fmul(uint32_t a, uint32_t b) {
  struct datum x = unpack(a), y = unpack(b);
  bool negative = x.negative != y.negative;
  if (x.kind == NOT_A_NUMBER || y.kind == NOT_A_NUMBER)
    return CANONICAL_NAN;
  if (x.kind == INFINITE || y.kind == INFINITE)
    return x.kind == ZERO || y.kind == ZERO ? CANONICAL_NAN : signed_bits(negative, INFINITY_BITS);
  if (x.kind == ZERO || y.kind == ZERO)
    return signed_bits(negative, 0);
  return round_pack(negative, x.exponent + y.exponent, (uint128)x.significand * y.significand, false);
}

uint32_t oracle_fdiv(uint32_t a, uint32_t b) {
  struct datum x = unpack(a), y = unpack(b);
  bool negative = x.negative != y.negative;
  if (x.kind == NOT_A_NUMBER || y.kind == NOT_A_NUMBER)
    return CANONICAL_NAN;
  if (x.kind == INFINITE)
    return y.kind == INFINITE ? CANONICAL_NAN : signed_bits(negative, INFINITY_BITS);
  if (y.kind == ZERO)
    return x.kind == ZERO ? CANONICAL_NAN : signed_bits(negative, INFINITY_BITS);
  if (x.kind == ZERO || y.kind == INFINITE)
    return signed_bits(negative, 0);
  /* Both significands have 24 bits, so the quotient has 40 or 41. */
  uint64_t dividend = (uint64_t)x.significand << 40;
  return round_pack(negative, x.exponent - y.exponent - 40, dividend / y.significand, dividend % y.significand != 0);
}

/* Makes the exponent even: the significand is then in [2^23, 2^25), and the root of the power of two is one. */
static void make_even(struct datum *d) {
  if (d->exponent % 2 != 0) {
    d->significand *= 2;
    d->exponent--;
  }
}

uint32_t oracle_frsqrt(uint32_t a) {
  struct datum x = unpack(a);
  if (x.kind == NOT_A_NUMBER)
    return CANONICAL_NAN;
  if (x.kind == ZERO)
    return signed_bits(x.negative, INFINITY_BITS);
  if (x.negative)
    return CANONICAL_NAN;
  if (x.kind == INFINITE)
    return 0;
  make_even(&x);
  /* The greatest n with n <= 2^40 / sqrt(significand), that is n^2 * significand <= 2^80, bit by bit; it has 28 or 29
   * bits. */
  const uint128 one = (uint128)1 << 80;
  uint64_t n = 0;
  for (uint64_t bit = (uint64_t)1 << 28; bit != 0; bit /= 2)
    if ((uint128)((n + bit) * (n + bit)) * x.significand <= one)
      n += bit;
  return round_pack(false, -40 - x.exponent / 2, n, (uint128)(n * n) * x.significand != one);
}

uint32_t oracle_fsqrt_rounded(uint32_t a) {
  struct datum x = unpack(a);
  if (x.kind == NOT_A_NUMBER)
    return CANONICAL_NAN;
  if (x.kind == ZERO)
    return a;
  if (x.negative)
    return CANONICAL_NAN;
  if (x.kind == INFINITE)
    return a;
  make_even(&x);
  /* The greatest n with n <= 2^16 * sqrt(significand), bit by bit; it has 28 or 29 bits. */
  uint64_t square = (uint64_t)x.significand << 32, n = 0;
  for (uint64_t bit = (uint64_t)1 << 28; bit != 0; bit /= 2)
    if ((n + bit) * (n + bit) <= square)
      n += bit;
  return round_pack(false, x.exponent / 2 - 16, n, n * n != square);
}

/* A place on a line for each operand that is not a NaN, in its order; zeros next to each other, or one if
 * `zeros_equal`. */
static int64_t place(struct datum d, uint32_t bits, bool zeros_equal) {
  int64_t magnitude = bits & ~SIGN_BIT; /* the encoding ascends with the magnitude [3.4] */
  return !d.negative ? magnitude : zeros_equal ? -magnitude : -magnitude - 1;
}

static uint32_t choose(uint32_t a, uint32_t b, bool greater) {
  struct datum x = unpack(a), y = unpack(b);
  if (x.kind == NOT_A_NUMBER || y.kind == NOT_A_NUMBER)
    return x.kind != NOT_A_NUMBER ? a : y.kind != NOT_A_NUMBER ? b : CANONICAL_NAN;
  return (place(x, a, false) > place(y, b, false)) == greater ? a : b;
}

uint32_t oracle_fmin(uint32_t a, uint32_t b) {
  return choose(a, b, false);
}

uint32_t oracle_fmax(uint32_t a, uint32_t b) {
  return choose(a, b, true);
}

enum relation { LESS, EQUAL, GREATER, UNORDERED }; /* [5.11] */

static enum relation compare(uint32_t a, uint32_t b) {
  struct datum x = unpack(a), y = unpack(b);
  if (x.kind == NOT_A_NUMBER || y.kind == NOT_A_NUMBER)
    return UNORDERED;
  int64_t p = place(x, a, true), q = place(y, b, true);
  return p < q ? LESS : p > q ? GREATER : EQUAL;
}

uint32_t oracle_feq(uint32_t a, uint32_t b) {
  return compare(a, b) == EQUAL;
}

uint32_t oracle_flt(uint32_t a, uint32_t b) {
  return compare(a, b) == LESS;
}

uint32_t oracle_fle(uint32_t a, uint32_t b) {
  enum relation r = compare(a, b);
  return r == LESS || r == EQUAL;
}

/* The integer part of the magnitude, or 2^32 if that is less. */
static uint64_t integer_part(struct datum d) {
  const uint64_t most = (uint64_t)1 << 32;
  if (d.kind == ZERO)
    return 0;
  if (d.kind == INFINITE || d.exponent > 8) /* at least 2^23 * 2^9 */
    return most;
  return d.exponent >= 0 ? (uint64_t)d.significand << d.exponent : d.exponent > -24 ? d.significand >> -d.exponent : 0;
}

uint32_t oracle_fcvt_w_s(uint32_t a) {
  struct datum x = unpack(a);
  if (x.kind == NOT_A_NUMBER)
    return 0;
  uint64_t most = x.negative ? 0x80000000u : 0x7FFFFFFFu, n = integer_part(x);
  n = n < most ? n : most;
  return (uint32_t)(x.negative ? 0 - n : n);
}

uint32_t oracle_fcvt_wu_s(uint32_t a) {
  struct datum x = unpack(a);
  if (x.kind == NOT_A_NUMBER || x.negative)
    return 0;
  uint64_t n = integer_part(x);
  return n < UINT32_MAX ? (uint32_t)n : UINT32_MAX;
}

uint32_t oracle_fcvt_s_w(uint32_t a) {
  bool negative = a >> 31;
  return a == 0 ? 0 : round_pack(negative, 0, negative ? 0 - a : a, false);
}

uint32_t oracle_fcvt_s_wu(uint32_t a) {
  return a == 0 ? 0 : round_pack(false, 0, a, false);
}

uint32_t oracle_reduce(uint32_t value, unsigned bits) {
  struct datum x = unpack(value);
  if (x.kind != FINITE || (value & INFINITY_BITS) == 0) /* the latter: subnormal */
    return value;
  /* As a multiple of the last place of a significand of `bits` bits. */
  uint32_t place = (uint32_t)1 << (SIGNIFICANT_BITS - bits), multiple = x.significand / place,
           rest = x.significand % place;
  if (2 * rest > place || (2 * rest == place && multiple % 2 == 1))
    multiple++;
  return round_pack(x.negative, x.exponent, (uint128)multiple * place, false);
}
