/* The arithmetic of trax/semantics.h, checked by means apart from it: exact integers for the reciprocal square root, the
   IEEE 754-2019 tables of special cases for the rest. */
#include "trax/semantics.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

__extension__ typedef unsigned __int128 uint128;

enum { ZERO = 0, ONE = 0x3F800000, INF = 0x7F800000, QNAN = 0x7FC00000, SNAN = 0x7F800001 };
#define NEG(a) ((uint32_t)(a) | 0x80000000u)

/* All significands at both parities of the exponent: scaling by powers of 4 is exact, so this covers every normal number. r =
   m * 2^e is the nearest to 1/sqrt(n * 2^k) if and only if n (2m-1)^2 2^(k+2e-2) <= 1 <= n (2m+1)^2 2^(k+2e-2). */
static void test_rsqrt_is_correctly_rounded(void **state) {
  (void)state;
  unsigned wrong = 0;
  for (uint32_t a = 0x3F000000u; a < 0x40000000u; a++) {
    uint32_t r = trax_frsqrt(a);
    uint32_t n = (a & 0x7FFFFFu) | 0x800000u, m = (r & 0x7FFFFFu) | 0x800000u;
    int k = (int)(a >> 23) - 150, e = (int)(r >> 23) - 150;
    uint128 one = (uint128)1 << -(k + 2 * e - 2);
    uint128 above = (uint128)n * ((uint64_t)(2 * m + 1) * (2 * m + 1));
    uint64_t odd = m == 0x800000u ? 4 * (uint64_t)m - 1 : 2 * (2 * (uint64_t)m - 1); /* twice the lower midpoint */
    uint128 below = (uint128)n * odd * odd;
    wrong += !(above >= one && below <= 4 * one);
  }
  assert_int_equal(wrong, 0);
}

static void test_rsqrt_special_cases(void **state) {
  (void)state;
  assert_int_equal(trax_frsqrt(ZERO), INF);
  assert_int_equal(trax_frsqrt(NEG(ZERO)), NEG(INF));
  assert_int_equal(trax_frsqrt(INF), ZERO);
  assert_int_equal(trax_frsqrt(NEG(INF)), QNAN);
  assert_int_equal(trax_frsqrt(NEG(ONE)), QNAN);
  assert_int_equal(trax_frsqrt(SNAN), QNAN);
  assert_int_equal(trax_frsqrt(0x00000001u), 0x64B504F3u); /* 2^-149: 2^74.5 = 0x1.6A09E667F3p74 */
  assert_int_equal(trax_frsqrt(0x00000002u), 0x64800000u); /* 2^-148: 2^74 */
}

static void test_nan_is_canonical(void **state) {
  (void)state;
  uint32_t nans[] = {QNAN, SNAN, 0x7FFFFFFFu, 0xFFC00001u};
  for (size_t n = 0; n < 4; n++) {
    assert_int_equal(trax_fadd(nans[n], ONE), QNAN);
    assert_int_equal(trax_fsub(ONE, nans[n]), QNAN);
    assert_int_equal(trax_fmul(nans[n], nans[3 - n]), QNAN);
    assert_int_equal(trax_fdiv(ONE, nans[n]), QNAN);
    assert_int_equal(trax_fmin(nans[n], ONE), ONE);
    assert_int_equal(trax_fmax(ONE, nans[n]), ONE);
    assert_int_equal(trax_fmax(nans[n], nans[3 - n]), QNAN);
    assert_int_equal(trax_feq(nans[n], nans[n]) | trax_flt(ONE, nans[n]) | trax_fle(nans[n], ONE), 0);
  }
  assert_int_equal(trax_fsub(INF, INF), QNAN);
  assert_int_equal(trax_fmul(ZERO, INF), QNAN);
  assert_int_equal(trax_fdiv(ZERO, ZERO), QNAN);
  assert_int_equal(trax_fdiv(INF, NEG(INF)), QNAN);
  assert_int_equal(trax_fdiv(NEG(ONE), ZERO), NEG(INF));
}

static void test_signed_zeros(void **state) {
  (void)state;
  assert_int_equal(trax_fmin(ZERO, NEG(ZERO)), NEG(ZERO));
  assert_int_equal(trax_fmin(NEG(ZERO), ZERO), NEG(ZERO));
  assert_int_equal(trax_fmax(ZERO, NEG(ZERO)), ZERO);
  assert_int_equal(trax_fmax(NEG(ZERO), ZERO), ZERO);
  assert_int_equal(trax_feq(ZERO, NEG(ZERO)), 1);
  assert_int_equal(trax_flt(NEG(ZERO), ZERO), 0);
  assert_int_equal(trax_fsub(ONE, ONE), ZERO);
  assert_int_equal(trax_fadd(NEG(ZERO), NEG(ZERO)), NEG(ZERO));
}

static void test_subnormals_are_kept(void **state) {
  (void)state;
  assert_int_equal(trax_fadd(1, 1), 2);
  assert_int_equal(trax_fmul(0x00800000u, 0x3F000000u), 0x00400000u); /* 2^-126 * 0.5 */
  assert_int_equal(trax_fdiv(0x00800000u, 0x4B000000u), 1);           /* 2^-126 / 2^23 */
  assert_int_equal(trax_fmul(1, 0x3F000000u), 0);                     /* a tie, to even */
}

static void test_conversions_saturate(void **state) {
  (void)state;
  assert_int_equal(trax_fcvt_w_s(0x4F000000u), 0x7FFFFFFFu); /* 2^31 */
  assert_int_equal(trax_fcvt_w_s(0xCF000000u), 0x80000000u); /* -2^31 */
  assert_int_equal(trax_fcvt_w_s(NEG(INF)), 0x80000000u);
  assert_int_equal(trax_fcvt_w_s(QNAN), 0);
  assert_int_equal(trax_fcvt_w_s(0xBFFFFFFFu), 0xFFFFFFFFu); /* -1.99: towards zero */
  assert_int_equal(trax_fcvt_wu_s(0x4F800000u), 0xFFFFFFFFu);
  assert_int_equal(trax_fcvt_wu_s(0x4F7FFFFFu), 0xFFFFFF00u);
  assert_int_equal(trax_fcvt_wu_s(NEG(ONE)), 0);
  assert_int_equal(trax_fcvt_wu_s(SNAN), 0);
  assert_int_equal(trax_fcvt_s_w(0x80000000u), 0xCF000000u);
  assert_int_equal(trax_fcvt_s_w(0x01000001u), 0x4B800000u); /* 2^24 + 1: a tie, to even */
  assert_int_equal(trax_fcvt_s_wu(0xFFFFFFFFu), 0x4F800000u);
}

static void test_integers(void **state) {
  (void)state;
  assert_int_equal(trax_sra(0x80000000u, 0), 0x80000000u);
  assert_int_equal(trax_sra(0x80000000u, 31), 0xFFFFFFFFu);
  assert_int_equal(trax_sra(0x40000000u, 30), 1);
  assert_int_equal(trax_mulh(0x80000000u, 0x80000000u), 0x40000000u);
  assert_int_equal(trax_mulh(0xFFFFFFFFu, 1), 0xFFFFFFFFu);
  assert_int_equal(trax_sext8(0x180), 0xFFFFFF80u);
  assert_int_equal(trax_sext16(0x17FFF), 0x7FFF);
}

static void test_reduced_precision(void **state) {
  (void)state;
  assert_int_equal(trax_reduce_precision(0x3F812345u, 24), 0x3F812345u);
  assert_int_equal(trax_reduce_precision(0x3F80FFFFu, 12), 0x3F810000u);
  assert_int_equal(trax_reduce_precision(0x3F800800u, 12), 0x3F800000u); /* a tie, to even */
  assert_int_equal(trax_reduce_precision(0x3F801800u, 12), 0x3F802000u);
  assert_int_equal(trax_reduce_precision(0x7F7FFFFFu, 12), INF);
  assert_int_equal(trax_reduce_precision(QNAN, 8), QNAN);
  assert_int_equal(trax_reduce_precision(NEG(INF), 8), NEG(INF));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_rsqrt_is_correctly_rounded), cmocka_unit_test(test_rsqrt_special_cases),
      cmocka_unit_test(test_nan_is_canonical),           cmocka_unit_test(test_signed_zeros),
      cmocka_unit_test(test_subnormals_are_kept),        cmocka_unit_test(test_conversions_saturate),
      cmocka_unit_test(test_integers),                   cmocka_unit_test(test_reduced_precision),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
