/* MPFR's results, and what they say of the runtime's. */
#include <math.h>

#include "../operands.h"
#include "adapted.h"
#include "reference.h"

/* Sums and products of floats that cancel need not be exact in so many bits, but their ratio to a float's last place
 * is. */
#define PRECISION 320

static void true_rsqrt(mpfr_t result, const mpfr_t x, mpfr_rnd_t rounding) {
  mpfr_rec_sqrt(result, x, rounding);
  if (mpfr_zero_p(x)) /* IEEE 754-2019, 9.2.1, unlike MPFR */
    mpfr_setsign(result, result, mpfr_signbit(x), rounding);
}
static void true_lgamma(mpfr_t result, const mpfr_t x, mpfr_rnd_t rounding) {
  int sign;
  mpfr_lgamma(result, &sign, x, rounding);
}
static void true_logb(mpfr_t result, const mpfr_t x, mpfr_rnd_t rounding) {
  if (mpfr_zero_p(x))
    mpfr_set_inf(result, -1);
  else if (mpfr_inf_p(x))
    mpfr_set_inf(result, 1);
  else if (mpfr_nan_p(x))
    mpfr_set_nan(result);
  else
    mpfr_set_si(result, mpfr_get_exp(x) - 1, rounding);
}
/* Special values as host_exact.c has them. */
static void true_ilogb(mpfr_t result, const mpfr_t x, mpfr_rnd_t rounding) {
  true_logb(result, x, rounding);
  if (!mpfr_number_p(result))
    mpfr_set_d(result, mpfr_inf_p(x) ? 0x1p31 : -0x1p31, rounding);
}
/* An integer of so many bits with a sign, else NaN; integers have no -0. */
static void as_integer(mpfr_t result, int bits) {
  if (mpfr_zero_p(result))
    mpfr_set_zero(result, 1);
  else if (!mpfr_number_p(result) || mpfr_cmp_d(result, ldexp(1, bits - 1)) >= 0 ||
           mpfr_cmp_d(result, -ldexp(1, bits - 1)) < 0)
    mpfr_set_nan(result);
}
static void true_lround(mpfr_t result, const mpfr_t x, mpfr_rnd_t rounding) {
  mpfr_rint_round(result, x, rounding);
  as_integer(result, 32);
}
static void true_lrint(mpfr_t result, const mpfr_t x, mpfr_rnd_t rounding) {
  mpfr_rint_roundeven(result, x, rounding);
  as_integer(result, 32);
}
static void true_llround(mpfr_t result, const mpfr_t x, mpfr_rnd_t rounding) {
  mpfr_rint_round(result, x, rounding);
  as_integer(result, 64);
}
static void true_llrint(mpfr_t result, const mpfr_t x, mpfr_rnd_t rounding) {
  mpfr_rint_roundeven(result, x, rounding);
  as_integer(result, 64);
}
static void true_nextafter(mpfr_t result, const mpfr_t x, const mpfr_t y, mpfr_rnd_t rounding) {
  mpfr_set_flt(result, nextafterf(mpfr_get_flt(x, MPFR_RNDN), mpfr_get_flt(y, MPFR_RNDN)), rounding);
}
static void true_ldexp(mpfr_t result, const mpfr_t x, const mpfr_t y, mpfr_rnd_t rounding) {
  mpfr_mul_2si(result, x, exponent_operand(mpfr_get_flt(y, MPFR_RNDN)), rounding);
}

#define EXACT_1(name, host, exact, low, high)                                                                          \
  void exact_##name(mpfr_t result, const mpfr_t *operand) {                                                            \
    exact(result, operand[0], MPFR_RNDN);                                                                              \
  }
#define EXACT_2(name, host, exact, low, high)                                                                          \
  void exact_##name(mpfr_t result, const mpfr_t *operand) {                                                            \
    exact(result, operand[0], operand[1], MPFR_RNDN);                                                                  \
  }
#define EXACT_3(name, host, exact, low, high)                                                                          \
  void exact_##name(mpfr_t result, const mpfr_t *operand) {                                                            \
    exact(result, operand[0], operand[1], operand[2], MPFR_RNDN);                                                      \
  }
EXACT_FUNCTIONS(EXACT_1)
ADAPTED_FUNCTIONS(EXACT_1)
TRANSCENDENTAL_FUNCTIONS(EXACT_1)
EXACT_PAIRS(EXACT_2)
ADAPTED_PAIRS(EXACT_2)
TRANSCENDENTAL_PAIRS(EXACT_2)
TRIPLES(EXACT_3)

/* Each thread's numbers. */
static _Thread_local struct {
  bool ready;
  mpfr_t operand[3], want, other, difference;
} numbers;

static void evaluate(mpfr_t result, const struct function *function, const struct chunk *chunk, size_t i) {
  if (!numbers.ready) {
    for (int n = 0; n < 3; n++)
      mpfr_init2(numbers.operand[n], 24);
    mpfr_inits2(PRECISION, numbers.want, numbers.other, numbers.difference, (mpfr_ptr)NULL);
    numbers.ready = true;
  }
  for (int n = 0; n < function->operands; n++) {
    float x = float_of(chunk->operand[n][i]);
    mpfr_set_flt(numbers.operand[n], x, MPFR_RNDN);
    mpfr_setsign(numbers.operand[n], numbers.operand[n], signbit(x), MPFR_RNDN); /* a NaN's, for copysignf */
  }
  function->exact(result, numbers.operand);
}

void judge_finish(void) {
  if (numbers.ready) {
    for (int n = 0; n < 3; n++)
      mpfr_clear(numbers.operand[n]);
    mpfr_clears(numbers.want, numbers.other, numbers.difference, (mpfr_ptr)NULL);
    numbers.ready = false;
  }
  mpfr_free_cache();
}

/* |x - numbers.want| in units of want's last place, for a format of so many bits with the given least exponent. */
static double distance(double x, int bits, mpfr_exp_t least) {
  mpfr_set_d(numbers.difference, x, MPFR_RNDN);
  mpfr_sub(numbers.difference, numbers.difference, numbers.want, MPFR_RNDN);
  mpfr_exp_t exponent = mpfr_get_exp(numbers.want) - 1;
  mpfr_mul_2si(numbers.difference, numbers.difference, bits - 1 - (exponent < least ? least : exponent), MPFR_RNDN);
  return fabs(mpfr_get_d(numbers.difference, MPFR_RNDN));
}

struct verdict judge(const struct function *function, const struct chunk *chunk, size_t i) {
  struct verdict verdict = {0};
  evaluate(numbers.want, function, chunk, i);
  float got = chunk->got[i], right = mpfr_get_flt(numbers.want, MPFR_RNDN);
  verdict.wrong = right == right ? float_bits_of(got) != float_bits_of(right) : got == got;
  if (!mpfr_regular_p(numbers.want)) {
    verdict.special = verdict.wrong;
    return verdict;
  }
  double host = chunk->want[i];
  if (isfinite(host) && host != 0 && mpfr_get_exp(numbers.want) > -1000 && mpfr_get_exp(numbers.want) < 1000)
    verdict.host = distance(host, 53, -1022);
  if (got != got || !signbit(got) != !mpfr_signbit(numbers.want)) {
    verdict.special = true;
  } else if (mpfr_get_exp(numbers.want) > 128) {
    verdict.special = verdict.wrong;
  } else { /* infinity counts as 2^128, the number that would follow the greatest */
    verdict.error = distance(isinf(got) ? copysign(0x1p128, got) : (double)got, 24, -126);
    verdict.special = isinf(got) && verdict.error > 16;
  }
  return verdict;
}

int true_order(const struct function *function, const struct chunk *chunk, size_t i) {
  evaluate(numbers.want, function, chunk, i);
  evaluate(numbers.other, function, chunk, i + 1);
  return mpfr_cmp(numbers.other, numbers.want);
}
