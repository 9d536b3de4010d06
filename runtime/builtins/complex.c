/* Complex products and quotients, with C's rules for infinities (C17 annex G.5.1). The quotient computes with
   significands and keeps their exponents apart, so that nothing overflows or vanishes on the way: each of its parts is
   within a few units of the true one, as far as that does not cancel. */
#include "double.h"

/* The exponent of 0 for these functions. Results do not depend on it. */
#define EXPONENT_OF_ZERO (-10000)

#define COMPLEX_ARITHMETIC(suffix, type, fabs_, copysign_, inf_, split, power, scaled)                                 \
  static inline int is_infinite_##suffix(type x) {                                                                     \
    return fabs_(x) == inf_;                                                                                           \
  }                                                                                                                    \
  static inline type boxed_##suffix(type x) {                                                                          \
    return copysign_(is_infinite_##suffix(x) ? 1 : 0, x);                                                              \
  }                                                                                                                    \
  _Complex type __mul##suffix##c3(type a, type b, type c, type d);                                                     \
  _Complex type __div##suffix##c3(type a, type b, type c, type d);                                                     \
                                                                                                                       \
  _Complex type __mul##suffix##c3(type a, type b, type c, type d) {                                                    \
    type ac = a * c, bd = b * d, ad = a * d, bc = b * c;                                                               \
    type x = ac - bd, y = ad + bc;                                                                                     \
    if (x != x && y != y) { /* NaNs may hide infinities */                                                             \
      int recalculate = 0;                                                                                             \
      if (is_infinite_##suffix(a) || is_infinite_##suffix(b)) {                                                        \
        a = boxed_##suffix(a);                                                                                         \
        b = boxed_##suffix(b);                                                                                         \
        c = c != c ? copysign_(0, c) : c;                                                                              \
        d = d != d ? copysign_(0, d) : d;                                                                              \
        recalculate = 1;                                                                                               \
      }                                                                                                                \
      if (is_infinite_##suffix(c) || is_infinite_##suffix(d)) {                                                        \
        c = boxed_##suffix(c);                                                                                         \
        d = boxed_##suffix(d);                                                                                         \
        a = a != a ? copysign_(0, a) : a;                                                                              \
        b = b != b ? copysign_(0, b) : b;                                                                              \
        recalculate = 1;                                                                                               \
      }                                                                                                                \
      if (!recalculate && (is_infinite_##suffix(ac) || is_infinite_##suffix(bd) || is_infinite_##suffix(ad) ||         \
                           is_infinite_##suffix(bc))) {                                                                \
        a = a != a ? copysign_(0, a) : a;                                                                              \
        b = b != b ? copysign_(0, b) : b;                                                                              \
        c = c != c ? copysign_(0, c) : c;                                                                              \
        d = d != d ? copysign_(0, d) : d;                                                                              \
        recalculate = 1;                                                                                               \
      }                                                                                                                \
      if (recalculate) {                                                                                               \
        x = inf_ * (a * c - b * d);                                                                                    \
        y = inf_ * (a * d + b * c);                                                                                    \
      }                                                                                                                \
    }                                                                                                                  \
    return __builtin_complex(x, y);                                                                                    \
  }                                                                                                                    \
                                                                                                                       \
  /* A sum of two significands that have exponents of their own; *exponent becomes the sum's. A number 100 bits below  \
     the other has no effect. */                                                                                       \
  static inline type sum_##suffix(type p, int p_exponent, type q, int q_exponent, int *exponent) {                     \
    *exponent = p_exponent > q_exponent ? p_exponent : q_exponent;                                                     \
    int p_shift = p_exponent - *exponent, q_shift = q_exponent - *exponent;                                            \
    if (p_shift)                                                                                                       \
      p *= power(p_shift < -100 ? -100 : p_shift);                                                                     \
    if (q_shift)                                                                                                       \
      q *= power(q_shift < -100 ? -100 : q_shift);                                                                     \
    return p + q;                                                                                                      \
  }                                                                                                                    \
                                                                                                                       \
  _Complex type __div##suffix##c3(type a, type b, type c, type d) {                                                    \
    int ea, eb, ec, ed, ex, ey, e;                                                                                     \
    type sa = split(a, &ea), sb = split(b, &eb), sc = split(c, &ec), sd = split(d, &ed);                               \
    type denominator = sum_##suffix(sc * sc, 2 * ec, sd * sd, 2 * ed, &e);                                             \
    type x = sum_##suffix(sa * sc, ea + ec, sb * sd, eb + ed, &ex) / denominator;                                      \
    type y = sum_##suffix(sb * sc, eb + ec, -(sa * sd), ea + ed, &ey) / denominator;                                   \
    x = scaled(x, ex - e);                                                                                             \
    y = scaled(y, ey - e);                                                                                             \
    if (x != x && y != y) {                                                                                            \
      if (denominator == 0 && (a == a || b == b)) {                                                                    \
        x = copysign_(inf_, c) * a;                                                                                    \
        y = copysign_(inf_, c) * b;                                                                                    \
      } else if ((is_infinite_##suffix(a) || is_infinite_##suffix(b)) && fabs_(c) < inf_ && fabs_(d) < inf_) {         \
        a = boxed_##suffix(a);                                                                                         \
        b = boxed_##suffix(b);                                                                                         \
        x = inf_ * (a * c + b * d);                                                                                    \
        y = inf_ * (b * c - a * d);                                                                                    \
      } else if ((is_infinite_##suffix(c) || is_infinite_##suffix(d)) && fabs_(a) < inf_ && fabs_(b) < inf_) {         \
        c = boxed_##suffix(c);                                                                                         \
        d = boxed_##suffix(d);                                                                                         \
        x = 0 * (a * c + b * d);                                                                                       \
        y = 0 * (b * c - a * d);                                                                                       \
      }                                                                                                                \
    }                                                                                                                  \
    return __builtin_complex(x, y);                                                                                    \
  }

INLINE float fabs_s(float x) {
  return bits_float(float_bits(x) & ~FLOAT_SIGN);
}
INLINE float copysign_s(float x, float y) {
  return bits_float((float_bits(x) & ~FLOAT_SIGN) | (float_bits(y) & FLOAT_SIGN));
}
INLINE double fabs_d(double x) {
  return bits_double(double_magnitude(double_bits(x)));
}
INLINE double copysign_d(double x, double y) {
  return bits_double(double_magnitude(double_bits(x)) | (double_bits(y) & DOUBLE_SIGN));
}

/* The significand of x, of magnitude 1 to 2, and its exponent; infinities and NaNs are their own, with exponent 0. */
INLINE float split_s(float x, int *exponent) {
  uint32_t bits = float_bits(x), magnitude = bits & ~FLOAT_SIGN;
  *exponent = magnitude ? 0 : EXPONENT_OF_ZERO;
  if (magnitude == 0 || magnitude >= FLOAT_INFINITY)
    return x;
  int shift = magnitude >> 23 ? 0 : leading_zeros(magnitude) - 8;
  *exponent = (magnitude >> 23 ? (int)(magnitude >> 23) - 127 : -126) - shift;
  return bits_float((bits & FLOAT_SIGN) | 0x3F800000 | (magnitude << shift & 0x007FFFFF));
}
INLINE double split_d(double x, int *exponent) {
  uint64_t bits = double_bits(x), magnitude = double_magnitude(bits);
  *exponent = magnitude ? 0 : EXPONENT_OF_ZERO;
  if (magnitude == 0 || magnitude >= DOUBLE_INFINITY)
    return x;
  int stored = double_exponent(bits);
  uint64_t significand = normalised_significand(bits, &stored);
  *exponent = stored - 1023;
  return bits_double((bits & DOUBLE_SIGN) | 0x3FF0000000000000u | (significand & FRACTION_MASK));
}

/* 2^n, which is a normal number. */
INLINE float power_s(int n) {
  return bits_float((uint32_t)(127 + n) << 23);
}
INLINE double power_d(int n) {
  return bits_double((uint64_t)(1023 + n) << 52);
}

/* x * 2^n for x around 1 and any n: two factors, because one may not be a number of the type. */
INLINE float scaled_s(float x, int n) {
  n = n < -252 ? -252 : n > 252 ? 252 : n;
  return x * power_s(n / 2) * power_s(n - n / 2);
}
INLINE double scaled_d(double x, int n) {
  n = n < -2044 ? -2044 : n > 2044 ? 2044 : n;
  return x * power_d(n / 2) * power_d(n - n / 2);
}

COMPLEX_ARITHMETIC(s, float, fabs_s, copysign_s, __builtin_inff(), split_s, power_s, scaled_s)
COMPLEX_ARITHMETIC(d, double, fabs_d, copysign_d, __builtin_inf(), split_d, power_d, scaled_d)
