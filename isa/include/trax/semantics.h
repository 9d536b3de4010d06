/* Arithmetic of the TP ISA on register words: what the semantics in isa/TraxInstructions.td call.

   Floats are IEEE 754-2019 binary32 in the bits of a uint32_t: round to nearest even, subnormals kept, and every NaN
   result is the canonical quiet NaN 0x7FC00000. The host must compute binary32 without contraction or excess precision
   (x86-64 SSE, AArch64; cmake/TraxOptions.cmake sets -ffp-contract=off). */
#ifndef TRAX_SEMANTICS_H
#define TRAX_SEMANTICS_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* The compiler's flags that macros show; tests/isa/oracle/builds.py looks at the flags themselves. */
#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) ||                         \
    defined(__NO_SIGNED_ZEROS__) || __FINITE_MATH_ONLY__
#error "trax/semantics.h needs strict IEEE arithmetic: do not compile it with -ffast-math or parts of it"
#endif
#if __FLT_EVAL_METHOD__ != 0
#error "trax/semantics.h needs binary32 without excess precision: do not compile it for the x87"
#endif

#define TRAX_CANONICAL_NAN 0x7FC00000u

/* Subnormal operands: processors of one maker (Intel) take an assist of microcode, some 40 ns, for a multiplication,
   division, square root or widening of one, so these go other ways below. Additions, comparisons and conversions from
   and to integers take none there, and no result of the latter is subnormal. A subnormal result of normal operands
   takes one, too; it is rare. */

static inline float trax_to_float(uint32_t bits) {
  float value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

static inline uint32_t trax_from_float(float value) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  return bits;
}

static inline bool trax_is_nan(uint32_t a) {
  return (a & 0x7FFFFFFFu) > 0x7F800000u;
}
/* A NaN is rare. The empty statement keeps compilers from choosing without a branch: each result would wait for that.
 */
static inline uint32_t trax_canonical(float value) {
  if (__builtin_expect(value != value, 0)) {
    __asm__ volatile("");
    return TRAX_CANONICAL_NAN;
  }
  return trax_from_float(value);
}

static inline int32_t trax_signed(uint32_t a) {
  int32_t value;
  memcpy(&value, &a, sizeof value);
  return value;
}
static inline uint32_t trax_sra(uint32_t a, uint32_t shift) {
  return a >> shift | (a >> 31 && shift ? ~0u << (32 - shift) : 0);
}
static inline uint32_t trax_sext8(uint32_t a) {
  return (a & 0xFFu) - ((a & 0x80u) << 1);
}
static inline uint32_t trax_sext16(uint32_t a) {
  return (a & 0xFFFFu) - ((a & 0x8000u) << 1);
}
static inline uint32_t trax_mulh(uint32_t a, uint32_t b) {
  return (uint32_t)((uint64_t)((int64_t)trax_signed(a) * trax_signed(b)) >> 32);
}

static inline uint32_t trax_fadd(uint32_t a, uint32_t b) {
  return trax_canonical(trax_to_float(a) + trax_to_float(b));
}
static inline uint32_t trax_fsub(uint32_t a, uint32_t b) {
  return trax_canonical(trax_to_float(a) - trax_to_float(b));
}
/* The value of a number, infinity or NaN in binary64. A subnormal number or 0 is converted from its integer. */
static inline double trax_widen(uint32_t a) {
  if ((a & 0x7F800000u) != 0)
    return (double)trax_to_float(a);
  const double magnitude = (double)(int32_t)(a & 0x7FFFFFu) * 0x1p-149;
  return a >> 31 ? -magnitude : magnitude;
}

/* The product of a subnormal number or 0 and any other. If the other factor is large enough, it takes over the power of
   two. Else the product goes through binary64, which holds it exactly, so it is rounded once. */
static inline uint32_t trax_fmul_subnormal(uint32_t a, uint32_t b) {
  if (2 * b - (300u << 23) < 210u << 23) { /* 2^23 <= |b| < infinity */
    const uint32_t scaled = (b - (149u << 23)) ^ (a & 0x80000000u);
    return trax_from_float((float)(int32_t)(a & 0x7FFFFFu) * trax_to_float(scaled));
  }
  return trax_canonical((float)(trax_widen(a) * trax_widen(b)));
}
static inline uint32_t trax_fmul(uint32_t a, uint32_t b) {
  if (__builtin_expect((a & 0x7F800000u) == 0, 0))
    return trax_fmul_subnormal(a, b);
  if (__builtin_expect((b & 0x7F800000u) == 0, 0))
    return trax_fmul_subnormal(b, a);
  return trax_canonical(trax_to_float(a) * trax_to_float(b));
}
/* A quotient of a subnormal number or 0 goes through binary64, too. Rounding it twice is exact: it is the middle of two
   binary32 numbers, or at least 2^-48 of itself away from it. */
static inline uint32_t trax_fdiv(uint32_t a, uint32_t b) {
  if (__builtin_expect((a & 0x7F800000u) == 0 || (b & 0x7F800000u) == 0, 0))
    return trax_canonical((float)(trax_widen(a) / trax_widen(b)));
  return trax_canonical(trax_to_float(a) / trax_to_float(b));
}

static inline uint32_t trax_feq(uint32_t a, uint32_t b) {
  return trax_to_float(a) == trax_to_float(b);
}
static inline uint32_t trax_flt(uint32_t a, uint32_t b) {
  return trax_to_float(a) < trax_to_float(b);
}
static inline uint32_t trax_fle(uint32_t a, uint32_t b) {
  return trax_to_float(a) <= trax_to_float(b);
}

/* IEEE 754-2019, 9.6: minimumNumber and maximumNumber, with -0 below +0. Most operands are numbers that differ. */
static inline uint32_t trax_fmin(uint32_t a, uint32_t b) {
  const float x = trax_to_float(a), y = trax_to_float(b);
  if (__builtin_expect(__builtin_islessgreater(x, y), 1))
    return trax_from_float(x < y ? x : y);
  if (trax_is_nan(a))
    return trax_is_nan(b) ? TRAX_CANONICAL_NAN : b;
  return trax_is_nan(b) ? a : a | b;
}
static inline uint32_t trax_fmax(uint32_t a, uint32_t b) {
  const float x = trax_to_float(a), y = trax_to_float(b);
  if (__builtin_expect(__builtin_islessgreater(x, y), 1))
    return trax_from_float(x > y ? x : y);
  if (trax_is_nan(a))
    return trax_is_nan(b) ? TRAX_CANONICAL_NAN : b;
  return trax_is_nan(b) ? a : a & b;
}

static inline uint32_t trax_fcvt_w_s(uint32_t a) {
  if (trax_is_nan(a))
    return 0;
  float value = trax_to_float(a);
  if (value >= 2147483648.0f)
    return 0x7FFFFFFFu;
  if (value < -2147483648.0f)
    return 0x80000000u;
  return (uint32_t)(int32_t)value;
}
static inline uint32_t trax_fcvt_wu_s(uint32_t a) {
  if (trax_is_nan(a))
    return 0;
  float value = trax_to_float(a);
  if (value >= 4294967296.0f)
    return 0xFFFFFFFFu;
  if (value <= 0.0f)
    return 0;
  return (uint32_t)value;
}
static inline uint32_t trax_fcvt_s_w(uint32_t a) {
  return trax_from_float((float)trax_signed(a));
}
static inline uint32_t trax_fcvt_s_wu(uint32_t a) {
  return trax_from_float((float)a);
}

/* rSqrt of IEEE 754-2019, 9.2, correctly rounded. Rounding the binary64 estimate once more is exact for every binary32
   operand: no reciprocal root lies so near a midpoint (isa-exhaustive compares all of them with integers). */
static inline uint32_t trax_frsqrt(uint32_t a) {
  if (trax_is_nan(a) || (a >> 31 && a != 0x80000000u))
    return TRAX_CANONICAL_NAN;
  if ((a & 0x7FFFFFFFu) == 0)
    return a | 0x7F800000u;
  return trax_from_float((float)(1.0 / sqrt(trax_widen(a))));
}

/* A result of a unit that keeps only `bits` bits of significand, 1 to 24 (24 = binary32 itself), rounded to nearest
   even; a tie at one bit, where neither neighbour is even, goes to the greater magnitude (IEEE 754-2019, 4.3.1). NaN,
   infinity and subnormals pass unchanged; a carry out of the largest binade gives infinity. */
static inline uint32_t trax_reduce_precision(uint32_t a, unsigned bits) {
  uint32_t exponent = a >> 23 & 0xFFu;
  if (bits >= 24 || exponent == 0xFFu || exponent == 0)
    return a;
  unsigned drop = 24 - bits;
  uint32_t half = 1u << (drop - 1);
  uint32_t odd = (a | 0x800000u) >> drop & 1u; /* the leading bit, which the encoding leaves out, is the last of one */
  return (a + half - 1 + odd) >> drop << drop;
}

#endif
