/* The integer square root that hypotf, asinf, acosf and sqrt build on. */
#include "fixed.h"

uint32_t trax_sqrt64(uint64_t n) {
  float high = (float)high_word(n);
  float r = reciprocal_sqrt(high); /* 2^16 / sqrt(n) */
  float estimate = high * r * 0x1p16f;
  uint32_t s = estimate < 0x1p32f ? (uint32_t)estimate : UINT32_MAX;
  /* One step of Newton's iteration leaves at most a few units; the loops end it whatever the estimate's precision was.
   */
  int64_t rest = (int64_t)(n - mul_wide(s, s));
  int32_t step = (int32_t)((float)(int32_t)(rest >> 12) * r * 0x1p-5f);
  s = step > 0 && s + (uint32_t)step < s ? UINT32_MAX : s + (uint32_t)step;
  rest = (int64_t)(n - mul_wide(s, s));
  while (rest < 0)
    rest += 2 * (int64_t)--s + 1;
  while (rest > 2 * (int64_t)s)
    rest -= 2 * (int64_t)s++ + 1;
  return s;
}
