// RUN: %run_c %s %t
// 64-bit shifts by every count.
#include <stdio.h>

static volatile unsigned long long values[] = {1, 0x8000000000000000ull, 0x123456789ABCDEF0ull, 0xFFFFFFFF00000000ull};

__attribute__((noinline)) static unsigned long long left(unsigned long long x, int n) {
  return x << n;
}
__attribute__((noinline)) static unsigned long long right(unsigned long long x, int n) {
  return x >> n;
}
__attribute__((noinline)) static long long arithmetic(long long x, int n) {
  return x >> n;
}

int main(void) {
  for (int i = 0; i < 4; i++) {
    unsigned long long hash = 0;
    for (int n = 0; n < 64; n++) {
      hash = hash * 31 + left(values[i], n);
      hash = hash * 31 + right(values[i], n);
      hash = hash * 31 + (unsigned long long)arithmetic((long long)values[i], n);
      if (n % 13 == 0)
        printf("%llx %llx %llx\n", left(values[i], n), right(values[i], n), arithmetic((long long)values[i], n));
    }
    printf("%llx %llx %llx %llx\n", hash, values[i] << 32, values[i] >> 33, values[i] << 1);
  }
  return 0;
}
