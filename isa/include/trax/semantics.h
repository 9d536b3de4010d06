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

#ifdef __FAST_MATH__
#error "trax/semantics.h needs strict IEEE arithmetic: do not compile it with -ffast-math"
#endif

#define TRAX_CANONICAL_NAN 0x7FC00000u

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

static inline bool trax_is_nan(uint32_t a) { return (a & 0x7FFFFFFFu) > 0x7F800000u; }
static inline uint32_t trax_canonical(float value) {
  return value != value ? TRAX_CANONICAL_NAN : trax_from_float(value);
}

static inline int32_t trax_signed(uint32_t a) {
  int32_t value;
  memcpy(&value, &a, sizeof value);
  return value;
}
static inline uint32_t trax_sra(uint32_t a, uint32_t shift) {
  return a >> shift | (a >> 31 && shift ? ~0u << (32 - shift) : 0);
}
static inline uint32_t trax_sext8(uint32_t a) { return (a & 0xFFu) - ((a & 0x80u) << 1); }
static inline uint32_t trax_sext16(uint32_t a) { return (a & 0xFFFFu) - ((a & 0x8000u) << 1); }
static inline uint32_t trax_mulh(uint32_t a, uint32_t b) {
  return (uint32_t)((uint64_t)((int64_t)trax_signed(a) * trax_signed(b)) >> 32);
}

static inline uint32_t trax_fadd(uint32_t a, uint32_t b) { return trax_canonical(trax_to_float(a) + trax_to_float(b)); }
static inline uint32_t trax_fsub(uint32_t a, uint32_t b) { return trax_canonical(trax_to_float(a) - trax_to_float(b)); }
static inline uint32_t trax_fmul(uint32_t a, uint32_t b) { return trax_canonical(trax_to_float(a) * trax_to_float(b)); }
static inline uint32_t trax_fdiv(uint32_t a, uint32_t b) { return trax_canonical(trax_to_float(a) / trax_to_float(b)); }

static inline uint32_t trax_feq(uint32_t a, uint32_t b) { return trax_to_float(a) == trax_to_float(b); }
static inline uint32_t trax_flt(uint32_t a, uint32_t b) { return trax_to_float(a) < trax_to_float(b); }
static inline uint32_t trax_fle(uint32_t a, uint32_t b) { return trax_to_float(a) <= trax_to_float(b); }

/* Total order of the numbers, -0 below +0, as unsigned integers. */
static inline uint32_t trax_float_key(uint32_t a) { return a >> 31 ? ~a : a | 0x80000000u; }

/* IEEE 754-2019, 9.6: minimumNumber and maximumNumber. */
static inline uint32_t trax_fmin(uint32_t a, uint32_t b) {
  if (trax_is_nan(a))
    return trax_is_nan(b) ? TRAX_CANONICAL_NAN : b;
  if (trax_is_nan(b))
    return a;
  return trax_float_key(a) < trax_float_key(b) ? a : b;
}
static inline uint32_t trax_fmax(uint32_t a, uint32_t b) {
  if (trax_is_nan(a))
    return trax_is_nan(b) ? TRAX_CANONICAL_NAN : b;
  if (trax_is_nan(b))
    return a;
  return trax_float_key(a) > trax_float_key(b) ? a : b;
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
static inline uint32_t trax_fcvt_s_w(uint32_t a) { return trax_from_float((float)trax_signed(a)); }
static inline uint32_t trax_fcvt_s_wu(uint32_t a) { return trax_from_float((float)a); }

/* Is 1/sqrt(x) greater than the midpoint (2m+1)/2 * 2^e between the binary32 neighbours m * 2^e and (m+1) * 2^e? With
   x = n * 2^k this asks n * (2m+1)^2 * 2^(k+2e-2) < 1, exactly: the integers have at most 24 + 50 bits. */
static inline bool trax_rsqrt_above_midpoint(uint32_t n, int k, uint32_t m, int e) {
  __extension__ typedef unsigned __int128 uint128;
  uint64_t odd = 2 * (uint64_t)m + 1;
  uint128 product = (uint128)(odd * odd) * n;
  int shift = -(k + 2 * e - 2); /* product < 2^shift ? */
  return shift >= 128 || (shift >= 0 && product < (uint128)1 << shift);
}

/* rSqrt of IEEE 754-2019, 9.2, correctly rounded. The binary64 estimate has an error of at most 2 ulp (sqrt and divide,
   each rounded), so the nearest binary32 is certain unless the estimate lies that close to a midpoint; then integers decide. */
static inline uint32_t trax_frsqrt(uint32_t a) {
  if (trax_is_nan(a) || (a >> 31 && a != 0x80000000u))
    return TRAX_CANONICAL_NAN;
  if ((a & 0x7FFFFFFFu) == 0)
    return a | 0x7F800000u;
  if (a == 0x7F800000u)
    return 0;
  double estimate = 1.0 / sqrt((double)trax_to_float(a));
  uint64_t bits;
  memcpy(&bits, &estimate, sizeof bits);
  uint32_t tail = (uint32_t)(bits & 0x1FFFFFFFu); /* below binary32's last bit; the result is never subnormal */
  if (tail - 0x0FFFFFF8u > 0x10u)
    return trax_from_float((float)estimate);

  int exponent = (int)(a >> 23);
  uint32_t n = exponent ? (a & 0x7FFFFFu) | 0x800000u : a;
  int k = (exponent ? exponent : 1) - 150;
  uint32_t m = (uint32_t)(bits >> 29 & 0x7FFFFFu) | 0x800000u;
  int e = (int)(bits >> 52) - 1023 - 23;
  float below = ldexpf((float)m, e);
  uint32_t result = trax_from_float(below);
  return trax_rsqrt_above_midpoint(n, k, m, e) ? result + 1 : result;
}

/* A result of a unit that keeps only `bits` bits of significand (24 = binary32 itself), rounded to nearest even. NaN,
   infinity and subnormals pass unchanged; a carry out of the largest binade gives infinity. */
static inline uint32_t trax_reduce_precision(uint32_t a, unsigned bits) {
  uint32_t exponent = a >> 23 & 0xFFu;
  if (bits >= 24 || exponent == 0xFFu || exponent == 0)
    return a;
  unsigned drop = 24 - bits;
  uint32_t half = 1u << (drop - 1);
  uint32_t odd = a >> drop & 1u;
  return (a + half - 1 + odd) >> drop << drop;
}

#endif
