/* 64-bit shifts, product and comparison, from words: written so that none of them can be compiled into a call of
 * itself. */
#include "builtins.h"

uint64_t __ashldi3(uint64_t a, int n) {
  uint32_t high = high_word(a), low = low_word(a);
  if (n >= 32)
    return words(low << (n - 32), 0);
  if (n == 0)
    return a;
  return words(high << n | low >> (32 - n), low << n);
}

uint64_t __lshrdi3(uint64_t a, int n) {
  uint32_t high = high_word(a), low = low_word(a);
  if (n >= 32)
    return words(0, high >> (n - 32));
  if (n == 0)
    return a;
  return words(high >> n, low >> n | high << (32 - n));
}

int64_t __ashrdi3(int64_t a, int n) {
  int32_t high = (int32_t)high_word((uint64_t)a);
  uint32_t low = low_word((uint64_t)a);
  if (n >= 32)
    return (int64_t)words((uint32_t)(high >> 31), (uint32_t)(high >> (n - 32)));
  if (n == 0)
    return a;
  return (int64_t)words((uint32_t)(high >> n), low >> n | (uint32_t)high << (32 - n));
}

uint64_t __muldi3(uint64_t a, uint64_t b) {
  uint32_t high = mul_high(low_word(a), low_word(b)) + low_word(a) * high_word(b) + high_word(a) * low_word(b);
  return words(high, low_word(a) * low_word(b));
}

/* Multiplies magnitudes: at most one of two cross products is not 0 unless the product overflows. */
int64_t __mulodi4(int64_t a, int64_t b, int *overflow) {
  uint64_t sa = (uint64_t)(a >> 63), sb = (uint64_t)(b >> 63), sign = sa ^ sb;
  uint64_t m = ((uint64_t)a ^ sa) - sa, n = ((uint64_t)b ^ sb) - sb;
  uint64_t low = mul_wide(low_word(m), low_word(n));
  uint64_t cross = mul_wide(low_word(m), high_word(n)) + mul_wide(high_word(m), low_word(n)) + high_word(low);
  uint64_t magnitude = words(low_word(cross), low_word(low));
  *overflow = (high_word(m) && high_word(n)) || high_word(cross) || magnitude > INT64_MAX - sign;
  return (int64_t)((uint64_t)a * (uint64_t)b);
}

int __cmpdi2(int64_t a, int64_t b) {
  return a < b ? 0 : a > b ? 2 : 1;
}

int __ucmpdi2(uint64_t a, uint64_t b) {
  return a < b ? 0 : a > b ? 2 : 1;
}

uint64_t __negdi2(uint64_t a) {
  return 0 - a;
}
