/* The breakpoints are where the sources, in runtime/math or newlib's, go another way, and the function's own marks. */
#include "worst.h"

#include <float.h>
#include <math.h>

_Static_assert(LDBL_MANT_DIG >= 64, "the search compares with the host's long double");

static int exact_lgamma(mpfr_t result, const mpfr_t x, mpfr_rnd_t rounding) {
  int sign;
  return mpfr_lgamma(result, &sign, x, rounding);
}
static int exact_sqrt(mpfr_t result, const mpfr_t x, mpfr_rnd_t rounding) {
  return mpfr_sqrt(result, x, rounding);
}

/* Name, MPFR's, signs, |x| low and high, x from and to, breakpoints. */
#define FUNCTIONS_1(X)                                                                                                 \
  X(sqrt, exact_sqrt, POSITIVE, 0x1p-1074, 0x1p1023, 0, 4, 1, 2, 4)                                                    \
  X(sin, mpfr_sin, BOTH_SIGNS, 0x1p-30, 0x1p1023, -100, 100, M_PI_4, M_PI_2, M_PI, 0x1p-27)                            \
  X(cos, mpfr_cos, BOTH_SIGNS, 0x1p-30, 0x1p1023, -100, 100, M_PI_4, M_PI_2, M_PI, 0x1p-27)                            \
  X(tan, mpfr_tan, BOTH_SIGNS, 0x1p-30, 0x1p1023, -100, 100, M_PI_4, M_PI_2, M_PI, 0x1p-27)                            \
  X(asin, mpfr_asin, BOTH_SIGNS, 0x1p-30, 1, -1, 1, 0.12403, 0.35112, 0.53, 0.65850, M_SQRT1_2, 1, 0x1p-27)            \
  X(acos, mpfr_acos, BOTH_SIGNS, 0x1p-60, 1, -1, 1, 0.12403, 0.35112, 0.53, 0.65850, M_SQRT1_2, 1, 0x1p-57)            \
  X(atan, mpfr_atan, BOTH_SIGNS, 0x1p-30, 0x1p70, -5, 5, 0.125, 0.375, 0.625, 0.875, 1, 8, 1.6, 0x1p66, 0x1p-27)       \
  X(sinh, mpfr_sinh, BOTH_SIGNS, 0x1p-30, 711, -711, 711, 0x1p-28, 1, 22, 709.7822265633, 710.47586007)                \
  X(cosh, mpfr_cosh, BOTH_SIGNS, 0x1p-30, 711, -711, 711, 0x1p-28, 1, 22, 709.7822265633, 710.47586007)                \
  X(tanh, mpfr_tanh, BOTH_SIGNS, 0x1p-30, 24, -23, 23, 0x1p-28, 0.5, 1, 22)                                            \
  X(asinh, mpfr_asinh, BOTH_SIGNS, 0x1p-30, 0x1p1023, -100, 100, 0x1p-28, 0.22314, 0.25, 0.5, 1, 2, 0x1p32, 0x1p33)    \
  X(acosh, mpfr_acosh, POSITIVE, 1, 0x1p1023, 1, 4, 1, 1.03, 1.06, 1.25, 1.5, 2, 0x1p32, 0x1p33)                       \
  X(atanh, mpfr_atanh, BOTH_SIGNS, 0x1p-30, 1, -1, 1, 0x1p-28, 0.125, 0.17157, 0.25, 0.5, 1)                           \
  X(exp, mpfr_exp, BOTH_SIGNS, 0x1p-60, 746, -746, 710, 709.782712893384, 708.396418532264, 745.13321910194)           \
  X(exp2, mpfr_exp2, BOTH_SIGNS, 0x1p-60, 1076, -1076, 1025, 1022, 1024, 1074)                                         \
  X(expm1, mpfr_expm1, BOTH_SIGNS, 0x1p-60, 710, -40, 710, 0.5, 1, 38, 709.7827, 0x1p-54)                              \
  X(log, mpfr_log, POSITIVE, 0x1p-1074, 0x1p1023, 0, 4, 1, 0.9394, 1.0644, 0.5, 2)                                     \
  X(log2, mpfr_log2, POSITIVE, 0x1p-1074, 0x1p1023, 0, 4, 1, 0.9577, 1.0445, 0.5, 2)                                   \
  X(log10, mpfr_log10, POSITIVE, 0x1p-1074, 0x1p1023, 0, 4, 1, 0.5, 2, M_SQRT2, M_SQRT1_2, 10)                         \
  X(log1p, mpfr_log1p, BOTH_SIGNS, 0x1p-60, 0x1p1023, -1, 4, 0.25, 0.41421, 0.2929, 1, 0x1p-54, 0x1p53)                \
  X(cbrt, mpfr_cbrt, BOTH_SIGNS, 0x1p-1074, 0x1p1023, -8, 8, 1, 2, 4, 8)                                               \
  X(erf, mpfr_erf, BOTH_SIGNS, 0x1p-1074, 6.5, -6, 6, 1, 2, 4, 6, 0x1p-28)                                             \
  X(erfc, mpfr_erfc, BOTH_SIGNS, 0x1p-60, 27.5, -6, 27.3, 0.25, 0.5, 1, 2, 4, 6, 26.543, 27.2268, 0x1p-55)             \
  X(tgamma, mpfr_gamma, BOTH_SIGNS, 0x1p-1024, 185, -185, 172, 1, 2, 171.624376956, 170.57, 177.8)                     \
  X(lgamma, exact_lgamma, POSITIVE, 0x1p-80, 0x1p1014, 0, 10, 1, 2, 1.4616, 0.5, 1.25, 1.5, 2.5, 3.5, 8, 0x1p58)

#define FUNCTIONS_2(X)                                                                                                 \
  X(pow, mpfr_pow, 1, 2)                                                                                               \
  X(atan2, mpfr_atan2, 0.125, 0.375, 0.625, 0.875, 1, 0x1p60)                                                          \
  X(hypot, mpfr_hypot, 1, 2, 0x1p60, 0x1p27, 0.5)                                                                      \
  X(fmod, mpfr_fmod, 1, 2)                                                                                             \
  X(remainder, mpfr_remainder, 1, 2, 0.5)

#define DECLARE_1(name, exact, signs, low, high, from, to, ...) double rt_##name(double);
#define DECLARE_2(name, exact, ...) double rt_##name(double, double);
FUNCTIONS_1(DECLARE_1)
FUNCTIONS_2(DECLARE_2)

#define ENTRY_1(name, exact, signs, low, high, from, to, ...)                                                          \
  {#name, rt_##name, NULL, exact, NULL, name##l, NULL, signs, low, high, from, to, 0, {__VA_ARGS__}},
#define ENTRY_2(name, exact, ...)                                                                                      \
  {#name, NULL, rt_##name, NULL, exact, NULL, name##l, BOTH_SIGNS, 0x1p-1074, 0x1p1023, -8, 8, 0, {__VA_ARGS__}},
const struct function functions[] = {
    FUNCTIONS_1(ENTRY_1) FUNCTIONS_2(ENTRY_2)
    /* Between its zeros at negative arguments lgamma is the difference of two greater numbers. */
    {.name = "lgamma-",
     .ours_1 = rt_lgamma,
     .exact_1 = exact_lgamma,
     .near_1 = lgammal,
     .signs = NEGATIVE,
     .low = 0x1p-80,
     .high = 0x1p53,
     .from = -30,
     .to = 0,
     .least_unit = 1,
     .breakpoints = {0.5, 1, 2, 2.4570247382, 2.7476826467, 3, 3.1435808883, 3.9552942849, 4, 5, 8, 19}},
};
const size_t function_count = sizeof functions / sizeof functions[0];
