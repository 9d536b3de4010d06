/* The binary64 functions, compiled for the host, against MPFR.

     test-math64             2,000 arguments of each kind and function
     test-math64 100000      more; docs/runtime.md has the table that it prints
     test-math64 100000 sin  one function

   The error is the distance to the true value in units in the last place of the true value; correct rounding gives at
   most 0.5. The compiled arithmetic is the host's, which is as exact as the TP's: tests/c/math_hashes.c has the TP
   compute the same bits. Exits with status 1 if a function exceeds its bound or a special value is not what annex F of
   C17 asks for. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <mpfr.h>

#include "operands.h"

typedef int exact_1(mpfr_t result, const mpfr_t x, mpfr_rnd_t rounding);
typedef int exact_2(mpfr_t result, const mpfr_t x, const mpfr_t y, mpfr_rnd_t rounding);

static int exact_lgamma(mpfr_t result, const mpfr_t x, mpfr_rnd_t rounding) {
  int sign;
  return mpfr_lgamma(result, &sign, x, rounding);
}

/* Arguments: all are tried with the kinds that every function gets, and uniformly from low to high. */
#define FUNCTIONS_1(X)                                                                                                 \
  X(sin, 0.83, mpfr_sin, -100, 100)                                                                                    \
  X(cos, 0.83, mpfr_cos, -100, 100)                                                                                    \
  X(tan, 1.43, mpfr_tan, -100, 100)                                                                                    \
  X(asin, 0.84, mpfr_asin, -1, 1)                                                                                      \
  X(acos, 0.88, mpfr_acos, -1, 1)                                                                                      \
  X(atan, 0.79, mpfr_atan, -5, 5)                                                                                      \
  X(sinh, 1.6, mpfr_sinh, -711, 711)                                                                                   \
  X(cosh, 1.6, mpfr_cosh, -711, 711)                                                                                   \
  X(tanh, 2.07, mpfr_tanh, -23, 23)                                                                                    \
  X(asinh, 1.58, mpfr_asinh, -100, 100)                                                                                \
  X(acosh, 2, mpfr_acosh, 1, 4)                                                                                        \
  X(atanh, 1.52, mpfr_atanh, -1, 1)                                                                                    \
  X(exp, 0.51, mpfr_exp, -746, 710)                                                                                    \
  X(exp2, 0.51, mpfr_exp2, -1076, 1025)                                                                                \
  X(expm1, 0.78, mpfr_expm1, -40, 710)                                                                                 \
  X(log, 0.52, mpfr_log, 0, 4)                                                                                         \
  X(log2, 0.55, mpfr_log2, 0, 4)                                                                                       \
  X(log10, 1.62, mpfr_log10, 0, 4)                                                                                     \
  X(log1p, 0.77, mpfr_log1p, -1, 4)                                                                                    \
  X(cbrt, 0.68, mpfr_cbrt, -8, 8)                                                                                      \
  X(erf, 0.95, mpfr_erf, -6, 6)                                                                                        \
  X(erfc, 2.6, mpfr_erfc, -6, 27)                                                                                      \
  X(tgamma, 0.57, mpfr_gamma, -185, 172)                                                                               \
  X(lgamma, 2.2, exact_lgamma, 0, 200)

#define FUNCTIONS_2(X)                                                                                                 \
  X(pow, 0.51, mpfr_pow, 0, 0)                                                                                         \
  X(atan2, 1.3, mpfr_atan2, 0, 0)                                                                                      \
  X(hypot, 1.05, mpfr_hypot, 0, 0)

#define DECLARE_1(name, bound, exact, low, high) double rt_##name(double);
#define DECLARE_2(name, bound, exact, low, high) double rt_##name(double, double);
FUNCTIONS_1(DECLARE_1)
FUNCTIONS_2(DECLARE_2)

/* Near its zeros at negative arguments lgamma is only as exact as the greater of two numbers whose difference it is. */
static double negative_lgamma(double x) {
  return rt_lgamma(-fabs(x));
}
static int exact_negative_lgamma(mpfr_t result, const mpfr_t x, mpfr_rnd_t rounding) {
  mpfr_t negative;
  mpfr_init2(negative, 53);
  mpfr_abs(negative, x, rounding);
  mpfr_neg(negative, negative, rounding);
  int inexact = exact_lgamma(result, negative, rounding);
  mpfr_clear(negative);
  return inexact;
}

struct function {
  const char *name;
  double bound;
  double (*ours_1)(double);
  double (*ours_2)(double, double);
  exact_1 *exact_1;
  exact_2 *exact_2;
  double low, high;
};
#define ENTRY_1(name, bound, exact, low, high) {#name, bound, rt_##name, NULL, exact, NULL, low, high},
#define ENTRY_2(name, bound, exact, low, high) {#name, bound, NULL, rt_##name, NULL, exact, low, high},
static const struct function functions[] = {
    FUNCTIONS_1(ENTRY_1) FUNCTIONS_2(ENTRY_2) //
    {"lgamma-", 25, negative_lgamma, NULL, exact_negative_lgamma, NULL, 0, 200},
};

#define BITS 160 /* of the reference: three times a double, so that nothing hides behind its rounding */

/* What the function gives at its worst. */
struct worst {
  double error, x, y;
  uint64_t wrong, count;
};

static bool failed;
static mpfr_t exact_x, exact_y, exact_result;

static double uniform(uint64_t *state) {
  return (double)(random64(state) >> 11) * 0x1p-53;
}

/* C leaves signalling NaNs open. */
static bool is_signalling(double x) {
  return x != x && !(bits_of(x) >> 51 & 1);
}

/* The exponent whose unit in the last place counts at want. */
static int exponent_of(const struct function *f, double want) {
  int exponent = ilogb(want);
  if (f->ours_1 == negative_lgamma && exponent < 0)
    return 0;
  return exponent < -1022 ? -1022 : exponent;
}

static void check(const struct function *f, struct worst *worst, double x, double y) {
  if (is_signalling(x) || is_signalling(y))
    return;
  if (f->ours_1 == rt_lgamma)
    x = fabs(x);
  double got = f->ours_1 ? f->ours_1(x) : f->ours_2(x, y);
  mpfr_set_d(exact_x, x, MPFR_RNDN);
  mpfr_set_d(exact_y, y, MPFR_RNDN);
  if (f->exact_1)
    f->exact_1(exact_result, exact_x, MPFR_RNDN);
  else
    f->exact_2(exact_result, exact_x, exact_y, MPFR_RNDN);
  double want = mpfr_get_d(exact_result, MPFR_RNDN), error;
  worst->count++;
  if (want != want || isinf(got) || want == 0) {
    error = want != want ? got == got : got != want;
    /* Where rounding decides between the greatest number and infinity, or the least and 0, either is within 1. */
    if (error != 0 && want == want && fabs(got - want) > (isinf(want) ? 0 : 0x1p-1074) &&
        !(isinf(got) && fabs(want) == 0x1.FFFFFFFFFFFFFp1023))
      error = INFINITY;
  } else if (isinf(want)) {
    error = fabs(got) == 0x1.FFFFFFFFFFFFFp1023 ? 1 : INFINITY;
  } else {
    mpfr_sub_d(exact_result, exact_result, got, MPFR_RNDN);
    mpfr_mul_2si(exact_result, exact_result, 52 - exponent_of(f, want), MPFR_RNDN);
    error = fabs(mpfr_get_d(exact_result, MPFR_RNDN));
  }
  worst->wrong += got != want && want == want;
  if (error > worst->error || error != error) {
    worst->error = error == error ? error : INFINITY;
    worst->x = x;
    worst->y = y;
  }
}

static void check_arguments_1(const struct function *f, struct worst *worst, long count) {
  uint64_t state = 21;
  for (size_t i = 0; i < 2 * COUNT(special_doubles); i++)
    check(f, worst, double_of(special_doubles[i / 2] | (uint64_t)(i & 1) << 63), 0);
  for (long i = 0; i < count; i++) {
    check(f, worst, f->low + uniform(&state) * (f->high - f->low), 0);
    check(f, worst, (2 * uniform(&state) - 1) * exp2(-(double)(random64(&state) % 64)), 0);
    check(f, worst, 1 + (2 * uniform(&state) - 1) * exp2(-(double)(random64(&state) % 52)), 0);
    check(f, worst, random_double(&state), 0);
    /* Near multiples of a quarter turn, or of a half, as near as doubles come by chance. */
    check(f, worst, (double)(random64(&state) >> (random64(&state) % 64)) * 0x1.921FB54442D18p0, 0);
    check(f, worst,
          (double)((int64_t)random64(&state) >> (random64(&state) % 64)) / 2 * (1 + 0x1p-52 * (double)(i % 3)), 0);
  }
}

static void check_arguments_2(const struct function *f, struct worst *worst, long count) {
  uint64_t state = 22;
  for (size_t i = 0; i < 4 * COUNT(special_doubles) * COUNT(special_doubles); i++)
    check(f, worst, double_of(special_doubles[i / 4 / COUNT(special_doubles)] | (uint64_t)(i & 1) << 63),
          double_of(special_doubles[i / 4 % COUNT(special_doubles)] | (uint64_t)(i & 2) << 62));
  for (long i = 0; i < count; i++) {
    double x = random_double(&state), y = random_double(&state);
    check(f, worst, x, y);
    check(f, worst, x, x * (0.5 + uniform(&state)));
    check(f, worst, x, x * exp2((double)(random64(&state) % 120) - 60));
    /* Powers that are numbers: the logarithm of the result is anywhere in the range. */
    x = fabs(x);
    y = (2 * uniform(&state) - 1) * 1076 / log2(x);
    check(f, worst, x, y);
    check(f, worst, -x, rint(y));
    x = 1 + (2 * uniform(&state) - 1) * exp2(-(double)(random64(&state) % 50));
    check(f, worst, x, (2 * uniform(&state) - 1) * 1076 / log2(x));
  }
}

/* Annex F: a special argument and its value; the sign of zeros counts. */
static const struct {
  const char *name;
  double x, y, want;
} specials[] = {
#define ODD(name) {#name, 0.0, 0, 0.0}, {#name, -0.0, 0, -0.0}
#define INFINITE(name, below, above)                                                                                   \
  {#name, -INFINITY, 0, below}, {                                                                                      \
    #name, INFINITY, 0, above                                                                                          \
  }
    ODD(sin),
    INFINITE(sin, NAN, NAN),
    ODD(tan),
    INFINITE(tan, NAN, NAN),
    INFINITE(cos, NAN, NAN),
    {"cos", -0.0, 0, 1},
    ODD(asin),
    INFINITE(asin, NAN, NAN),
    {"asin", 1.5, 0, NAN},
    {"acos", 1, 0, 0.0},
    {"acos", -1.5, 0, NAN},
    INFINITE(acos, NAN, NAN),
    ODD(atan),
    ODD(sinh),
    INFINITE(sinh, -INFINITY, INFINITY),
    {"cosh", -0.0, 0, 1},
    INFINITE(cosh, INFINITY, INFINITY),
    ODD(tanh),
    INFINITE(tanh, -1, 1),
    ODD(asinh),
    INFINITE(asinh, -INFINITY, INFINITY),
    {"acosh", 1, 0, 0.0},
    {"acosh", 0.5, 0, NAN},
    INFINITE(acosh, NAN, INFINITY),
    ODD(atanh),
    {"atanh", 1, 0, INFINITY},
    {"atanh", -1, 0, -INFINITY},
    {"atanh", 1.5, 0, NAN},
    {"exp", -0.0, 0, 1},
    INFINITE(exp, 0.0, INFINITY),
    {"exp2", -0.0, 0, 1},
    INFINITE(exp2, 0.0, INFINITY),
    ODD(expm1),
    INFINITE(expm1, -1, INFINITY),
    {"log", 0.0, 0, -INFINITY},
    {"log", -0.0, 0, -INFINITY},
    {"log", 1, 0, 0.0},
    INFINITE(log, NAN, INFINITY),
    {"log2", -0.0, 0, -INFINITY},
    {"log2", 1, 0, 0.0},
    INFINITE(log2, NAN, INFINITY),
    {"log10", -0.0, 0, -INFINITY},
    {"log10", 1, 0, 0.0},
    INFINITE(log10, NAN, INFINITY),
    ODD(log1p),
    {"log1p", -1, 0, -INFINITY},
    {"log1p", -2, 0, NAN},
    INFINITE(log1p, NAN, INFINITY),
    ODD(cbrt),
    INFINITE(cbrt, -INFINITY, INFINITY),
    ODD(erf),
    INFINITE(erf, -1, 1),
    INFINITE(erfc, 2, 0.0),
    {"tgamma", 0.0, 0, INFINITY},
    {"tgamma", -0.0, 0, -INFINITY},
    {"tgamma", -2, 0, NAN},
    INFINITE(tgamma, NAN, INFINITY),
    {"lgamma", 1, 0, 0.0},
    {"lgamma", 2, 0, 0.0},
    {"lgamma", -3, 0, INFINITY},
    {"lgamma", -0.0, 0, INFINITY},
    INFINITE(lgamma, INFINITY, INFINITY),
    {"atan2", 0.0, -0.0, 0x1.921FB54442D18p1},
    {"atan2", -0.0, -0.0, -0x1.921FB54442D18p1},
    {"atan2", -0.0, 0.0, -0.0},
    {"atan2", 0.0, -1, 0x1.921FB54442D18p1},
    {"atan2", -0.0, 1, -0.0},
    {"atan2", 1, -0.0, 0x1.921FB54442D18p0},
    {"atan2", 1, INFINITY, 0.0},
    {"atan2", -1, -INFINITY, -0x1.921FB54442D18p1},
    {"atan2", INFINITY, 1, 0x1.921FB54442D18p0},
    {"atan2", INFINITY, -INFINITY, 0x1.2D97C7F3321D2p1},
    {"atan2", -INFINITY, INFINITY, -0x1.921FB54442D18p-1},
    {"atan2", NAN, 1, NAN},
    {"hypot", INFINITY, NAN, INFINITY},
    {"hypot", NAN, -INFINITY, INFINITY},
    {"hypot", -0.0, -3, 3},
    {"hypot", NAN, 1, NAN},
    {"pow", 0.0, -3, INFINITY},
    {"pow", -0.0, -3, -INFINITY},
    {"pow", -0.0, -2, INFINITY},
    {"pow", -0.0, -2.5, INFINITY},
    {"pow", -0.0, -INFINITY, INFINITY},
    {"pow", -0.0, 3, -0.0},
    {"pow", -0.0, 2, 0.0},
    {"pow", -1, INFINITY, 1},
    {"pow", -1, -INFINITY, 1},
    {"pow", 1, NAN, 1},
    {"pow", NAN, 0, 1},
    {"pow", NAN, -0.0, 1},
    {"pow", -2, 0.5, NAN},
    {"pow", 0.5, -INFINITY, INFINITY},
    {"pow", -2, -INFINITY, 0.0},
    {"pow", 0.5, INFINITY, 0.0},
    {"pow", 2, INFINITY, INFINITY},
    {"pow", -INFINITY, -3, -0.0},
    {"pow", -INFINITY, -2, 0.0},
    {"pow", -INFINITY, 3, -INFINITY},
    {"pow", -INFINITY, 2, INFINITY},
    {"pow", INFINITY, -1, 0.0},
    {"pow", INFINITY, 1, INFINITY},
    {"pow", NAN, 1, NAN},
    {"pow", 2, NAN, NAN},
};

static void check_specials(const struct function *f) {
  for (size_t i = 0; i < COUNT(specials); i++) {
    if (strcmp(specials[i].name, f->name))
      continue;
    double want = specials[i].want,
           got = f->ours_1 ? f->ours_1(specials[i].x) : f->ours_2(specials[i].x, specials[i].y);
    if (want != want ? got == got : bits_of(got) != bits_of(want)) {
      failed = true;
      printf("%s(%a, %a) is %a, but has to be %a  FAILED\n", f->name, specials[i].x, specials[i].y, got, want);
    }
  }
  double of_nan = f->ours_1 ? f->ours_1(NAN) : f->ours_2(NAN, 2);
  if (of_nan == of_nan) {
    failed = true;
    printf("%s of a NaN is %a  FAILED\n", f->name, of_nan);
  }
}

int main(int argc, char **argv) {
  long count = argc > 1 ? strtol(argv[1], NULL, 0) : 2000;
  const char *only = argc > 2 ? argv[2] : NULL;
  if (count <= 0) {
    fprintf(stderr, "usage: test-math64 [COUNT [FUNCTION]]\n");
    return 1;
  }
  mpfr_inits2(BITS, exact_x, exact_y, exact_result, (mpfr_ptr)NULL);
  for (size_t i = 0; i < COUNT(functions); i++) {
    const struct function *f = &functions[i];
    if (only && strcmp(only, f->name))
      continue;
    struct worst worst = {0};
    (f->ours_1 ? check_arguments_1 : check_arguments_2)(f, &worst, count);
    bool bad = !(worst.error <= f->bound);
    failed |= bad;
    printf("%-7s %9.4f ulp, bound %4.2f, rounded wrongly: %8.5f %% of %llu, worst at %a", f->name, worst.error,
           f->bound, 100.0 * (double)worst.wrong / (double)worst.count, (unsigned long long)worst.count, worst.x);
    if (f->ours_2)
      printf(", %a", worst.y);
    printf("%s\n", bad ? "  FAILED" : "");
    check_specials(f);
  }
  mpfr_clears(exact_x, exact_y, exact_result, (mpfr_ptr)NULL);
  return failed;
}
