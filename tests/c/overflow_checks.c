// RUN: %run_c %s %t
// Sums, differences and products with a check for overflow, of operands and results of all widths and both signs.
#include <stdio.h>

typedef unsigned long long u64;
typedef long long s64;

static u64 seen; // of all results so far
static unsigned overflows[8];

static void digest(int overflow, u64 sum, u64 difference, u64 product) {
  overflows[overflow]++;
  seen = (((seen * 31 + sum) * 31 + difference) * 31 + product) * 31 + (u64)overflow;
}

#define CHECK(name, ta, tb, tr)                                                                                        \
  __attribute__((noinline)) static void name(ta a, tb b) {                                                             \
    tr sum, difference, product;                                                                                       \
    int s = __builtin_add_overflow(a, b, &sum), d = __builtin_sub_overflow(a, b, &difference),                         \
        p = __builtin_mul_overflow(a, b, &product);                                                                    \
    digest(s | d << 1 | p << 2, (u64)sum, (u64)difference, (u64)product);                                              \
  }

CHECK(s8_s8_s8, signed char, signed char, signed char)
CHECK(u8_u8_u8, unsigned char, unsigned char, unsigned char)
CHECK(s16_u16_s16, short, unsigned short, short)
CHECK(s32_s32_s32, int, int, int)
CHECK(u32_u32_u32, unsigned, unsigned, unsigned)
CHECK(s32_u32_s32, int, unsigned, int)
CHECK(s32_s32_u32, int, int, unsigned)
CHECK(s32_s64_s32, int, s64, int)
CHECK(u32_u32_s64, unsigned, unsigned, s64)
CHECK(s64_s64_s64, s64, s64, s64)
CHECK(u64_u64_u64, u64, u64, u64)
CHECK(s64_u64_s64, s64, u64, s64)
CHECK(u64_s64_u64, u64, s64, u64)
CHECK(s64_s64_u64, s64, s64, u64)
CHECK(u64_u64_s32, u64, u64, int)

int main(void) {
  static const u64 values[] = {0,          1,          2,           127,        128,
                               255,        0x7FFF,     0x8000,      0xFFFF,     0x7FFFFFFF,
                               0x80000000, 0xFFFFFFFF, 0x100000001, 1ULL << 62, 0x7FFFFFFFFFFFFFFF,
                               1ULL << 63, 0xB504F333, -2ULL,       -1ULL};
  const int n = sizeof values / sizeof values[0];
  for (int i = 0; i < n; i++)
    for (int j = i % 2; j < n; j += 2) {
      u64 a = values[i], b = values[j];
      s8_s8_s8((signed char)a, (signed char)b);
      u8_u8_u8((unsigned char)a, (unsigned char)b);
      s16_u16_s16((short)a, (unsigned short)b);
      s32_s32_s32((int)a, (int)b);
      u32_u32_u32((unsigned)a, (unsigned)b);
      s32_u32_s32((int)a, (unsigned)b);
      s32_s32_u32((int)a, (int)b);
      s32_s64_s32((int)a, (s64)b);
      u32_u32_s64((unsigned)a, (unsigned)b);
      s64_s64_s64((s64)a, (s64)b);
      u64_u64_u64(a, b);
      s64_u64_s64((s64)a, b);
      u64_s64_u64(a, (s64)b);
      s64_s64_u64((s64)a, (s64)b);
      u64_u64_s32(a, b);
      printf("%llx %llx %llx\n", a, b, seen);
    }
  for (int i = 0; i < 8; i++)
    printf("%d%d%d: %u\n", i & 1, i >> 1 & 1, i >> 2, overflows[i]);
  return 0;
}
