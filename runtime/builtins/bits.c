/* Counting and swapping bits. */
#include "builtins.h"

int __clzsi2(uint32_t a) {
  return leading_zeros(a);
}

int __clzdi2(uint64_t a) {
  return leading_zeros64(a);
}

int __ctzsi2(uint32_t a) {
  return 31 - leading_zeros(a & (0 - a));
}

int __ctzdi2(uint64_t a) {
  return low_word(a) ? __ctzsi2(low_word(a)) : 32 + __ctzsi2(high_word(a));
}

int __ffssi2(uint32_t a) {
  return a ? 1 + __ctzsi2(a) : 0;
}

int __ffsdi2(uint64_t a) {
  return a ? 1 + __ctzdi2(a) : 0;
}

/* Sums of ever wider fields; the multiplication adds up the four bytes. */
int __popcountsi2(uint32_t a) {
  a -= a >> 1 & 0x55555555;
  a = (a & 0x33333333) + (a >> 2 & 0x33333333);
  a = (a + (a >> 4)) & 0x0F0F0F0F;
  return (int)((a * 0x01010101) >> 24);
}

int __popcountdi2(uint64_t a) {
  return __popcountsi2(low_word(a)) + __popcountsi2(high_word(a));
}

int __paritysi2(uint32_t a) {
  a ^= a >> 16;
  a ^= a >> 8;
  a ^= a >> 4;
  return 0x6996 >> (a & 15) & 1; /* bit i is the parity of i */
}

int __paritydi2(uint64_t a) {
  return __paritysi2(low_word(a) ^ high_word(a));
}

uint32_t __bswapsi2(uint32_t a) {
  return a << 24 | (a & 0xFF00) << 8 | (a >> 8 & 0xFF00) | a >> 24;
}

uint64_t __bswapdi2(uint64_t a) {
  return words(__bswapsi2(low_word(a)), __bswapsi2(high_word(a)));
}
