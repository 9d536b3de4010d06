// RUN: %run_c %s %t
// 64-bit division of every shape: word by word, by word, by two words.
#include <stdio.h>

static volatile long long values[] = {1,
                                      -1,
                                      3,
                                      10,
                                      -1000,
                                      0x7FFFFFFF,
                                      0x80000000ll,
                                      0xFFFFFFFFll,
                                      0x100000000ll,
                                      0x100000001ll,
                                      0xFEDCBA987654ll,
                                      0x7FFFFFFFFFFFFFFFll,
                                      -0x7FFFFFFFFFFFFFFFll};
enum { COUNT = sizeof values / sizeof values[0] };

__attribute__((noinline)) static void divide(long long a, long long b) {
  printf("%lld %lld\n", a / b, a % b);
  printf("%llu %llu\n", (unsigned long long)a / (unsigned long long)b, (unsigned long long)a % (unsigned long long)b);
}

int main(void) {
  for (int i = 0; i < COUNT; i++)
    for (int j = 0; j < COUNT; j++)
      divide(values[i], values[j]);
  volatile unsigned long long n = 12345678901234567890ull;
  printf("%llu %llu %llu\n", n / 10, n % 1000000007, n / 4294967296ull);
  return 0;
}
