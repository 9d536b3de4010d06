/* The error of a result, by MPFR and by the host's long double. */
#include "worst.h"

#include <math.h>
#include <stdio.h>

#define BITS 160 /* three times a double, so that nothing hides behind the reference's rounding */

/* The exponent of the unit in the last place of a number whose exponent is given. */
static int unit_of(const struct function *f, int exponent) {
  if (f->least_unit != 0 && exponent < ilogb(f->least_unit))
    exponent = ilogb(f->least_unit);
  return (exponent < -1022 ? -1022 : exponent > 1023 ? 1023 : exponent) - 52;
}

static double apply(const struct function *f, struct operand o) {
  return f->ours_1 ? f->ours_1(o.x) : f->ours_2(o.x, o.y);
}

double exact_error(const struct function *f, struct operand o) {
  static mpfr_t x, y, want;
  static bool initialised;
  if (!initialised) {
    mpfr_inits2(BITS, x, y, want, (mpfr_ptr)NULL);
    initialised = true;
  }
  double got = apply(f, o);
  mpfr_set_d(x, o.x, MPFR_RNDN);
  mpfr_set_d(y, o.y, MPFR_RNDN);
  if (f->exact_1)
    f->exact_1(want, x, MPFR_RNDN);
  else
    f->exact_2(want, x, y, MPFR_RNDN);
  if (mpfr_nan_p(want) || isnan(got))
    return mpfr_nan_p(want) && isnan(got) ? 0 : INFINITY;
  if (isinf(got) && mpfr_cmp_d(want, 0) != 0 && !mpfr_signbit(want) != !signbit(got))
    return INFINITY;
  if (mpfr_inf_p(want))
    return isinf(got) ? 0 : INFINITY;
  mpfr_set_ui_2exp(x, 1, 1024, MPFR_RNDN);
  bool beyond = mpfr_cmpabs(want, x) >= 0;
  if (isinf(got) && beyond)
    return 0;
  if (mpfr_zero_p(want))
    return fabs(got) / 0x1p-1074;
  int unit = unit_of(f, (int)mpfr_get_exp(want) - 1);
  if (isinf(got))
    mpfr_setsign(x, x, got < 0, MPFR_RNDN);
  else
    mpfr_set_d(x, got, MPFR_RNDN);
  mpfr_sub(want, want, x, MPFR_RNDN);
  mpfr_mul_2si(want, want, -unit, MPFR_RNDN);
  return fabs(mpfr_get_d(want, MPFR_RNDA));
}

double near_error(const struct function *f, struct operand o) {
  double got = apply(f, o);
  long double want = f->near_1 ? f->near_1((long double)o.x) : f->near_2((long double)o.x, (long double)o.y);
  if (isnan(want) || isnan(got))
    return isnan(want) && isnan(got) ? 0 : INFINITY;
  if (isinf(want) || want == 0)
    return (long double)got == want ? 0 : INFINITY;
  if (isinf(got) && fabsl(want) >= 0x1p1024L)
    return !signbit(want) == !signbit(got) ? 0 : INFINITY;
  long double ours = isinf(got) ? copysignl(0x1p1024L, (long double)got) : (long double)got;
  int exponent;
  frexpl(want, &exponent);
  return (double)(fabsl(ours - want) * ldexpl(1, -unit_of(f, exponent - 1)));
}

double error_of(const struct function *f, struct operand o, double interesting, bool control, bool *failed) {
  double error = near_error(f, o);
  if (!control && error < interesting - 0x1p-8)
    return error;
  double exact = exact_error(f, o);
  if (fabs(exact - error) > 0x1p-8) {
    fprintf(stderr, "%s(%a, %a): long double finds an error of %.5f, MPFR %.5f\n", f->name, o.x, o.y, error, exact);
    *failed = true;
  }
  return exact;
}
