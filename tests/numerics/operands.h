/* Operands for the tests of arithmetic: every kind of number that has ever broken a soft-float, then random ones. */
#ifndef TRAX_TEST_OPERANDS_H
#define TRAX_TEST_OPERANDS_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* The number of random cases to run: a quarter of them, or all with TRAX_WHOLE in the environment. */
static inline int some_of(int cases) {
  return getenv("TRAX_WHOLE") ? cases : cases / 4;
}

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static inline double double_of(uint64_t bits) {
  double x;
  memcpy(&x, &bits, sizeof x);
  return x;
}
static inline uint64_t bits_of(double x) {
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}
static inline float float_of(uint32_t bits) {
  float x;
  memcpy(&x, &bits, sizeof x);
  return x;
}
static inline uint32_t float_bits_of(float x) {
  uint32_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}

/* splitmix64: the whole sequence follows from the state, so every failure repeats. */
static inline uint64_t random64(uint64_t *state) {
  uint64_t z = *state += 0x9E3779B97F4A7C15u;
  z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
  z = (z ^ z >> 27) * 0x94D049BB133111EBu;
  return z ^ z >> 31;
}

/* A random integer of random length, often near a power of two: uniform bits would hardly ever be small. */
static inline uint64_t random_integer(uint64_t *state) {
  uint64_t kind = random64(state);
  uint64_t x = random64(state) >> (kind & 63);
  if (kind >> 6 & 1)
    x = ((uint64_t)1 << (kind & 63)) + (uint64_t)(int64_t)(int)((kind >> 8) % 5) - 2;
  return kind >> 7 & 1 ? 0 - x : x;
}

/* A random double: uniform bits, or few significant bits (exact results and halfway cases), or close in exponent to 1.
 */
static inline double random_double(uint64_t *state) {
  uint64_t kind = random64(state), bits = random64(state);
  if (kind & 1)
    bits &= ~(uint64_t)0 << (kind >> 8 & 63);
  if (kind & 2)
    bits = (bits & 0x800FFFFFFFFFFFFFu) | (1023 - 30 + (kind >> 16 & 63)) << 52;
  if ((kind & 0x1C) == 0x1C) /* subnormal */
    bits &= 0x800FFFFFFFFFFFFFu;
  if ((kind & 0xE0) == 0xE0) /* runs of ones */
    bits |= ((uint64_t)1 << (kind >> 24 & 31)) - 1;
  return double_of(bits);
}

static inline float random_float(uint64_t *state) {
  uint64_t kind = random64(state);
  uint32_t bits = (uint32_t)random64(state);
  if (kind & 1)
    bits &= ~(uint32_t)0 << (kind >> 8 & 31);
  if (kind & 2)
    bits = (bits & 0x807FFFFF) | (uint32_t)(127 - 30 + (kind >> 16 & 127)) << 23;
  if ((kind & 0x1C) == 0x1C)
    bits &= 0x807FFFFF;
  return float_of(bits);
}

static const uint64_t special_doubles[] = {
    0, /* zero */
    1, /* least subnormal */
    2,
    3,
    0x0008000000000000, /* half the least normal */
    0x000FFFFFFFFFFFFF, /* greatest subnormal */
    0x0010000000000000, /* least normal */
    0x0010000000000001,
    0x001FFFFFFFFFFFFF,
    0x0020000000000000,
    0x3690000000000000, /* half the least subnormal float */
    0x3690000000000001,
    0x36A0000000000000, /* least subnormal float */
    0x380FFFFFDFFFFFFF, /* around the least normal float */
    0x380FFFFFE0000000,
    0x380FFFFFF0000000,
    0x3810000000000000,
    0x3CA0000000000000, /* 2^-53 and neighbours */
    0x3CA0000000000001,
    0x3CB0000000000000,
    0x3FE0000000000000, /* 1/2 */
    0x3FEFFFFFFFFFFFFF,
    0x3FF0000000000000, /* 1 */
    0x3FF0000000000001,
    0x3FF0000010000000, /* 1 and half a unit of a float */
    0x3FF0000010000001,
    0x3FF0000030000000,
    0x3FF5555555555555,
    0x3FF8000000000000,
    0x3FFFFFFFFFFFFFFF,
    0x4000000000000000,
    0x4008000000000000, /* 3 */
    0x400921FB54442D18,
    0x41DFFFFFFFC00000, /* 2^31 - 1 and around */
    0x41E0000000000000,
    0x41EFFFFFFFE00000, /* 2^32 - 1 */
    0x41F0000000000000,
    0x433FFFFFFFFFFFFF, /* 2^53 - 1, 2^53, and what odd numbers round to */
    0x4340000000000000,
    0x4340000000000001,
    0x43DFFFFFFFFFFFFF,
    0x43E0000000000000, /* 2^63 */
    0x43EFFFFFFFFFFFFF,
    0x43F0000000000000, /* 2^64 */
    0x47EFFFFFE0000000, /* greatest float */
    0x47EFFFFFEFFFFFFF, /* rounds to it; the next one to infinity */
    0x47EFFFFFF0000000,
    0x47F0000000000000,
    0x7FDFFFFFFFFFFFFF,
    0x7FE0000000000000,
    0x7FEFFFFFFFFFFFFF, /* greatest */
    0x7FF0000000000000, /* infinity */
    0x7FF0000000000001, /* signalling NaN */
    0x7FF8000000000000, /* quiet NaN */
    0x7FFFFFFFFFFFFFFF,
};

/* Zeros, subnormals, ends of the functions' pieces, where conversions to integers end, the greatest, infinity, NaNs. */
static const uint32_t special_floats[] = {
    0,          1,          2,          0x007FFFFF, 0x00800000, 0x00800001, 0x3E800000, 0x3ED413CC, 0x3ED413CD,
    0x3EFFFFFF, 0x3F000000, 0x3F3504F3, 0x3F490FDB, 0x3F7FFFFF, 0x3F800000, 0x3F800001, 0x3FC90FDB, 0x40000000,
    0x40400000, 0x40490FDB, 0x40A00000, 0x42FE0000, 0x43000000, 0x43150000, 0x4AFFFFFF, 0x4B000000, 0x4B000001,
    0x4B7FFFFF, 0x4B800000, 0x4C000000, 0x4EFFFFFF, 0x4F000000, 0x4F800000, 0x5EFFFFFF, 0x5F000000, 0x5F7FFFFF,
    0x5F800000, 0x7E800000, 0x7F000000, 0x7F7FFFFF, 0x7F800000, 0x7F800001, 0x7FC00000};

static const uint64_t special_integers[] = {0,
                                            1,
                                            2,
                                            3,
                                            5,
                                            7,
                                            9,
                                            10,
                                            15,
                                            16,
                                            100,
                                            255,
                                            256,
                                            641,
                                            1000,
                                            65535,
                                            65536,
                                            65537,
                                            0x7FFFFF,
                                            0x800000,
                                            0xFFFFFF,
                                            0x1000000,
                                            0x1000001,
                                            0x1000003,
                                            0x3B9ACA00,
                                            0x55555555,
                                            0x7FFFFFFF,
                                            0x80000000,
                                            0x80000001,
                                            0xAAAAAAAA,
                                            0xFFFFFF7F,
                                            0xFFFFFF80,
                                            0xFFFFFF81,
                                            0xFFFFFFFE,
                                            0xFFFFFFFF,
                                            0x100000000,
                                            0x100000001,
                                            0x1FFFFFFFF,
                                            0x123456789ABCDEF,
                                            0x1FFFFFFFFFFFFF,
                                            0x20000000000001,
                                            0x20000000000003,
                                            0x7FFFFFBFFFFFFFFF,
                                            0x7FFFFFC000000000,
                                            0x7FFFFFFFFFFFFC00,
                                            0x7FFFFFFFFFFFFE00,
                                            0x7FFFFFFFFFFFFFFF,
                                            0x8000000000000000,
                                            0x8000000000000001,
                                            0x8000000000000400,
                                            0xFFFFFFFF00000000,
                                            0xFFFFFF8000000000,
                                            0xFFFFFFFFFFFFF400,
                                            0xFFFFFFFFFFFFFBFF,
                                            0xFFFFFFFFFFFFFC00,
                                            0xFFFFFFFFFFFFFFFF};

#endif
