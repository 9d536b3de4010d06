/* Mutants of floating point: arithmetic.inc over the operations of trax/semantics.h. */
#include "mutants.h"
#include "trax/semantics.h"

#include <fenv.h>
#include <stdio.h>
#include <stdlib.h>

enum { QUIET = 0x00400000, INF = 0x7F800000, ONE = 0x3F800000, QNAN = 0x7FC00000, LARGEST = 0x7F7FFFFF };
#define SIGN 0x80000000u

typedef enum operation {
  OPERATION_fadd,
  OPERATION_fsub,
  OPERATION_fmul,
  OPERATION_fdiv,
  OPERATION_fmin,
  OPERATION_fmax,
  OPERATION_feq,
  OPERATION_flt,
  OPERATION_fle,
  OPERATION_fcvt_w_s,
  OPERATION_fcvt_wu_s,
  OPERATION_fcvt_s_w,
  OPERATION_fcvt_s_wu,
  OPERATION_frsqrt
} operation;

static const char *const mnemonics[] = {"fadd", "fsub", "fmul",     "fdiv",      "fmin",     "fmax",      "feq",
                                        "flt",  "fle",  "fcvt.w.s", "fcvt.wu.s", "fcvt.s.w", "fcvt.s.wu", "frsqrt"};

static const struct {
  operation op;
  const char *what;
} texts[] = {
#define MUTANT(OPERATION, ID, WHAT, RESULT) {OPERATION_##OPERATION, WHAT},
#include "arithmetic.inc"
#undef MUTANT
};

enum {
#define MUTANT(OPERATION, ID, WHAT, RESULT) MUTANT_##OPERATION##_##ID,
#include "arithmetic.inc"
#undef MUTANT
  MUTANT_COUNT
};

unsigned trax_arithmetic_mutants(void) {
  return MUTANT_COUNT;
}

void trax_arithmetic_mutant(unsigned index, struct trax_mutant_text *text) {
  snprintf(text->mnemonic, sizeof text->mnemonic, "%s", mnemonics[texts[index].op]);
  snprintf(text->what, sizeof text->what, "%s", texts[index].what);
}

/* --- functions of arithmetic.inc --- */

static bool is_nan(uint32_t a) {
  return trax_is_nan(a);
}

static bool is_signalling(uint32_t a) {
  return is_nan(a) && !(a & QUIET);
}

static bool is_infinite(uint32_t a) {
  return (a & ~SIGN) == INF;
}

static unsigned exponent(uint32_t a) {
  return a >> 23 & 0xFF;
}

static bool both_finite(uint32_t a, uint32_t b) {
  return exponent(a) != 255 && exponent(b) != 255;
}

static uint32_t flush(uint32_t a) {
  return exponent(a) == 0 ? a & SIGN : a;
}

static uint32_t canonical(float value) {
  return trax_canonical(value);
}

/* The right result. */
static uint32_t again(operation op, uint32_t a, uint32_t b) {
  switch (op) {
  case OPERATION_fadd:
    return trax_true_fadd(a, b);
  case OPERATION_fsub:
    return trax_true_fsub(a, b);
  case OPERATION_fmul:
    return trax_true_fmul(a, b);
  case OPERATION_fdiv:
    return trax_true_fdiv(a, b);
  case OPERATION_fmin:
    return trax_true_fmin(a, b);
  case OPERATION_fmax:
    return trax_true_fmax(a, b);
  case OPERATION_feq:
    return trax_true_feq(a, b);
  case OPERATION_flt:
    return trax_true_flt(a, b);
  case OPERATION_fle:
    return trax_true_fle(a, b);
  case OPERATION_fcvt_w_s:
    return trax_true_fcvt_w_s(a);
  case OPERATION_fcvt_wu_s:
    return trax_true_fcvt_wu_s(a);
  case OPERATION_fcvt_s_w:
    return trax_true_fcvt_s_w(a);
  case OPERATION_fcvt_s_wu:
    return trax_true_fcvt_s_wu(a);
  case OPERATION_frsqrt:
    return trax_true_frsqrt(a);
  }
  return 0;
}

/* With the host's rounding in another direction. */
static uint32_t directed(operation op, uint32_t a, uint32_t b, int direction) {
  fesetround(direction);
  const uint32_t result = again(op, a, b);
  fesetround(FE_TONEAREST);
  return result;
}

static uint32_t from_integer(operation op, uint32_t a, int direction) {
  return directed(op, a, 0, direction);
}

static float root(float x, int direction) {
  fesetround(direction);
  const volatile double wide = x;
  const volatile double inverse = 1.0 / sqrt(wide);
  const volatile float result = (float)inverse;
  fesetround(FE_TONEAREST);
  return result;
}

static double integer(operation op, uint32_t a) {
  return op == OPERATION_fcvt_s_w ? (double)trax_signed(a) : (double)a;
}

/* The result in binary64, exact where it lies halfway between two floats. */
static double exact(operation op, float x, float y) {
  switch (op) {
  case OPERATION_fadd:
    return (double)x + (double)y;
  case OPERATION_fsub:
    return (double)x - (double)y;
  case OPERATION_fmul:
    return (double)x * (double)y;
  default:
    return (double)x / (double)y;
  }
}

/* The magnitude of `value` in units of the last place of the float below it: the integer part and what remains. */
static double in_units(double value, double *unit) {
  int binade;
  frexp(value, &binade);
  *unit = ldexp(1, (binade < -125 ? -125 : binade) - 24);
  return fabs(value) / *unit;
}

static uint32_t from_units(double value, double units, double unit) {
  return trax_from_float((float)copysign(units * unit, value));
}

static bool is_number(double value) {
  return isfinite(value) && value != 0;
}

static uint32_t ties_away(double value, uint32_t right) {
  double unit;
  const double units = is_number(value) ? in_units(value, &unit) : 0;
  return is_number(value) && units - floor(units) == 0.5 ? from_units(value, ceil(units), unit) : right;
}

static uint32_t ties_odd(double value, uint32_t right) {
  double unit;
  const double units = is_number(value) ? in_units(value, &unit) : 0, below = floor(units);
  if (!is_number(value) || units - below != 0.5)
    return right;
  return from_units(value, fmod(below, 2) != 0 ? below : below + 1, unit);
}

/* Rounded to nearest from as many bits beyond the last place, those behind cut off. */
static uint32_t keep(double value, int bits, uint32_t right) {
  double unit;
  if (!is_number(value))
    return right;
  const double units = in_units(value, &unit);
  return from_units(value, rint(ldexp(floor(ldexp(units, bits)), -bits)), unit);
}

static uint32_t twice(double value, uint32_t right) {
  double unit;
  if (!is_number(value))
    return right;
  const double units = in_units(value, &unit);
  return from_units(value, rint(rint(units * 4) / 4), unit);
}

/* Whether rounding has carried into the next binade. */
static bool carried(operation op, uint32_t a, uint32_t b, uint32_t r) {
  return both_finite(a, b) && exponent(r) > 0 && exponent(r) < 255 && !(r & 0x7FFFFFu) &&
         exponent(directed(op, a, b, FE_TOWARDZERO)) != exponent(r);
}

/* Whether the exponents differ by n or more, zeros aside. */
static bool far(uint32_t a, uint32_t b, int n) {
  return both_finite(a, b) && a << 1 && b << 1 && abs((int)exponent(a) - (int)exponent(b)) >= n;
}

/* The sum without the lesser operand. */
static uint32_t dominant(operation op, uint32_t a, uint32_t b) {
  return exponent(a) > exponent(b) ? a : op == OPERATION_fsub ? b ^ SIGN : b;
}

static bool out_of_range(operation op, float x) {
  return op == OPERATION_fcvt_w_s ? !(x >= -0x1p31f && x < 0x1p31f) : !(x > -1 && x < 0x1p32f);
}

static uint32_t wrapped(float x, uint32_t right) {
  return isfinite(x) ? (uint32_t)(int64_t)fmod((double)truncf(x), 0x1p32) : right;
}

static uint32_t to_integer(operation op, float x, uint32_t right) {
  return isnan(x) ? right : again(op, trax_from_float(x), 0);
}

/* --- the operations --- */

static uint32_t mutate(operation op, uint32_t a, uint32_t b) {
  const uint32_t r = again(op, a, b);
  const float x = trax_to_float(a), y = trax_to_float(b);
  const int index = trax_mutant_index(trax_statement_mutants(), MUTANT_COUNT);
  if (index < 0 || texts[index].op != op)
    return r;
  switch (index) {
#define MUTANT(OPERATION, ID, WHAT, RESULT)                                                                            \
  case MUTANT_##OPERATION##_##ID:                                                                                      \
    return RESULT;
#include "arithmetic.inc"
#undef MUTANT
  }
  return r;
}

#define UNARY(NAME)                                                                                                    \
  uint32_t trax_##NAME(uint32_t a) {                                                                                   \
    return mutate(OPERATION_##NAME, a, 0);                                                                             \
  }
#define BINARY(NAME)                                                                                                   \
  uint32_t trax_##NAME(uint32_t a, uint32_t b) {                                                                       \
    return mutate(OPERATION_##NAME, a, b);                                                                             \
  }
BINARY(fadd)
BINARY(fsub)
BINARY(fmul)
BINARY(fdiv)
BINARY(fmin)
BINARY(fmax)
BINARY(feq)
BINARY(flt)
BINARY(fle)
UNARY(fcvt_w_s)
UNARY(fcvt_wu_s)
UNARY(fcvt_s_w)
UNARY(fcvt_s_wu)
UNARY(frsqrt)
