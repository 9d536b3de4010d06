/* The errors of one chunk. Ziv's idea (A. Ziv, "Fast evaluation of elementary mathematical functions with correctly
   rounded last bit", ACM TOMS 17, 1991): the host's binary64 result settles the rounding and the error wherever its own
   error cannot change the answer, and MPFR is asked for the rest. */
#include <float.h>
#include <math.h>

#include "../operands.h"
#include "accuracy.h"

/* One chunk of this many has a result checked by MPFR in any case, so that HOST_ERROR is measured, too. */
enum { AUDIT = 16 };

static void worst_is(struct measured *m, double error, const struct chunk *chunk, size_t i) {
  m->worst = error;
  m->worst_number = chunk->first + i;
  for (int n = 0; n < 3; n++)
    m->worst_operand[n] = chunk->operand[n][i];
}

static void ask_mpfr(const struct function *function, const struct chunk *chunk, size_t i, struct measured *m) {
  struct verdict verdict = judge(function, chunk, i);
  m->wrong += verdict.wrong;
  m->host = fmax(m->host, verdict.host);
  if (verdict.special) {
    if (m->special++ == 0) {
      m->special_number = chunk->first + i;
      for (int n = 0; n < 3; n++)
        m->special_operand[n] = chunk->operand[n][i];
    }
    return;
  }
  m->beyond_one += verdict.error > 1;
  if (verdict.error > m->worst)
    worst_is(m, verdict.error, chunk, i);
}

/* Whether both agree on a result that is no number, or none that binary32 has, or zero. */
static bool agree_on_special(float got, double want) {
  if (want != want)
    return got != got;
  if (fabs(want) >= 0x1p128)
    return got == copysign(INFINITY, want);
  return want == 0 && got == 0 && !signbit(got) == !signbit(want);
}

struct settled {
  double error[CHUNK];       /* 0 where it is not settled */
  uint64_t unsettled[CHUNK]; /* 1 or 0 */
  uint64_t any, wrong, beyond_one, worst_bits;
};

/* No branches, and integers as wide as the floats: so compilers do several at once. Errors are positive and have the
   order of their representations. */
WIDEST static void settle(const struct chunk *chunk, struct settled *settled) {
  uint64_t any = 0, wrong_count = 0, beyond_one = 0, worst = 0;
  for (size_t i = 0; i < CHUNK; i++) {
    double want = chunk->want[i], magnitude = fabs(want), got = (double)chunk->got[i];
    double low = (double)(float)(want - magnitude * HOST_ERROR), high = (double)(float)(want + magnitude * HOST_ERROR);
    uint64_t exponent = bits_of(magnitude) >> 52; /* 1023 + that of the result */
    exponent = exponent < 1023 - 126 ? 1023 - 126 : exponent;
    double error = fabs(got - want) * double_of((2 * 1023 + 23 - exponent) << 52);
    uint64_t wrong = bits_of(got) != bits_of(high);
    uint64_t unsettled = !(magnitude > 0) | !(magnitude <= (double)FLT_MAX) | (low != high) |
                         !(fabs(got) <= (double)FLT_MAX) | ((got == 0) & wrong);
    uint64_t error_bits = bits_of(error) & (unsettled - 1);
    settled->error[i] = double_of(error_bits);
    settled->unsettled[i] = unsettled;
    any |= unsettled;
    wrong_count += wrong & ~unsettled;
    beyond_one += error_bits > 0x3FF0000000000000u;
    worst = error_bits > worst ? error_bits : worst;
  }
  settled->any = any;
  settled->wrong = wrong_count;
  settled->beyond_one = beyond_one;
  settled->worst_bits = worst;
}

/* Whether result i + 1 lies to the same side of result i as the host says, or beside it, or there is no order. */
static inline bool order_is_clear(const struct chunk *chunk, size_t i) {
  double step = (double)chunk->got[i + 1] - (double)chunk->got[i], want = chunk->want[i + 1] - chunk->want[i];
  double unsure = HOST_ERROR * (fabs(chunk->want[i]) + fabs(chunk->want[i + 1]));
  return ((step > 0) & (want > unsure)) | ((step < 0) & (want < -unsure)) | (step == 0) | (step != step) |
         (want != want);
}

WIDEST static bool all_in_order(const struct chunk *chunk) {
  uint64_t all = 1;
  for (size_t i = 0; i < CHUNK; i++)
    all &= order_is_clear(chunk, i);
  return all;
}

/* Neighbours' results in another order than the true ones. */
static uint64_t disorder(const struct function *function, const struct chunk *chunk) {
  uint64_t count = 0;
  if (all_in_order(chunk))
    return 0;
  for (size_t i = 0; i < CHUNK; i++) {
    if (order_is_clear(chunk, i) || chunk->operand[0][i + 1] != chunk->operand[0][i] + 1)
      continue;
    double want = chunk->want[i + 1] - chunk->want[i];
    if (fabs(want) > HOST_ERROR * (fabs(chunk->want[i]) + fabs(chunk->want[i + 1]))) {
      count++;
    } else {
      int order = true_order(function, chunk, i);
      count += chunk->got[i + 1] > chunk->got[i] ? order <= 0 : order >= 0;
    }
  }
  return count;
}

void measure_chunk(const struct function *function, struct chunk *chunk, struct measured *m) {
  struct settled settled;
  function->ours(chunk);
  function->host(chunk);
  settle(chunk, &settled);
  m->count += CHUNK;
  m->wrong += settled.wrong;
  m->beyond_one += settled.beyond_one;
  double worst = double_of(settled.worst_bits);
  if (worst > m->worst) {
    size_t i = 0;
    while (settled.error[i] != worst)
      i++;
    worst_is(m, worst, chunk, i);
  }
  for (size_t i = 0; settled.any && i < CHUNK; i++)
    if (settled.unsettled[i] && !agree_on_special(chunk->got[i], chunk->want[i]))
      ask_mpfr(function, chunk, i, m);
  if (function->operands == 1)
    m->disorder += disorder(function, chunk);
  if (chunk->first / CHUNK % AUDIT == 0) {
    uint64_t state = chunk->first;
    m->host = fmax(m->host, judge(function, chunk, random64(&state) % CHUNK).host);
  }
}

void measure_merge(struct measured *into, const struct measured *from) {
  into->count += from->count;
  into->wrong += from->wrong;
  into->beyond_one += from->beyond_one;
  into->disorder += from->disorder;
  into->host = fmax(into->host, from->host);
  if (from->special && (!into->special || from->special_number < into->special_number)) {
    into->special_number = from->special_number;
    for (int n = 0; n < 3; n++)
      into->special_operand[n] = from->special_operand[n];
  }
  into->special += from->special;
  if (from->worst > into->worst || (from->worst == into->worst && from->worst_number < into->worst_number)) {
    into->worst = from->worst;
    into->worst_number = from->worst_number;
    for (int n = 0; n < 3; n++)
      into->worst_operand[n] = from->worst_operand[n];
  }
}
