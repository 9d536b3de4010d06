/* The C library's mathematical functions, compiled for the host, against the host's in double precision.

     test-math            every 1009th float (and for functions of two operands 4 million pairs)
     test-math 1          every float: a minute or two a function; docs/runtime.md has the table that it prints
     test-math 1 sinf     one function

   The error is the distance to the true value in units in the last place of the true value's float; correct rounding
   gives at most 0.5. Exits with status 1 if a function exceeds its bound; exact functions are compared bit by bit. */
#include <fenv.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "operands.h"

#define FUNCTIONS_1(X)                                                                                                 \
  X(sqrtf, 0, sqrt)                                                                                                    \
  X(fabsf, 0, fabs)                                                                                                    \
  X(floorf, 0, floor)                                                                                                  \
  X(ceilf, 0, ceil)                                                                                                    \
  X(truncf, 0, trunc)                                                                                                  \
  X(roundf, 0, round)                                                                                                  \
  X(rintf, 0, rint)                                                                                                    \
  X(nearbyintf, 0, rint)                                                                                               \
  X(logbf, 0, logb)                                                                                                    \
  X(sinf, 0.52, sin)                                                                                                   \
  X(cosf, 0.52, cos)                                                                                                   \
  X(tanf, 0.54, tan)                                                                                                   \
  X(asinf, 0.52, asin)                                                                                                 \
  X(acosf, 0.52, acos)                                                                                                 \
  X(atanf, 0.52, atan)                                                                                                 \
  X(expf, 0.52, exp)                                                                                                   \
  X(exp2f, 0.52, exp2)                                                                                                 \
  X(logf, 0.53, log)                                                                                                   \
  X(log2f, 0.52, log2)                                                                                                 \
  X(log10f, 0.53, log10)                                                                                               \
  X(sinhf, 0.52, sinh)                                                                                                 \
  X(coshf, 0.53, cosh)                                                                                                 \
  X(tanhf, 0.53, tanh)                                                                                                  \
  X(asinhf, 0.53, asinh)                                                                                                \
  X(acoshf, 0.53, acosh)                                                                                               \
  X(atanhf, 0.53, atanh)                                                                                               \
  X(expm1f, 0.82, expm1)                                                                                               \
  X(log1pf, 0.85, log1p)                                                                                               \
  X(cbrtf, 0.51, cbrt)                                                                                                 \
  X(erff, 0.9, erf)                                                                                                    \
  X(erfcf, 0.51, erfc)                                                                                                 \
  X(tgammaf, 0.51, tgamma)                                                                                             \
  X(lgammaf, 0.51, lgamma)

#define FUNCTIONS_2(X)                                                                                                 \
  X(atan2f, 0.53, atan2)                                                                                               \
  X(powf, 0.52, pow)                                                                                                   \
  X(hypotf, 0.51, hypot)                                                                                               \
  X(fmodf, 0, fmod)                                                                                                    \
  X(remainderf, 0, remainder)                                                                                          \
  X(fminf, 0, minimum)                                                                                                 \
  X(fmaxf, 0, maximum)                                                                                                 \
  X(copysignf, 0, copysign)                                                                                            \
  X(fdimf, 0, fdim)

#define DECLARE_1(name, bound, reference) float rt_##name(float);
#define DECLARE_2(name, bound, reference) float rt_##name(float, float);
FUNCTIONS_1(DECLARE_1)
FUNCTIONS_2(DECLARE_2)
float rt_fmaf(float, float, float);
float rt_modff(float, float *);
float rt_frexpf(float, int *);
float rt_ldexpf(float, int);
int rt_ilogbf(float);
float rt_nextafterf(float, float);
long rt_lroundf(float);
long rt_lrintf(float);
long long rt_llroundf(float);
long long rt_llrintf(float);
float rt_nexttowardf(float, double); /* the TP's long double */
float rt_remquof(float, float, int *);
void rt_sincosf(float, float *, float *);
double rt_sqrt(double);
double rt_fabs(double);
double rt_floor(double);
double rt_ceil(double);
double rt_trunc(double);
double rt_round(double);
double rt_rint(double);
double rt_fmin(double, double);
double rt_fmax(double, double);
double rt_fmod(double, double);
double rt_modf(double, double *);
double rt_frexp(double, int *);
double rt_ldexp(double, int);
double rt_copysign(double, double);
double rt_fma(double, double, double);
double rt_remainder(double, double);
double rt_remquo(double, double, int *);
double rt_nextafter(double, double);
double rt_fdim(double, double);
double rt_logb(double);
double rt_scalbln(double, long);
int rt_ilogb(double);
long rt_lround(double);
long rt_lrint(double);
long long rt_llround(double);
long long rt_llrint(double);

static double minimum(double x, double y) {
  return x != x ? y : y != y ? x : x < y || (x == y && signbit(x)) ? x : y;
}
static double maximum(double x, double y) {
  return -minimum(-x, -y);
}

/* The distance from got to want in units of want's last place as a float. Where no number is that (NaN, infinity), 0 if
   got is right, else infinite. */
static double error_in_ulp(float got, double want) {
  if (want != want)
    return float_bits_of(got) << 1 > 0xFF000000u ? 0 : INFINITY;
  if (got == (float)want && (want != 0 || !signbit(got) == !signbit(want)))
    return isinf(got) || got == want
               ? 0
               : fabs((double)got - want) / ldexp(1, ilogb(want) < -126 ? -149 : ilogb(want) - 23);
  if (got != got || isinf(got) || want == 0 || isinf((float)want)) {
    /* Near the overflow threshold both infinity and the greatest number may be within the bound. */
    double a = isinf(got) ? copysign(0x1p128, got) : got;
    return got == got && fabs(want) > 0x1.FFFFFDp127 && fabs(want) < 0x1.000001p128 ? fabs(a - want) / 0x1p104
                                                                                    : INFINITY;
  }
  return fabs((double)got - want) / ldexp(1, ilogb(want) < -126 ? -149 : ilogb(want) - 23);
}

static bool failed;

static void report(const char *name, double bound, double worst, float x, float y, int operands, uint64_t wrong,
                   uint64_t count) {
  bool bad = !(worst <= bound) || (bound == 0 && wrong);
  failed |= bad;
  printf("%-11s %9.4f ulp, bound %4.2f", name, worst, bound);
  if (bound > 0)
    printf(", rounded wrongly: %8.5f %%", 100.0 * (double)wrong / (double)count);
  if (worst > 0)
    printf(operands == 2 ? ", worst at %a, %a" : ", worst at %a", x, y);
  printf("%s\n", bad ? "  FAILED" : "");
}

struct function_1 {
  const char *name;
  double bound;
  float (*ours)(float);
  double (*reference)(double);
};
struct function_2 {
  const char *name;
  double bound;
  float (*ours)(float, float);
  double (*reference)(double, double);
};
#define ENTRY(name, bound, reference) {#name, bound, rt_##name, reference},
static const struct function_1 functions_1[] = {FUNCTIONS_1(ENTRY)};
static const struct function_2 functions_2[] = {FUNCTIONS_2(ENTRY)};

static void check_1(const struct function_1 *f, uint32_t stride) {
  double worst = 0;
  float worst_at = 0;
  uint64_t wrong = 0, count = 0;
  for (uint64_t bits = 0; bits <= UINT32_MAX; bits += stride) {
    float x = float_of((uint32_t)bits), got = f->ours(x);
    double want = f->reference(x), error = error_in_ulp(got, want);
    count++;
    if (f->bound == 0) /* exact or correctly rounded: the very bits */
      error = want != want                                       ? (got != got ? 0 : INFINITY)
              : float_bits_of(got) == float_bits_of((float)want) ? 0
                                                                 : 1 + error;
    wrong += error > 0 && float_bits_of(got) != float_bits_of((float)want) && want == want;
    if (error > worst || error != error) {
      worst = error == error ? error : INFINITY;
      worst_at = x;
    }
  }
  report(f->name, f->bound, worst, worst_at, 0, 1, wrong, count);
}

static const uint32_t special_floats[] = {
    0,          1,          2,          0x007FFFFF, 0x00800000, 0x00800001, 0x3E800000, 0x3ED413CC, 0x3ED413CD,
    0x3EFFFFFF, 0x3F000000, 0x3F3504F3, 0x3F490FDB, 0x3F7FFFFF, 0x3F800000, 0x3F800001, 0x3FC90FDB, 0x40000000,
    0x40400000, 0x40490FDB, 0x40A00000, 0x42FE0000, 0x43000000, 0x43150000, 0x4AFFFFFF, 0x4B000000, 0x4B000001,
    0x4B7FFFFF, 0x4B800000, 0x4C000000, 0x4F000000, 0x7E800000, 0x7F000000, 0x7F7FFFFF, 0x7F800000, 0x7FC00000};

/* Pairs: all special ones, random ones, and for powf such that the result is finite. */
static void check_2(const struct function_2 *f, long count) {
  double worst = 0;
  float worst_x = 0, worst_y = 0;
  uint64_t wrong = 0, state = 13;
  long specials = 4 * (long)(COUNT(special_floats) * COUNT(special_floats));
  for (long i = 0; i < specials + count; i++) {
    float x, y;
    if (i < specials) {
      x = float_of(special_floats[(size_t)i / 4 / COUNT(special_floats)] | (uint32_t)(i & 1) << 31);
      y = float_of(special_floats[(size_t)i / 4 % COUNT(special_floats)] | (uint32_t)(i & 2) << 30);
    } else {
      x = random_float(&state);
      y = random_float(&state);
      if (f->ours == rt_powf && i % 4) {
        double log2_x = log2(fabs((double)x));
        y = (float)((double)((int64_t)random64(&state)) * 0x1p-63 * 150 / log2_x);
        if (i % 4 == 1 && y == y && fabsf(y) < 1e9f)
          y = rintf(y);
        else
          x = fabsf(x);
      } else if (i % 4 == 1) { /* neighbours in size */
        y = x * (float)(1 + (double)(random64(&state) % 4096) / 1024);
      } else if (i % 4 == 2) {
        y = float_of(float_bits_of(x) + (uint32_t)(random64(&state) % 64) - 32);
      }
    }
    float got = f->ours(x, y);
    double want = f->reference(x, y), error = error_in_ulp(got, want);
    if (f->bound == 0)
      error = want != want                                       ? (got != got ? 0 : INFINITY)
              : float_bits_of(got) == float_bits_of((float)want) ? 0
                                                                 : 1 + error;
    wrong += error > 0 && float_bits_of(got) != float_bits_of((float)want) && want == want;
    if (error > worst || error != error) {
      worst = error == error ? error : INFINITY;
      worst_x = x;
      worst_y = y;
    }
  }
  report(f->name, f->bound, worst, worst_x, worst_y, 2, wrong, (uint64_t)(specials + count));
}

static void expect(bool condition, const char *what, double x, double y) {
  if (condition)
    return;
  failed = true;
  printf("%s differs at %a, %a  FAILED\n", what, x, y);
}

static bool same(double a, double b) {
  return (a != a && b != b) || bits_of(a) == bits_of(b);
}
static bool samef(float a, float b) {
  return (a != a && b != b) || float_bits_of(a) == float_bits_of(b);
}

static void check_fma(double x, double y, double z) {
  expect(same(rt_fma(x, y, z), fma(x, y, z)), "fma", x, y);
}

static void check_remainder(double x, double y) {
  int q, host_q;
  double rest = rt_remquo(x, y, &q), host_rest = remquo(x, y, &host_q);
  expect(same(rest, host_rest) && (rest != rest || (q & 7) == (host_q & 7)), "remquo", x, y);
  expect(same(rt_remainder(x, y), host_rest), "remainder", x, y);
}

static void check_others(void) {
  uint64_t state = 14;
  for (int i = 0; i < 2000000; i++) {
    float x = random_float(&state), y = random_float(&state), z = random_float(&state);
    if (i & 1) /* cancellation and halfway cases */
      z = -(x * y) + (i & 2 ? 0 : float_of(float_bits_of(x * y) - (12u << 23)));
    if (i < 36 * 36) {
      x = float_of(special_floats[i / 36]);
      y = float_of(special_floats[i % 36]);
    }
    expect(samef(rt_fmaf(x, y, z), fmaf(x, y, z)), "fmaf", x, y);
    expect(samef(rt_nextafterf(x, y), nextafterf(x, y)), "nextafterf", x, y);
    expect(samef(rt_nextafterf(x, x), nextafterf(x, x)), "nextafterf", x, x);
    float whole, host_whole, sine, cosine;
    expect(samef(rt_modff(x, &whole), modff(x, &host_whole)) && samef(whole, host_whole), "modff", x, 0);
    int e = 0, host_e = 0;
    float fraction = rt_frexpf(x, &e), host_fraction = frexpf(x, &host_e);
    expect(samef(fraction, host_fraction) && (!isfinite(x) || e == host_e), "frexpf", x, 0);
    e = (int)(random64(&state) % 700) - 350;
    expect(samef(rt_ldexpf(x, e), ldexpf(x, e)), "ldexpf", x, e);
    expect(rt_ilogbf(x) == ilogbf(x), "ilogbf", x, 0);
    rt_sincosf(x, &sine, &cosine);
    expect(samef(sine, rt_sinf(x)) && samef(cosine, rt_cosf(x)), "sincosf", x, 0);
    if (fabsf(x) < 1e9f)
      expect(rt_lroundf(x) == lroundf(x) && rt_lrintf(x) == lrintf(x), "lroundf, lrintf", x, 0);
    if (fabsf(x) < 9e18f)
      expect(rt_llroundf(x) == llroundf(x) && rt_llrintf(x) == llrintf(x), "llroundf, llrintf", x, 0);
    double target = i % 2 ? (double)y : i % 4 ? nextafter((double)x, (double)y) : (double)x;
    expect(samef(rt_nexttowardf(x, target), nexttowardf(x, target)), "nexttowardf", x, target);
    int q, host_q;
    float rest = rt_remquof(x, y, &q), host_rest = remquof(x, y, &host_q);
    expect(samef(rest, host_rest) && (rest != rest || (q & 7) == (host_q & 7)), "remquof", x, y);
  }
  for (size_t i = 0; i < 2000000 + 4 * COUNT(special_doubles) * COUNT(special_doubles); i++) {
    double x = random_double(&state), y = random_double(&state);
    if (i < 4 * COUNT(special_doubles) * COUNT(special_doubles)) {
      x = double_of(special_doubles[i / 4 / COUNT(special_doubles)] | (uint64_t)(i & 1) << 63);
      y = double_of(special_doubles[i / 4 % COUNT(special_doubles)] | (uint64_t)(i & 2) << 62);
    }
    expect(same(rt_sqrt(x), sqrt(x)), "sqrt", x, 0);
    double square = (double)(int64_t)(random64(&state) >> 11) * 0x1p-20; /* and roots that are close to halfway */
    expect(same(rt_sqrt(square * square), sqrt(square * square)), "sqrt", square * square, 0);
    expect(same(rt_sqrt(nextafter(square * square, 0)), sqrt(nextafter(square * square, 0))), "sqrt", square, 0);
    expect(same(rt_fabs(x), fabs(x)), "fabs", x, 0);
    expect(same(rt_floor(x), floor(x)), "floor", x, 0);
    expect(same(rt_ceil(x), ceil(x)), "ceil", x, 0);
    expect(same(rt_trunc(x), trunc(x)), "trunc", x, 0);
    expect(same(rt_round(x), round(x)), "round", x, 0);
    expect(same(rt_rint(x), rint(x)), "rint", x, 0);
    double half = (double)(int64_t)(random64(&state) % 2001 - 1000) / 2;
    expect(same(rt_round(half), round(half)) && same(rt_rint(half), rint(half)) && same(rt_floor(half), floor(half)) &&
               same(rt_ceil(half), ceil(half)),
           "rounding", half, 0);
    expect(same(rt_fmin(x, y), minimum(x, y)), "fmin", x, y);
    expect(same(rt_fmax(x, y), maximum(x, y)), "fmax", x, y);
    if (i % 16 == 0)
      expect(same(rt_fmod(x, y), fmod(x, y)), "fmod", x, y);
    expect(same(rt_copysign(x, y), copysign(x, y)), "copysign", x, y);
    double whole, host_whole;
    expect(same(rt_modf(x, &whole), modf(x, &host_whole)) && same(whole, host_whole), "modf", x, 0);
    int e = 0, host_e = 0;
    double fraction = rt_frexp(x, &e), host_fraction = frexp(x, &host_e);
    expect(same(fraction, host_fraction) && (!isfinite(x) || e == host_e), "frexp", x, 0);
    e = (int)(random64(&state) % 5000) - 2500;
    expect(same(rt_ldexp(x, e), ldexp(x, e)), "ldexp", x, e);
    expect(same(rt_scalbln(x, e), scalbln(x, e)), "scalbln", x, e);
    expect(same(rt_nextafter(x, y), nextafter(x, y)) && same(rt_nextafter(x, x), x), "nextafter", x, y);
    expect(same(rt_fdim(x, y), fdim(x, y)), "fdim", x, y);
    expect(same(rt_logb(x), logb(x)) && rt_ilogb(x) == ilogb(x), "logb, ilogb", x, 0);
    if (fabs(x) < 2e9)
      expect(rt_lround(x) == lround(x) && rt_lrint(x) == lrint(x), "lround, lrint", x, 0);
    if (fabs(x) < 9e18)
      expect(rt_llround(x) == llround(x) && rt_llrint(x) == llrint(x), "llround, llrint", x, 0);
    check_remainder(x, y);
    check_remainder(x, x * half); /* ties among them */
    double z = random_double(&state);
    check_fma(x, y, z);
    check_fma(x, y, -(x * y)); /* cancellation */
    check_fma(x, y, -(x * y) * (1 + 0x1p-52));
    check_fma(x, y, (x * y) * 0x1p-53 * half); /* halfway cases */
    check_fma(x, y, (x * y) * 0x1p53 * half);
  }
}

int main(int argc, char **argv) {
  uint32_t stride = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 0) : 1009;
  const char *only = argc > 2 ? argv[2] : NULL;
  if (stride == 0) {
    fprintf(stderr, "usage: test-math [STRIDE [FUNCTION]]\n");
    return 1;
  }
  for (size_t i = 0; i < COUNT(functions_1); i++)
    if (!only || !strcmp(only, functions_1[i].name))
      check_1(&functions_1[i], stride);
  for (size_t i = 0; i < COUNT(functions_2); i++)
    if (!only || !strcmp(only, functions_2[i].name))
      check_2(&functions_2[i], stride == 1 ? 100000000 : 4000000);
  if (!only)
    check_others();
  return failed;
}
