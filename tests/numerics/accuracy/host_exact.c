/* The host's functions whose binary64 results are exact or correctly rounded, and functions of other types as adapted.h
   has them. */
#include <math.h>

#include "../operands.h"
#include "adapted.h"
#include "reference.h"

static double host_lround(double x) {
  return x >= -0x1p31 && x < 0x1p31 ? (double)llround(x) : NAN;
}
static double host_lrint(double x) {
  return x >= -0x1p31 && x < 0x1p31 ? (double)llrint(x) : NAN;
}
static double host_llround(double x) {
  return x >= -0x1p63 && x < 0x1p63 ? (double)llround(x) : NAN;
}
static double host_llrint(double x) {
  return x >= -0x1p63 && x < 0x1p63 ? (double)llrint(x) : NAN;
}
/* The library's macros for 0 and NaN are the least integer, for infinity the greatest. */
static double host_ilogb(double x) {
  return x == 0 || x != x ? -0x1p31 : x - x != 0 ? 0x1p31 : (double)ilogb(x);
}
static double host_rsqrt(double x) {
  return 1 / sqrt(x);
}
static double host_frexp(double x) {
  return x;
}
static double host_modf(double x) {
  double integer;
  return modf(x, &integer);
}
static double host_fmin(double x, double y) {
  return x != x ? y : y != y ? x : x < y || (x == y && signbit(x)) ? x : y;
}
static double host_fmax(double x, double y) {
  return -host_fmin(-x, -y);
}
static double host_nextafter(double x, double y) {
  return nextafterf((float)x, (float)y);
}
static double host_ldexp(double x, double y) {
  return ldexp(x, exponent_operand((float)y));
}
static double host_remquo(double x, double y) {
  return remainder(x, y);
}

#define HOST_1(name, host, exact, low, high)                                                                           \
  void host_##name##_chunk(struct chunk *c) {                                                                          \
    for (size_t i = 0; i <= CHUNK; i++)                                                                                \
      c->want[i] = host(float_of(c->operand[0][i]));                                                                   \
  }
#define HOST_2(name, host, exact, low, high)                                                                           \
  void host_##name##_chunk(struct chunk *c) {                                                                          \
    for (size_t i = 0; i <= CHUNK; i++)                                                                                \
      c->want[i] = host(float_of(c->operand[0][i]), float_of(c->operand[1][i]));                                       \
  }
#define HOST_3(name, host, exact, low, high)                                                                           \
  void host_##name##_chunk(struct chunk *c) {                                                                          \
    for (size_t i = 0; i <= CHUNK; i++)                                                                                \
      c->want[i] = host(float_of(c->operand[0][i]), float_of(c->operand[1][i]), float_of(c->operand[2][i]));           \
  }
EXACT_FUNCTIONS(HOST_1)
ADAPTED_FUNCTIONS(HOST_1)
EXACT_PAIRS(HOST_2)
ADAPTED_PAIRS(HOST_2)
TRIPLES(HOST_3)
