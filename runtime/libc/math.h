/* Mathematical functions of binary32 and binary64; long double is binary64. docs/runtime.md has the errors, and says
   which functions are newlib's. No function sets errno or raises a flag. */
#ifndef TRAX_MATH_H
#define TRAX_MATH_H

#include <trax/names.h>

#define HUGE_VALF __builtin_huge_valf()
#define HUGE_VAL __builtin_huge_val()
#define HUGE_VALL __builtin_huge_vall()
#define INFINITY __builtin_inff()
#define NAN __builtin_nanf("")

#ifdef __TRAX_ALL_NAMES
#define M_E 2.7182818284590452354
#define M_LOG2E 1.4426950408889634074
#define M_LOG10E 0.43429448190325182765
#define M_LN2 0.69314718055994530942
#define M_LN10 2.30258509299404568402
#define M_PI 3.14159265358979323846
#define M_PI_2 1.57079632679489661923
#define M_PI_4 0.78539816339744830962
#define M_1_PI 0.31830988618379067154
#define M_2_PI 0.63661977236758134308
#define M_2_SQRTPI 1.12837916709551257390
#define M_SQRT2 1.41421356237309504880
#define M_SQRT1_2 0.70710678118654752440
#endif

#define FP_NAN 0
#define FP_INFINITE 1
#define FP_ZERO 2
#define FP_SUBNORMAL 3
#define FP_NORMAL 4
#define FP_ILOGB0 (-2147483647 - 1)
#define FP_ILOGBNAN (-2147483647 - 1)
#define MATH_ERRNO 1
#define MATH_ERREXCEPT 2
#define math_errhandling 0

#define isnan(x) __builtin_isnan(x)
#define isinf(x) __builtin_isinf(x)
#define isfinite(x) __builtin_isfinite(x)
#define isnormal(x) __builtin_isnormal(x)
#define signbit(x) __builtin_signbit(x)
#define fpclassify(x) __builtin_fpclassify(FP_NAN, FP_INFINITE, FP_NORMAL, FP_SUBNORMAL, FP_ZERO, x)
#define isgreater(x, y) __builtin_isgreater(x, y)
#define isgreaterequal(x, y) __builtin_isgreaterequal(x, y)
#define isless(x, y) __builtin_isless(x, y)
#define islessequal(x, y) __builtin_islessequal(x, y)
#define islessgreater(x, y) __builtin_islessgreater(x, y)
#define isunordered(x, y) __builtin_isunordered(x, y)

#ifdef __cplusplus
extern "C" {
#endif

typedef float float_t;
typedef double double_t;

/* Each function has three forms: name, namef and namel. */
#define __TRAX_MATH_1(name)                                                                                            \
  double name(double);                                                                                                 \
  float name##f(float);                                                                                                \
  long double name##l(long double);
#define __TRAX_MATH_2(name)                                                                                            \
  double name(double, double);                                                                                         \
  float name##f(float, float);                                                                                         \
  long double name##l(long double, long double);
#define __TRAX_MATH_TO_INTEGER(type, name)                                                                             \
  type name(double);                                                                                                   \
  type name##f(float);                                                                                                 \
  type name##l(long double);
#define __TRAX_MATH_POINTER(name, type)                                                                                \
  double name(double, type *);                                                                                         \
  float name##f(float, type *);                                                                                        \
  long double name##l(long double, type *);
#define __TRAX_MATH_SCALE(name, type)                                                                                  \
  double name(double, type);                                                                                           \
  float name##f(float, type);                                                                                          \
  long double name##l(long double, type);

/* Exact, or correctly rounded. */
__TRAX_MATH_1(sqrt)
__TRAX_MATH_1(fabs)
__TRAX_MATH_1(floor)
__TRAX_MATH_1(ceil)
__TRAX_MATH_1(trunc)
__TRAX_MATH_1(round)
__TRAX_MATH_1(rint)
__TRAX_MATH_1(nearbyint)
__TRAX_MATH_1(logb)
__TRAX_MATH_2(copysign)
__TRAX_MATH_2(fmin)
__TRAX_MATH_2(fmax)
__TRAX_MATH_2(fdim)
__TRAX_MATH_2(fmod)
__TRAX_MATH_2(remainder)
__TRAX_MATH_2(nextafter)
__TRAX_MATH_TO_INTEGER(int, ilogb)
__TRAX_MATH_TO_INTEGER(long, lround)
__TRAX_MATH_TO_INTEGER(long, lrint)
__TRAX_MATH_TO_INTEGER(long long, llround)
__TRAX_MATH_TO_INTEGER(long long, llrint)
__TRAX_MATH_POINTER(frexp, int)
__TRAX_MATH_SCALE(ldexp, int)
__TRAX_MATH_SCALE(scalbn, int)
__TRAX_MATH_SCALE(scalbln, long)
double modf(double x, double *integer);
float modff(float x, float *integer);
long double modfl(long double x, long double *integer);
double nexttoward(double x, long double y);
float nexttowardf(float x, long double y);
long double nexttowardl(long double x, long double y);
double fma(double x, double y, double z);
float fmaf(float x, float y, float z);
long double fmal(long double x, long double y, long double z);
double remquo(double x, double y, int *quotient);
float remquof(float x, float y, int *quotient);
long double remquol(long double x, long double y, int *quotient);
double nan(const char *payload); /* which is ignored */
float nanf(const char *payload);
long double nanl(const char *payload);

/* Not always correctly rounded. */
__TRAX_MATH_1(sin)
__TRAX_MATH_1(cos)
__TRAX_MATH_1(tan)
__TRAX_MATH_1(asin)
__TRAX_MATH_1(acos)
__TRAX_MATH_1(atan)
__TRAX_MATH_1(sinh)
__TRAX_MATH_1(cosh)
__TRAX_MATH_1(tanh)
__TRAX_MATH_1(asinh)
__TRAX_MATH_1(acosh)
__TRAX_MATH_1(atanh)
__TRAX_MATH_1(exp)
__TRAX_MATH_1(exp2)
__TRAX_MATH_1(expm1)
__TRAX_MATH_1(log)
__TRAX_MATH_1(log2)
__TRAX_MATH_1(log10)
__TRAX_MATH_1(log1p)
__TRAX_MATH_1(cbrt)
__TRAX_MATH_1(erf)
__TRAX_MATH_1(erfc)
__TRAX_MATH_1(tgamma)
__TRAX_MATH_1(lgamma)
__TRAX_MATH_2(atan2)
__TRAX_MATH_2(pow)
__TRAX_MATH_2(hypot)
#ifdef __TRAX_ALL_NAMES
void sincos(double x, double *sine, double *cosine);
void sincosf(float x, float *sine, float *cosine);
double lgamma_r(double x, int *sign);
float lgammaf_r(float x, int *sign);

/* The sign of the gamma function after lgamma; each thread has its own. */
extern __thread int signgam;
#endif

#undef __TRAX_MATH_1
#undef __TRAX_MATH_2
#undef __TRAX_MATH_TO_INTEGER
#undef __TRAX_MATH_POINTER
#undef __TRAX_MATH_SCALE

#ifdef __cplusplus
}
#endif

#endif
