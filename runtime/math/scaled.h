/* Numbers of 64 significant bits, for functions of binary64: they compute with integers, which the machine multiplies
   as fast as floats, and round once. Each operation cuts off less than two units of the last of the 64 bits; eleven of
   these bits are beyond a double's. */
#ifndef TRAX_RUNTIME_SCALED_H
#define TRAX_RUNTIME_SCALED_H

#include "../builtins/double.h"
#include "../internal/divide.h"

/* A positive number: significand * 2^(exponent - 63), the significand's top bit set. */
struct scaled {
  uint64_t significand;
  int exponent;
};

static const struct scaled scaled_one = {DOUBLE_SIGN, 0};

/* The magnitude of a finite double, not 0. */
INLINE struct scaled scaled_of(uint64_t magnitude) {
  int exponent = double_exponent(magnitude);
  uint64_t significand = normalised_significand(magnitude, &exponent);
  return (struct scaled){significand << 11, exponent - 1023};
}

/* The significand is not 0. */
INLINE struct scaled normalised(uint64_t significand, int exponent) {
  int zeros = leading_zeros64(significand);
  return (struct scaled){significand << zeros, exponent - zeros};
}

/* a * 2^n. */
INLINE struct scaled times_power(struct scaled a, int n) {
  return (struct scaled){a.significand, a.exponent + n};
}

/* A number below 1 as Q64. */
INLINE uint64_t scaled_fraction(struct scaled a) {
  return a.exponent < -64 ? 0 : a.significand >> (-1 - a.exponent);
}

/* Rounded to a double. */
INLINE double scaled_to_double(uint32_t sign, struct scaled a) {
  return trax_round_double(sign, a.exponent + 1023, a.significand >> 1 | (a.significand & 1));
}

/* floor(a * b / 2^64). */
uint64_t trax_mul_high64(uint64_t a, uint64_t b);
int64_t trax_mul_high64_signed(int64_t a, int64_t b);

struct scaled trax_times(struct scaled a, struct scaled b);
struct scaled trax_plus(struct scaled a, struct scaled b);
/* a - b, for a > b. */
struct scaled trax_minus(struct scaled a, struct scaled b);
struct scaled trax_quotient(struct scaled n, struct scaled d);
struct scaled trax_root(struct scaled a);

#define LENGTH(array) (int)(sizeof(array) / sizeof(array)[0])

/* The polynomial of count coefficients c[0] + c[1] x + ..., x being Q64: all positive; with signs alternating from +;
   with any signs, x from -1/2 to 1/2. */
uint64_t trax_polynomial(const uint64_t *c, int count, uint64_t x);
uint64_t trax_alternating_polynomial(const uint64_t *c, int count, uint64_t x);
int64_t trax_signed_polynomial(const int64_t *c, int count, int64_t x);

/* e^x, or e^-x, for x = whole + fraction * 2^-64 below 2^12. */
struct scaled trax_exp_fixed(uint32_t whole, uint64_t fraction, int negative);
/* The same for x below 2^12. */
struct scaled trax_exp_scaled(struct scaled x, int negative);

/* |ln x| for x != 1; *negative tells its sign. */
struct scaled trax_log_scaled(struct scaled x, int *negative);
/* |ln(1 + x)|, or |ln(1 - x)| for x < 1: relatively exact, however small x is. */
struct scaled trax_log1p_scaled(struct scaled x, int negative);
/* atanh x for x <= 3 - 2 sqrt 2. */
struct scaled trax_small_atanh(struct scaled x);

#endif
