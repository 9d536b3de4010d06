/* Complex products and quotients, with C's rules for infinities (C17 annex G.5.1). The quotient scales the divisor by a
   power of two, so that nothing overflows or vanishes on the way. */
#include "double.h"

#define COMPLEX_ARITHMETIC(suffix, type, fabs_, copysign_, inf_, scale_of, scaled)                                     \
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
    if (x != x && y != y) { /* infinities, perhaps, that NaNs have hidden */                                           \
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
  _Complex type __div##suffix##c3(type a, type b, type c, type d) {                                                    \
    type greater = fabs_(c) > fabs_(d) || d != d ? fabs_(c) : fabs_(d); /* of a NaN and a number, that */              \
    int scale = scale_of(greater);                                                                                     \
    type sc = scaled(c, -scale), sd = scaled(d, -scale);                                                               \
    type denominator = sc * sc + sd * sd;                                                                              \
    type x = scaled((a * sc + b * sd) / denominator, -scale);                                                          \
    type y = scaled((b * sc - a * sd) / denominator, -scale);                                                          \
    if (x != x && y != y) {                                                                                            \
      if (denominator == 0 && (a == a || b == b)) {                                                                    \
        x = copysign_(inf_, c) * a;                                                                                    \
        y = copysign_(inf_, c) * b;                                                                                    \
      } else if ((is_infinite_##suffix(a) || is_infinite_##suffix(b)) && fabs_(c) < inf_ && fabs_(d) < inf_) {         \
        a = boxed_##suffix(a);                                                                                         \
        b = boxed_##suffix(b);                                                                                         \
        x = inf_ * (a * c + b * d);                                                                                    \
        y = inf_ * (b * c - a * d);                                                                                    \
      } else if (greater == inf_ && fabs_(a) < inf_ && fabs_(b) < inf_) {                                              \
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

/* The exponent of a number that is not negative; 0 where scaling would not help (zeros, infinities, NaNs). */
INLINE int scale_s(float x) {
  uint32_t bits = float_bits(x);
  if (bits == 0 || bits >= FLOAT_INFINITY)
    return 0;
  return bits >> 23 ? (int)(bits >> 23) - 127 : -118 - leading_zeros(bits);
}
INLINE int scale_d(double x) {
  uint64_t bits = double_bits(x);
  int exponent = double_exponent(bits);
  if (bits == 0 || exponent == EXPONENT_SPECIAL)
    return 0;
  if (exponent == 0)
    normalised_significand(bits, &exponent);
  return exponent - 1023;
}

/* x * 2^n, |n| up to the range of the exponent: two factors, because one may not be a number of the type. */
INLINE float scaled_s(float x, int n) {
  int half = n / 2;
  return x * bits_float((uint32_t)(127 + half) << 23) * bits_float((uint32_t)(127 + n - half) << 23);
}
INLINE double scaled_d(double x, int n) {
  int half = n / 2;
  return x * bits_double((uint64_t)(1023 + half) << 52) * bits_double((uint64_t)(1023 + n - half) << 52);
}

COMPLEX_ARITHMETIC(s, float, fabs_s, copysign_s, __builtin_inff(), scale_s, scaled_s)
COMPLEX_ARITHMETIC(d, double, fabs_d, copysign_d, __builtin_inf(), scale_d, scaled_d)
