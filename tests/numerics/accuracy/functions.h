/* The binary32 functions of runtime/libc/math.h, and what each is compared with.

   X(name, host, exact, low, high): the host's function in binary64, MPFR's, and the interval from which cost.c draws
   each operand: where programs use the function, not where it is cheap. Adapted functions have other types; adapted.h
   makes functions of floats of them. "Exact" ones are so in binary64 too. */
#ifndef TRAX_TEST_ACCURACY_FUNCTIONS_H
#define TRAX_TEST_ACCURACY_FUNCTIONS_H

#define EXACT_FUNCTIONS(X)                                                                                             \
  X(fabsf, fabs, mpfr_abs, -100, 100)                                                                                  \
  X(floorf, floor, mpfr_rint_floor, -100, 100)                                                                         \
  X(ceilf, ceil, mpfr_rint_ceil, -100, 100)                                                                            \
  X(truncf, trunc, mpfr_rint_trunc, -100, 100)                                                                         \
  X(roundf, round, mpfr_rint_round, -100, 100)                                                                         \
  X(rintf, rint, mpfr_rint_roundeven, -100, 100)                                                                       \
  X(nearbyintf, rint, mpfr_rint_roundeven, -100, 100)                                                                  \
  X(logbf, logb, true_logb, -100, 100)                                                                                 \
  X(sqrtf, sqrt, mpfr_sqrt, 0, 100)

#define ADAPTED_FUNCTIONS(X)                                                                                           \
  X(trax_rsqrt, host_rsqrt, true_rsqrt, 0, 100)                                                                        \
  X(lroundf, host_lround, true_lround, -100, 100)                                                                      \
  X(lrintf, host_lrint, true_lrint, -100, 100)                                                                         \
  X(llroundf, host_llround, true_llround, -100, 100)                                                                   \
  X(llrintf, host_llrint, true_llrint, -100, 100)                                                                      \
  X(ilogbf, host_ilogb, true_ilogb, -100, 100)                                                                         \
  X(frexpf, host_frexp, mpfr_set, -100, 100)                                                                           \
  X(modff, host_modf, mpfr_frac, -100, 100)

#define TRANSCENDENTAL_FUNCTIONS(X)                                                                                    \
  X(cbrtf, cbrt, mpfr_cbrt, -100, 100)                                                                                 \
  X(expf, exp, mpfr_exp, -10, 10)                                                                                      \
  X(exp2f, exp2, mpfr_exp2, -10, 10)                                                                                   \
  X(expm1f, expm1, mpfr_expm1, -2, 2)                                                                                  \
  X(logf, log, mpfr_log, 0, 100)                                                                                       \
  X(log2f, log2, mpfr_log2, 0, 100)                                                                                    \
  X(log10f, log10, mpfr_log10, 0, 100)                                                                                 \
  X(log1pf, log1p, mpfr_log1p, -1, 2)                                                                                  \
  X(sinf, sin, mpfr_sin, -10, 10)                                                                                      \
  X(cosf, cos, mpfr_cos, -10, 10)                                                                                      \
  X(tanf, tan, mpfr_tan, -10, 10)                                                                                      \
  X(asinf, asin, mpfr_asin, -1, 1)                                                                                     \
  X(acosf, acos, mpfr_acos, -1, 1)                                                                                     \
  X(atanf, atan, mpfr_atan, -10, 10)                                                                                   \
  X(sinhf, sinh, mpfr_sinh, -10, 10)                                                                                   \
  X(coshf, cosh, mpfr_cosh, -10, 10)                                                                                   \
  X(tanhf, tanh, mpfr_tanh, -4, 4)                                                                                     \
  X(asinhf, asinh, mpfr_asinh, -10, 10)                                                                                \
  X(acoshf, acosh, mpfr_acosh, 1, 10)                                                                                  \
  X(atanhf, atanh, mpfr_atanh, -1, 1)                                                                                  \
  X(erff, erf, mpfr_erf, -4, 4)                                                                                        \
  X(erfcf, erfc, mpfr_erfc, -4, 4)                                                                                     \
  X(tgammaf, tgamma, mpfr_gamma, -10, 10)                                                                              \
  X(lgammaf, lgamma, true_lgamma, -10, 10)

#define EXACT_PAIRS(X)                                                                                                 \
  X(fminf, host_fmin, mpfr_min, -100, 100)                                                                             \
  X(fmaxf, host_fmax, mpfr_max, -100, 100)                                                                             \
  X(copysignf, copysign, mpfr_copysign, -100, 100)                                                                     \
  X(fdimf, fdim, mpfr_dim, -100, 100)                                                                                  \
  X(nextafterf, host_nextafter, true_nextafter, -100, 100)                                                             \
  X(fmodf, fmod, mpfr_fmod, -100, 100)                                                                                 \
  X(remainderf, remainder, mpfr_remainder, -100, 100)

#define ADAPTED_PAIRS(X)                                                                                               \
  X(ldexpf, host_ldexp, true_ldexp, -100, 100)                                                                         \
  X(remquof, host_remquo, mpfr_remainder, -100, 100)

#define TRANSCENDENTAL_PAIRS(X)                                                                                        \
  X(hypotf, hypot, mpfr_hypot, -100, 100)                                                                              \
  X(atan2f, atan2, mpfr_atan2, -100, 100)                                                                              \
  X(powf, pow, mpfr_pow, 0, 10)

#define TRIPLES(X) X(fmaf, fma, mpfr_fma, -100, 100)

#endif
