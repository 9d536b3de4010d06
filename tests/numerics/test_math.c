/* Exact functions of <math.h> that neither trax-accuracy's table nor sweep.c has, compiled for the host, against the
   host's: binary64, functions with two results, and those between the types. Bit by bit over special and random
   operands; exits with status 1 if any differ. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host.h"
#include "operands.h"

/* clang-format off */
#define LIKE_THE_HOST(X) \
  X(sinf) X(cosf) X(fmaf) X(modff) X(frexpf) X(ldexpf) X(ilogbf) X(nextafterf) X(lroundf) X(lrintf) X(llroundf) \
  X(llrintf) X(nexttowardf) X(remquof) X(fabs) X(floor) X(ceil) X(trunc) X(round) X(rint) X(fmin) X(fmax) X(fmod) \
  X(modf) X(frexp) X(ldexp) X(copysign) X(remainder) X(remquo) X(nextafter) X(fdim) X(logb) X(scalbln) X(ilogb) \
  X(lround) X(lrint) X(llround) X(llrint)
/* clang-format on */
LIKE_THE_HOST(RUNTIME_FUNCTION)
void rt_sincosf(float, float *, float *);

static double minimum(double x, double y) {
  return x != x ? y : y != y ? x : x < y || (x == y && signbit(x)) ? x : y;
}
static double maximum(double x, double y) {
  return -minimum(-x, -y);
}

static bool failed;

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

static void check_remainder(double x, double y) {
  int q, host_q;
  double rest = rt_remquo(x, y, &q), host_rest = remquo(x, y, &host_q);
  expect(same(rest, host_rest) && (rest != rest || (q & 7) == (host_q & 7)), "remquo", x, y);
  expect(same(rt_remainder(x, y), host_rest), "remainder", x, y);
}

static void check_all(void) {
  uint64_t state = 14;
  for (int i = 0, last = some_of(2000000); i < last; i++) {
    float x = random_float(&state), y = random_float(&state), z = random_float(&state);
    if (i & 1) /* cancellation and halfway cases */
      z = -(x * y) + (i & 2 ? 0 : float_of(float_bits_of(x * y) - (12u << 23)));
    if (i < (int)(COUNT(special_floats) * COUNT(special_floats))) {
      x = float_of(special_floats[(size_t)i / COUNT(special_floats)]);
      y = float_of(special_floats[(size_t)i % COUNT(special_floats)]);
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
  for (size_t i = 0, last = (size_t)some_of(2000000) + 4 * COUNT(special_doubles) * COUNT(special_doubles); i < last;
       i++) {
    double x = random_double(&state), y = random_double(&state);
    if (i < 4 * COUNT(special_doubles) * COUNT(special_doubles)) {
      x = double_of(special_doubles[i / 4 / COUNT(special_doubles)] | (uint64_t)(i & 1) << 63);
      y = double_of(special_doubles[i / 4 % COUNT(special_doubles)] | (uint64_t)(i & 2) << 62);
    }
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
  }
}

int main(void) {
  check_all();
  return failed;
}
