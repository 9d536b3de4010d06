/* The integer square root that hypotf, asinf, acosf, asinhf, acoshf and sqrt build on. */
#include "fixed.h"

/* 1 / sqrt(x) to 20 bits for every precision of the machine's instruction: Newton's iteration changes nothing at 21
 * bits and more. */
static float precise_reciprocal_sqrt(float x) {
  float r = reciprocal_sqrt(x), error;
  while (error = 1 - x * r * r, error > 0x1p-20f || error < -0x1p-20f)
    r += 0.5f * r * error;
  return r;
}

uint32_t trax_sqrt64(uint64_t n) {
  float high = (float)high_word(n);
  float r = precise_reciprocal_sqrt(high); /* 2^16 / sqrt(n) */
  float estimate = high * r * 0x1p16f;
  uint32_t s = estimate < 0x1p32f ? (uint32_t)estimate : UINT32_MAX;
  /* One step of Newton's iteration leaves at most a few units, which the loops take away. */
  int64_t rest = (int64_t)(n - mul_wide(s, s));
  int32_t step = (int32_t)((float)(int32_t)(rest >> 16) * r * 0x1p-1f);
  s = step > 0 && s + (uint32_t)step < s ? UINT32_MAX : s + (uint32_t)step;
  rest = (int64_t)(n - mul_wide(s, s));
  while (rest < 0)
    rest += 2 * (int64_t)--s + 1;
  while (rest > 2 * (int64_t)s)
    rest -= 2 * (int64_t)s++ + 1;
  return s;
}
