/* The reciprocals that division builds on, and the native twin's reciprocal square root: the claims that their comments
   make.

     test-reciprocals      every 61st divisor, every significand of the root
     test-reciprocals 1    every divisor: half a minute */
#include <stdio.h>
#include <stdlib.h>

#include "../../runtime/include/trax.h"
#include "../../runtime/internal/divide.h"
#include "operands.h"

static int failures;

static void expect(int condition, const char *claim, unsigned long long x) {
  if (condition)
    return;
  if (failures++ < 10)
    printf("%s: not for %#llx\n", claim, x);
}

/* 2^32/d - 2 < reciprocal(d) <= 2^32/d: then a quotient from it is short by less than 3, whatever the dividend. */
static void check_reciprocal(uint32_t d) {
  uint64_t product = (uint64_t)reciprocal(d) * d;
  expect(product <= (uint64_t)1 << 32 && ((uint64_t)1 << 32) - product < 2 * (uint64_t)d, "reciprocal", d);
}

static void check_reciprocal_q63(uint32_t d) {
  uint64_t exact = ((uint64_t)1 << 63) / d, x = reciprocal_q63(d);
  expect(x <= exact && exact - x < 6, "reciprocal_q63", d);
}

static void check_reciprocal_2by1(uint32_t d) {
  expect(reciprocal_2by1(d) == (uint32_t)(UINT64_MAX / d - ((uint64_t)1 << 32)), "reciprocal_2by1", d);
}

static void check_reciprocal_3by2(uint64_t d) {
  unsigned __int128 ones = ((unsigned __int128)UINT32_MAX << 64) | UINT64_MAX;
  expect(reciprocal_3by2(d) == (uint32_t)(ones / d - ((uint64_t)1 << 32)), "reciprocal_3by2", d);
}

/* y is 1/sqrt(x) correctly rounded if x lies between the inverse squares of the two midpoints beside y. With integers:
   x = m * 2^e, y = s * 2^k, and (2s +- 1)^2 * m compared with a power of two; 74 bits. */
static void check_root(uint32_t bits) {
  float x = float_of(bits), y = trax_rsqrt(x);
  int e = (int)(bits >> 23) - 150, k = (int)(float_bits_of(y) >> 23) - 150;
  unsigned __int128 m = (bits & 0x7FFFFF) | 0x800000, s = (float_bits_of(y) & 0x7FFFFF) | 0x800000;
  unsigned __int128 one = (unsigned __int128)1 << (2 - e - 2 * k); /* of m * (2s)^2 */
  unsigned __int128 above = (2 * s + 1) * (2 * s + 1) * m;
  unsigned __int128 below = s == 0x800000 ? (4 * s - 1) * (4 * s - 1) * m : (2 * s - 1) * (2 * s - 1) * m * 4;
  expect(above > one && below < 4 * one, "trax_rsqrt", bits);
}

int main(int argc, char **argv) {
  unsigned long stride = argc > 1 ? strtoul(argv[1], NULL, 0) : 61;
  if (stride == 0) {
    fprintf(stderr, "usage: test-reciprocals [STRIDE]\n");
    return 1;
  }
  for (uint64_t d = 1; d <= UINT32_MAX; d += stride) {
    check_reciprocal((uint32_t)d);
    if (d >> 31)
      check_reciprocal_2by1((uint32_t)d);
    if (d > 1u << 31)
      check_reciprocal_q63((uint32_t)d);
  }
  for (int bit = 0; bit < 32; bit++) /* powers of two and their neighbours, where the float estimate is at its worst */
    for (int64_t near = -300; near <= 300; near++) {
      uint32_t d = (uint32_t)(((int64_t)1 << bit) + near);
      if (d)
        check_reciprocal(d);
      check_reciprocal_2by1(d | 0x80000000u);
    }
  uint64_t state = 15;
  for (int i = 0; i < 3000000; i++)
    check_reciprocal_3by2(random_integer(&state) | (uint64_t)1 << 63);
  for (size_t i = 0; i < COUNT(special_integers); i++)
    check_reciprocal_3by2(special_integers[i] | (uint64_t)1 << 63);
  for (uint32_t bits = 0x3F800000; bits < 0x40800000; bits++) /* [1, 4): both parities of the exponent */
    check_root(bits);
  for (uint32_t bits = 0x00800000; bits < 0x7F800000; bits += 0x000FFFF1) /* other exponents only shift */
    check_root(bits);
  expect(trax_rsqrt(0.0f) == INFINITY && trax_rsqrt(-0.0f) == -INFINITY && trax_rsqrt(INFINITY) == 0, "special", 0);
  expect(float_bits_of(trax_rsqrt(-1.0f)) == FLOAT_NAN && float_bits_of(trax_rsqrt(-NAN)) == FLOAT_NAN, "NaN", 0);
  if (failures)
    printf("%d failures\n", failures);
  return failures != 0;
}
