// RUN: %run_c %s %t
// Counting and swapping bits, and overflow checks.
#include <stdio.h>

static volatile unsigned values[] = {1, 2, 0x80000000, 0xFFFFFFFF, 0x00F0, 0x12345678};

int main(void) {
  for (int i = 0; i < 6; i++) {
    unsigned x = values[i];
    unsigned long long y = (unsigned long long)x << 20 | 5;
    printf("%d %d %d %d %d %x\n", __builtin_clz(x), __builtin_ctz(x), __builtin_popcount(x), __builtin_parity(x),
           __builtin_ffs((int)x), __builtin_bswap32(x));
    printf("%d %d %d %llx %x\n", __builtin_clzll(y), __builtin_ctzll(y), __builtin_popcountll(y),
           (unsigned long long)__builtin_bswap64(y), __builtin_bswap16((unsigned short)x));
    int r;
    unsigned u;
    long long l;
    printf("%d%d%d", __builtin_sadd_overflow((int)x, 5, &r), __builtin_smul_overflow((int)x, 3, &r),
           __builtin_uadd_overflow(x, 7, &u));
    printf("%d%d\n", __builtin_usub_overflow(x, 100u, &u),
           __builtin_saddll_overflow((long long)(y << 32), (long long)(y << 31), &l));
  }
  return 0;
}
