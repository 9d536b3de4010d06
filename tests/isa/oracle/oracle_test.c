/* The oracle against two opinions apart from it: cases worked by hand from the definitions, and MPFR, which rounds by
   itself and whose subnormal numbers come from mpfr_subnormalize. */
#include "oracle.h"
#include "pairs.h"

#include <mpfr.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum {
  LEAST = 1,
  GREATEST_SUBNORMAL = 0x007FFFFF,
  LEAST_NORMAL = 0x00800000,
  HALF = 0x3F000000,
  ONE = 0x3F800000,
  THREE_HALVES = 0x3FC00000,
  TWO = 0x40000000,
  THREE = 0x40400000,
  FOUR = 0x40800000,
  GREATEST = 0x7F7FFFFF,
  INF = 0x7F800000,
  SNAN = 0x7F800001,
  QNAN = 0x7FC00000
};
#define NEG(a) ((uint32_t)(a) | 0x80000000u)

#define IS(expected, call) assert_int_equal(call, expected)

static void test_sum(void **state) {
  (void)state;
  IS(THREE, oracle_fadd(ONE, TWO));
  IS(NEG(ONE), oracle_fsub(ONE, TWO));
  /* 1 + 2^-24 is a tie, to the even 1; (1 + 2^-23) + 2^-24 is one to the even 1 + 2^-22; 2^-24 and a bit rounds up. */
  IS(ONE, oracle_fadd(ONE, 0x33800000));
  IS(ONE + 2, oracle_fadd(ONE + 1, 0x33800000));
  IS(ONE + 1, oracle_fadd(ONE, 0x33800001));
  /* Below a power of two places are half as wide: 1 - 2^-25 is a tie between 1 - 2^-24 and 1, 1 - 3 * 2^-26 is not. */
  IS(ONE, oracle_fsub(ONE, 0x33000000));
  IS(ONE - 1, oracle_fsub(ONE, 0x33400000));
  IS(LEAST_NORMAL, oracle_fadd(GREATEST_SUBNORMAL, LEAST));
  IS(GREATEST_SUBNORMAL, oracle_fsub(LEAST_NORMAL, LEAST));
  IS(ONE, oracle_fadd(ONE, LEAST));
  IS(ONE, oracle_fsub(ONE, LEAST));
  /* Overflow begins at 2^128 - 2^103, half a place above the greatest. */
  IS(INF, oracle_fadd(GREATEST, 0x73000000));
  IS(GREATEST, oracle_fadd(GREATEST, 0x72FFFFFF));
  IS(NEG(INF), oracle_fsub(NEG(GREATEST), GREATEST));
}

static void test_sums_of_zeros_and_infinities(void **state) {
  (void)state;
  IS(0, oracle_fsub(ONE, ONE));
  IS(0, oracle_fadd(NEG(THREE), THREE));
  IS(0, oracle_fadd(0, NEG(0)));
  IS(NEG(0), oracle_fadd(NEG(0), NEG(0)));
  IS(NEG(0), oracle_fsub(NEG(0), 0));
  IS(0, oracle_fsub(NEG(0), NEG(0)));
  IS(NEG(LEAST), oracle_fadd(0, NEG(LEAST)));
  IS(INF, oracle_fadd(INF, NEG(GREATEST)));
  IS(NEG(INF), oracle_fsub(ONE, INF));
  IS(QNAN, oracle_fsub(INF, INF));
  IS(INF, oracle_fadd(INF, INF));
}

static void test_product(void **state) {
  (void)state;
  IS(0x40C00000, oracle_fmul(TWO, THREE));
  /* (1 + 2^-12)(1 + 2^-12) = 1 + 2^-11 + 2^-24: a tie, to even. (1 + 2^-23)^2 = 1 + 2^-22 + 2^-46. */
  IS(0x3F801000, oracle_fmul(0x3F800800, 0x3F800800));
  IS(ONE + 2, oracle_fmul(ONE + 1, ONE + 1));
  IS(0x00400000, oracle_fmul(LEAST_NORMAL, HALF));
  IS(0, oracle_fmul(LEAST, HALF));         /* half the least: a tie, to even */
  IS(LEAST, oracle_fmul(LEAST, HALF + 1)); /* above it */
  IS(2, oracle_fmul(3, HALF));             /* 1.5 of the least: a tie, to even */
  IS(NEG(0), oracle_fmul(NEG(LEAST), LEAST));
  IS(LEAST_NORMAL, oracle_fmul(ONE - 1, LEAST_NORMAL)); /* 2^-126 - 2^-150: a tie, to the normal number */
  IS(INF, oracle_fmul(GREATEST, ONE + 1));
  IS(INF, oracle_fmul(0x5F800000, 0x5F800000)); /* 2^64 * 2^64 */
  IS(QNAN, oracle_fmul(0, NEG(INF)));
  IS(NEG(INF), oracle_fmul(NEG(LEAST), INF));
  IS(NEG(0), oracle_fmul(NEG(0), GREATEST));
}

static void test_quotient(void **state) {
  (void)state;
  IS(THREE_HALVES, oracle_fdiv(THREE, TWO));
  IS(0x3EAAAAAB, oracle_fdiv(ONE, THREE));          /* 1/3 = 0.0101...: 24 digits 1010...1010 and 1010... more */
  IS(LEAST, oracle_fdiv(LEAST_NORMAL, 0x4B000000)); /* 2^-126 / 2^23 */
  IS(0, oracle_fdiv(LEAST, TWO));
  IS(2, oracle_fdiv(3, TWO));
  IS(INF, oracle_fdiv(GREATEST, HALF));
  IS(INF, oracle_fdiv(ONE, LEAST));
  IS(0x00400000, oracle_fdiv(ONE, 0x7F000000)); /* 2^-127 = 2^22 * 2^-149 */
  IS(NEG(INF), oracle_fdiv(ONE, NEG(0)));
  IS(INF, oracle_fdiv(INF, 0));
  IS(NEG(0), oracle_fdiv(NEG(ONE), INF));
  IS(NEG(0), oracle_fdiv(0, NEG(ONE)));
  IS(QNAN, oracle_fdiv(0, NEG(0)));
  IS(QNAN, oracle_fdiv(INF, NEG(INF)));
}

static void test_nan_is_canonical(void **state) {
  (void)state;
  static const uint32_t nans[] = {QNAN, SNAN, 0x7FFFFFFF, 0xFFC00001, 0xFF800001, 0xFFFFFFFF};
  static const uint32_t numbers[] = {0, NEG(0), LEAST, ONE, NEG(GREATEST), INF, NEG(INF)};
  for (size_t n = 0; n < COUNT(nans); n++) {
    uint32_t a = nans[n];
    for (size_t m = 0; m < COUNT(numbers); m++) {
      uint32_t b = numbers[m];
      IS(QNAN, oracle_fadd(a, b));
      IS(QNAN, oracle_fadd(b, a));
      IS(QNAN, oracle_fsub(a, b));
      IS(QNAN, oracle_fsub(b, a));
      IS(QNAN, oracle_fmul(a, b));
      IS(QNAN, oracle_fmul(b, a));
      IS(QNAN, oracle_fdiv(a, b));
      IS(QNAN, oracle_fdiv(b, a));
      IS(b, oracle_fmin(a, b));
      IS(b, oracle_fmin(b, a));
      IS(b, oracle_fmax(a, b));
      IS(b, oracle_fmax(b, a));
      IS(0, oracle_feq(a, b) | oracle_feq(b, a) | oracle_flt(a, b) | oracle_flt(b, a) | oracle_fle(a, b) |
                oracle_fle(b, a));
    }
    IS(QNAN, oracle_fmin(a, nans[(n + 1) % COUNT(nans)]));
    IS(QNAN, oracle_fmax(a, nans[(n + 1) % COUNT(nans)]));
    IS(0, oracle_feq(a, a) | oracle_fle(a, a));
    IS(QNAN, oracle_frsqrt(a));
    IS(QNAN, oracle_fsqrt_rounded(a));
    IS(0, oracle_fcvt_w_s(a) | oracle_fcvt_wu_s(a));
    IS(a, oracle_reduce(a, 8));
  }
}

/* Every pair of an ascending list: its order is the answer. */
static void test_order(void **state) {
  (void)state;
  static const uint32_t ascending[] = {NEG(INF),   NEG(GREATEST), NEG(TWO), NEG(ONE + 1), NEG(ONE), NEG(LEAST_NORMAL),
                                       NEG(LEAST), NEG(0),        0,        LEAST,        2,        LEAST_NORMAL,
                                       HALF,       ONE,           ONE + 1,  THREE,        GREATEST, INF};
  for (size_t i = 0; i < COUNT(ascending); i++)
    for (size_t k = 0; k < COUNT(ascending); k++) {
      uint32_t a = ascending[i], b = ascending[k];
      int zeros = (a | b) == NEG(0) || (a | b) == 0;
      IS(i <= k ? a : b, oracle_fmin(a, b));
      IS(i <= k ? b : a, oracle_fmax(a, b));
      IS(i == k || zeros, oracle_feq(a, b));
      IS(i < k && !zeros, oracle_flt(a, b));
      IS(i <= k || zeros, oracle_fle(a, b));
    }
}

static void test_roots(void **state) {
  (void)state;
  IS(INF, oracle_frsqrt(0));
  IS(NEG(INF), oracle_frsqrt(NEG(0)));
  IS(0, oracle_frsqrt(INF));
  IS(QNAN, oracle_frsqrt(NEG(INF)));
  IS(QNAN, oracle_frsqrt(NEG(LEAST)));
  IS(HALF, oracle_frsqrt(FOUR));
  IS(0x3F3504F3, oracle_frsqrt(TWO));   /* 0x0.B504F333F... */
  IS(0x64B504F3, oracle_frsqrt(LEAST)); /* 2^-149: 2^74.5 = 0x1.6A09E667F3p74 */
  IS(0x64800000, oracle_frsqrt(2));
  IS(0x1F800000, oracle_frsqrt(GREATEST)); /* 2^-64 (1 + 2^-25 + ...) */
  IS(TWO, oracle_fsqrt_rounded(FOUR));
  IS(0x3FB504F3, oracle_fsqrt_rounded(TWO));   /* 0x1.6A09E667F3 */
  IS(0x1A3504F3, oracle_fsqrt_rounded(LEAST)); /* 2^-74.5 = 0x1.6A09E667F3p-75 */
  IS(0x1A800000, oracle_fsqrt_rounded(2));
  IS(0x5F7FFFFF, oracle_fsqrt_rounded(GREATEST)); /* 2^64 (1 - 2^-25 - ...): below the tie */
  IS(0, oracle_fsqrt_rounded(0));
  IS(NEG(0), oracle_fsqrt_rounded(NEG(0)));
  IS(INF, oracle_fsqrt_rounded(INF));
  IS(QNAN, oracle_fsqrt_rounded(NEG(ONE)));
  IS(QNAN, oracle_fsqrt_rounded(NEG(INF)));
}

static void test_conversions(void **state) {
  (void)state;
  IS(0x7FFFFFFF, oracle_fcvt_w_s(0x4F000000)); /* 2^31 */
  IS(0x7FFFFF80, oracle_fcvt_w_s(0x4EFFFFFF));
  IS(0x80000000, oracle_fcvt_w_s(0xCF000000)); /* -2^31 */
  IS(0x80000000, oracle_fcvt_w_s(0xCF000001));
  IS(0x7FFFFFFF, oracle_fcvt_w_s(INF));
  IS(0x80000000, oracle_fcvt_w_s(NEG(INF)));
  IS(0xFFFFFFFF, oracle_fcvt_w_s(0xBFFFFFFF)); /* -1.99: towards zero */
  IS(0, oracle_fcvt_w_s(NEG(ONE - 1)));
  IS(0, oracle_fcvt_w_s(LEAST) | oracle_fcvt_w_s(NEG(0)) | oracle_fcvt_w_s(HALF));
  IS(0x00800001, oracle_fcvt_w_s(0x4B000001));
  IS(0xFFFFFFFF, oracle_fcvt_wu_s(0x4F800000)); /* 2^32 */
  IS(0xFFFFFF00, oracle_fcvt_wu_s(0x4F7FFFFF));
  IS(0x80000000, oracle_fcvt_wu_s(0x4F000000));
  IS(0xFFFFFFFF, oracle_fcvt_wu_s(INF));
  IS(0, oracle_fcvt_wu_s(NEG(ONE)) | oracle_fcvt_wu_s(NEG(INF)) | oracle_fcvt_wu_s(NEG(LEAST)));
  IS(0, oracle_fcvt_s_w(0));
  IS(NEG(ONE), oracle_fcvt_s_w(0xFFFFFFFF));
  IS(0xCF000000, oracle_fcvt_s_w(0x80000000));
  IS(0x4F000000, oracle_fcvt_s_w(0x7FFFFFFF));
  IS(0x4B800000, oracle_fcvt_s_w(0x01000001)); /* 2^24 + 1: a tie, to even */
  IS(0x4B800002, oracle_fcvt_s_w(0x01000003)); /* 2^24 + 3: the other */
  IS(0x4F800000, oracle_fcvt_s_wu(0xFFFFFFFF));
  IS(0x4F7FFFFF, oracle_fcvt_s_wu(0xFFFFFF7F)); /* just below the tie */
  IS(0x4F800000, oracle_fcvt_s_wu(0xFFFFFF80)); /* the tie */
  IS(0, oracle_fcvt_s_wu(0));
}

static void test_reduced_precision(void **state) {
  (void)state;
  IS(0x3F812345, oracle_reduce(0x3F812345, 24));
  IS(0x3F812344, oracle_reduce(0x3F812345, 23)); /* ...0101 between ...0100 and ...0110, a tie: 0100 is the even one */
  IS(0x3F812348, oracle_reduce(0x3F812347, 23));
  IS(0x3F810000, oracle_reduce(0x3F80FFFF, 12));
  IS(0x3F800000, oracle_reduce(0x3F800800, 12));
  IS(0x3F802000, oracle_reduce(0x3F801800, 12));
  IS(ONE, oracle_reduce(THREE_HALVES - 1, 1));
  IS(TWO, oracle_reduce(THREE_HALVES, 1)); /* with one digit neither is even: the greater */
  IS(FOUR, oracle_reduce(THREE, 1));
  IS(INF, oracle_reduce(GREATEST, 12));
  IS(NEG(INF), oracle_reduce(NEG(0x7F400000), 1));
  IS(0x7F000000, oracle_reduce(0x7F3FFFFF, 1));
  IS(GREATEST_SUBNORMAL, oracle_reduce(GREATEST_SUBNORMAL, 1));
  IS(LEAST_NORMAL, oracle_reduce(LEAST_NORMAL + 1, 23));
  IS(NEG(0), oracle_reduce(NEG(0), 1));
  IS(NEG(INF), oracle_reduce(NEG(INF), 8));
}

/* Operands and result of MPFR, with the exponents and the 24 bits of binary32. */
static mpfr_t x, y, z;

static void set(mpfr_t to, uint32_t bits) {
  uint32_t biased = bits >> 23 & 255, fraction = bits & 0x7FFFFF;
  if (biased == 255 && fraction)
    mpfr_set_nan(to);
  else if (biased == 255)
    mpfr_set_inf(to, 1);
  else
    mpfr_set_ui_2exp(to, biased ? fraction | 0x800000 : fraction, biased ? (int)biased - 150 : -149, MPFR_RNDN);
  mpfr_setsign(to, to, (int)(bits >> 31), MPFR_RNDN);
}

static uint32_t get(mpfr_t from) {
  uint32_t sign = mpfr_signbit(from) ? NEG(0) : 0;
  if (mpfr_nan_p(from))
    return QNAN;
  if (mpfr_inf_p(from))
    return sign | INF;
  if (mpfr_zero_p(from))
    return sign;
  mpz_t significand;
  mpz_init(significand);
  long exponent = mpfr_get_z_2exp(significand, from);
  uint32_t magnitude = (uint32_t)mpz_get_ui(significand) & 0xFFFFFF; /* of the absolute value, 24 bits */
  mpz_clear(significand);
  if (exponent >= -149)
    return sign | (((uint32_t)(exponent + 149) << 23) + magnitude);
  return sign | magnitude >> (-149 - exponent);
}

static uint32_t rounded(int ternary) {
  return get((mpfr_subnormalize(z, ternary, MPFR_RNDN), z));
}

static uint32_t saturated(double least, double greatest) {
  if (mpfr_nan_p(x))
    return 0;
  mpfr_prec_t wide = 64;
  mpfr_t bounded;
  mpfr_init2(bounded, wide);
  mpfr_rint_trunc(bounded, x, MPFR_RNDZ);
  if (mpfr_cmp_d(bounded, least) < 0)
    mpfr_set_d(bounded, least, MPFR_RNDN);
  if (mpfr_cmp_d(bounded, greatest) > 0)
    mpfr_set_d(bounded, greatest, MPFR_RNDN);
  uint32_t n = (uint32_t)mpfr_get_sj(bounded, MPFR_RNDN);
  mpfr_clear(bounded);
  return n;
}

static uint32_t reduced(uint32_t bits, unsigned precision) {
  if (mpfr_nan_p(x))
    return bits;
  if ((bits & INF) == 0)
    return get(x);
  mpfr_t narrow;
  mpfr_init2(narrow, precision);
  mpfr_set(narrow, x, MPFR_RNDN);
  mpfr_set(z, narrow, MPFR_RNDN);
  mpfr_clear(narrow);
  return get(z);
}

#define SAME(theirs, ours)                                                                                             \
  {                                                                                                                    \
    uint32_t expected = theirs, result = ours;                                                                         \
    if (expected != result) {                                                                                          \
      if (wrong++ < 20)                                                                                                \
        printf("%s of %08x %08x: MPFR %08x, oracle %08x\n", #ours, pair.a, pair.b, expected, result);                  \
    }                                                                                                                  \
  }

static void test_against_mpfr(void **state) {
  (void)state;
  mpfr_inits2(24, x, y, z, (mpfr_ptr)0);
  mpfr_set_emin(-148);
  mpfr_set_emax(128);
  unsigned wrong = 0;
  for (uint64_t number = 0; number < 600000; number++) {
    struct pair pair = pair_of(number);
    set(x, pair.a);
    set(y, pair.b);
    SAME(rounded(mpfr_add(z, x, y, MPFR_RNDN)), oracle_fadd(pair.a, pair.b))
    SAME(rounded(mpfr_sub(z, x, y, MPFR_RNDN)), oracle_fsub(pair.a, pair.b))
    SAME(rounded(mpfr_mul(z, x, y, MPFR_RNDN)), oracle_fmul(pair.a, pair.b))
    SAME(rounded(mpfr_div(z, x, y, MPFR_RNDN)), oracle_fdiv(pair.a, pair.b))
    SAME(get((mpfr_min(z, x, y, MPFR_RNDN), z)), oracle_fmin(pair.a, pair.b))
    SAME(get((mpfr_max(z, x, y, MPFR_RNDN), z)), oracle_fmax(pair.a, pair.b))
    SAME(mpfr_equal_p(x, y) != 0, oracle_feq(pair.a, pair.b))
    SAME(mpfr_less_p(x, y) != 0, oracle_flt(pair.a, pair.b))
    SAME(mpfr_lessequal_p(x, y) != 0, oracle_fle(pair.a, pair.b))
    /* MPFR's reciprocal root of -0 is +infinity, not as the standard has it. */
    SAME(pair.a == NEG(0) ? NEG(INF) : rounded(mpfr_rec_sqrt(z, x, MPFR_RNDN)), oracle_frsqrt(pair.a))
    SAME(rounded(mpfr_sqrt(z, x, MPFR_RNDN)), oracle_fsqrt_rounded(pair.a))
    SAME(saturated(-0x1p31, 0x1p31 - 1), oracle_fcvt_w_s(pair.a))
    SAME(saturated(0, 0x1p32 - 1), oracle_fcvt_wu_s(pair.a))
    SAME(rounded(mpfr_set_si(z, (int32_t)pair.a, MPFR_RNDN)), oracle_fcvt_s_w(pair.a))
    SAME(rounded(mpfr_set_ui(z, pair.a, MPFR_RNDN)), oracle_fcvt_s_wu(pair.a))
    unsigned bits = (unsigned)(number % 24) + 1;
    SAME(reduced(pair.a, bits), oracle_reduce(pair.a, bits))
  }
  mpfr_clears(x, y, z, (mpfr_ptr)0);
  mpfr_free_cache();
  assert_int_equal(wrong, 0);
}

/* --by-hand leaves out the comparison with MPFR. */
int main(int argc, char **argv) {
  if (argc == 2 && strcmp(argv[1], "--by-hand") == 0)
    cmocka_set_skip_filter("test_against_mpfr");
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_sum),
      cmocka_unit_test(test_sums_of_zeros_and_infinities),
      cmocka_unit_test(test_product),
      cmocka_unit_test(test_quotient),
      cmocka_unit_test(test_nan_is_canonical),
      cmocka_unit_test(test_order),
      cmocka_unit_test(test_roots),
      cmocka_unit_test(test_conversions),
      cmocka_unit_test(test_reduced_precision),
      cmocka_unit_test(test_against_mpfr),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
