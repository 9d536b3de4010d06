/* Operands where errors are large: every magnitude alike, near the breakpoints of an implementation, near zeros and
   poles, where results become subnormal or overflow; and neighbours of operands found before. */
#include "worst.h"

#include "../operands.h"

#include <math.h>
#include <stdlib.h>

static double uniform(uint64_t *state) {
  return (double)(random64(state) >> 11) * 0x1p-53;
}

/* A number of either sign; the logarithm of its magnitude is uniform below 1. */
static double small(uint64_t *state, unsigned most) {
  double x = ldexp(1 + uniform(state), -1 - (int)(random64(state) % most));
  return random64(state) & 1 ? x : -x;
}

static double between(double low, double high, uint64_t *state) {
  uint64_t first = bits_of(low), count = bits_of(high) - first + 1;
  return double_of(first + random64(state) % count);
}

double near_quarter_turn(uint64_t *state) {
  enum { LOWEST = -60, HIGHEST = 971, BITS = 1300 };
  static double found[2][HIGHEST - LOWEST + 1];
  if (found[0][0] == 0) { /* denominators of convergents of 2^e * 2/pi: the last two of at most 53 bits */
    mpfr_t alpha, part;
    mpfr_inits2(BITS, alpha, part, (mpfr_ptr)NULL);
    for (int e = LOWEST; e <= HIGHEST; e++) {
      mpfr_const_pi(alpha, MPFR_RNDN);
      mpfr_ui_div(alpha, 2, alpha, MPFR_RNDN);
      mpfr_mul_2si(alpha, alpha, e, MPFR_RNDN);
      double before = 0, q = 1;
      for (;;) {
        mpfr_frac(part, alpha, MPFR_RNDN);
        mpfr_ui_div(alpha, 1, part, MPFR_RNDN);
        mpfr_floor(part, alpha);
        double next = mpfr_get_d(part, MPFR_RNDN) * q + before;
        if (!(next < 0x1p53))
          break;
        before = q;
        q = next;
      }
      found[0][e - LOWEST] = ldexp(q, e);
      found[1][e - LOWEST] = ldexp(before, e);
    }
    mpfr_clears(alpha, part, (mpfr_ptr)NULL);
  }
  return found[random64(state) & 1][random64(state) % (HIGHEST - LOWEST + 1)];
}

static double breakpoint(const struct function *f, uint64_t *state) {
  size_t count = 0;
  while (count < COUNT(f->breakpoints) && f->breakpoints[count] != 0)
    count++;
  return f->breakpoints[random64(state) % count];
}

static double signed_as(const struct function *f, double x, uint64_t *state) {
  if (f->signs == POSITIVE || (f->signs == BOTH_SIGNS && random64(state) & 1))
    return fabs(x);
  return -fabs(x);
}

static double new_argument(const struct function *f, uint64_t *state) {
  uint64_t kind = random64(state) % 16;
  if (kind < 5)
    return signed_as(f, between(f->low, f->high, state), state);
  if (kind < 9)
    return f->from + uniform(state) * (f->to - f->from);
  if (kind < 12)
    return signed_as(f, breakpoint(f, state) * (1 + small(state, 52)), state);
  if (kind == 12) /* near multiples of pi/2 by chance, near integers and halves */
    return signed_as(f, (double)(random64(state) >> (random64(state) % 64)) * (random64(state) & 1 ? 0.5 : M_PI_2),
                     state);
  if (kind == 13) {
    double x = rint(f->from + uniform(state) * (f->to - f->from)) + small(state, 60);
    return signed_as(f, x, state);
  }
  if (kind == 14)
    return signed_as(f, near_quarter_turn(state), state);
  return signed_as(f, random_double(state), state);
}

/* x such that x^y is a number: the logarithm of the result is anywhere in the range, or near its ends. */
static struct operand new_power(uint64_t *state) {
  uint64_t kind = random64(state) % 8;
  double x = kind < 3   ? fabs(random_double(state))
             : kind < 6 ? 1 + small(state, 52)
                        : between(0x1p-1074, 0x1p1023, state);
  double log2_result = kind & 1   ? (2 * uniform(state) - 1) * 1076
                       : kind & 2 ? -1022 - 54 * uniform(state)
                                  : 1023 + uniform(state) * 1.01;
  double y = log2_result / log2(x);
  if (random64(state) % 8 == 0)
    return (struct operand){-x, rint(y)};
  if (random64(state) % 16 == 0)
    return (struct operand){x, small(state, 60)};
  return (struct operand){x, y};
}

static struct operand new_pair(const struct function *f, uint64_t *state) {
  uint64_t kind = random64(state) % 16;
  double x = kind & 1 ? between(0x1p-1074, 0x1p1023, state) : ldexp(1 + uniform(state), (int)(random64(state) % 3) - 1);
  if (random64(state) % 8 == 0) /* results at the ends of the range */
    x = random64(state) & 1 ? between(0x1p-1074, 0x1p-960, state) : between(0x1p1000, 0x1.FFFFFFFFFFFFFp1023, state);
  if (random64(state) & 1)
    x = -x;
  if (kind < 5)
    return (struct operand){x, x * ldexp(1 + uniform(state), (int)(random64(state) % 130) - 65)};
  if (kind < 9)
    return (struct operand){x, x * breakpoint(f, state) * (1 + small(state, 52))};
  if (kind < 11)
    return (struct operand){x * breakpoint(f, state) * (1 + small(state, 52)), x};
  if (kind < 13)
    return (struct operand){x, x * small(state, 12)};
  if (kind < 14)
    return (struct operand){x * small(state, 12), x};
  if (kind < 15)
    return (struct operand){x, between(0x1p-1074, 0x1p1023, state)};
  return (struct operand){random_double(state), random_double(state)};
}

static bool is_signalling(double x) {
  return isnan(x) && !(bits_of(x) >> 51 & 1);
}

bool is_defined(const struct function *f, struct operand o) {
  if (is_signalling(o.x) || (f->ours_2 && is_signalling(o.y)))
    return false;
  bool lgamma = f->near_1 == lgammal;
  return !lgamma || !signbit(o.x) == (f->signs == POSITIVE);
}

struct operand new_operand(const struct function *f, uint64_t *state) {
  for (;;) {
    struct operand o = {0, 0};
    if (f->ours_1)
      o.x = new_argument(f, state);
    else
      o = f->near_2 == powl ? new_power(state) : new_pair(f, state);
    if (is_defined(f, o))
      return o;
  }
}

static double moved(double x, uint64_t *state) {
  uint64_t bits = bits_of(x), distance = random64(state) >> (8 + random64(state) % 56);
  uint64_t other = random64(state) & 1 ? bits + distance : bits - distance;
  return (bits ^ other) >> 63 ? x : double_of(other);
}

struct operand neighbour(const struct function *f, struct operand o, uint64_t *state) {
  uint64_t kind = random64(state) % 4;
  struct operand n = o;
  if (f->ours_1) {
    n.x = moved(o.x, state);
  } else {
    if (kind != 0)
      n.x = moved(o.x, state);
    if (kind != 1)
      n.y = moved(o.y, state);
    if (kind == 3 && f->near_2 != powl) {
      int scale = (int)(random64(state) % 2100) - 1050;
      n = (struct operand){ldexp(n.x, scale), ldexp(n.y, scale)};
    }
  }
  return is_defined(f, n) ? n : o;
}
