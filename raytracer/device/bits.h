/* Floats compared as integers. On the TP this costs nothing (one register file) and it keeps comparisons off the
   floating-point adder, which eight TPs share: the integer unit is the TP's own. For floats that are not NaN, a < b is
   the same as float_bits(a) < float_bits(b) unless both are negative. */
#ifndef TRAX_DEVICE_BITS_H
#define TRAX_DEVICE_BITS_H

#include <stdint.h>

static inline int32_t float_bits(float value) {
  int32_t bits;
  __builtin_memcpy(&bits, &value, sizeof bits);
  return bits;
}

static inline float bits_float(int32_t bits) {
  float value;
  __builtin_memcpy(&value, &bits, sizeof value);
  return value;
}

/* Keeps the compiler from reasoning about a value (and so from turning integer tests of floats back into tests of
   floats, which the adder would do). Takes no instruction. The twin's compiler may know everything. */
#ifdef __trax__
#define HIDE_ORIGIN(value) ((value) = (__typeof__(value))__builtin_trax_opaque((unsigned)(value)))
#else
#define HIDE_ORIGIN(value) ((void)0)
#endif

/* Before a loop of few iterations. */
#ifdef __clang__
#define KEEP_ROLLED _Pragma("clang loop unroll(disable)")
#else
#define KEEP_ROLLED
#endif

#define SIGN_BIT INT32_MIN

/* The bits of |value|; ordered like the magnitudes themselves. */
static inline int32_t magnitude(float value) {
  return float_bits(value) & ~SIGN_BIT;
}

static inline int32_t larger(int32_t a, int32_t b) {
  return a > b ? a : b;
}

static inline int32_t smaller(int32_t a, int32_t b) {
  return a < b ? a : b;
}

#endif
