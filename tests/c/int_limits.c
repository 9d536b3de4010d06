// RUN: %run_c %s %t
// The ends of the ranges: least and greatest of each type, quotients by and of them, remainders, negation, wrapping.
#include <limits.h>
#include <stdint.h>
#include <stdio.h>

static volatile int ends[] = {INT_MIN, INT_MIN + 1, -32769, -1, 1, 46340, 46341, INT_MAX - 1, INT_MAX};
static volatile long long wide[] = {LLONG_MIN, LLONG_MIN + 1, -3037000500ll, -1,
                                    1,         3037000499ll,  LLONG_MAX - 1, LLONG_MAX};

__attribute__((noinline)) static void quotient(int a, int b) {
  if (a != INT_MIN || b != -1)
    printf("%d %d ", a / b, a % b);
  printf("%u %u\n", (unsigned)a / (unsigned)b, (unsigned)a % (unsigned)b);
}

/* Divisors that compilers turn into products, shifts and masks, on the operands
 * where those are delicate. */
__attribute__((noinline)) static void constant_divisors(int a) {
  unsigned u = (unsigned)a;
  printf("%d %d %d %d %d\n", a / 5, a / -7, a / 2147483647, a / 1073741824, a / (-2147483647 - 1));
  printf("%d %d %d %d %d\n", a % 5, a % -7, a % 2147483647, a % 1073741824, a % (-2147483647 - 1));
  printf("%u %u %u %u\n", u / 7, u / 4294967295u, u / 2147483648u, u % 2147483649u);
}

__attribute__((noinline)) static void wide_quotient(long long a, long long b) {
  if (a != LLONG_MIN || b != -1)
    printf("%lld %lld\n", a / b, a % b);
}

__attribute__((noinline)) static void narrow(int a) {
  signed char c = (signed char)a;
  short s = (short)a;
  printf("%d %d %d %d\n", (signed char)-c, (short)-s, (signed char)(c - 1), (unsigned short)(s + 1));
}

__attribute__((noinline)) static void checked(int a, int b) {
  int sum, product, difference;
  int carry = __builtin_add_overflow(a, b, &sum), over = __builtin_mul_overflow(a, b, &product);
  int borrow = __builtin_sub_overflow(a, b, &difference);
  printf("%d %d %d %d %d %d\n", carry, sum, over, product, borrow, difference);
}

int main(void) {
  for (int i = 0; i < 9; i++) {
    constant_divisors(ends[i]);
    narrow(ends[i]);
    for (int j = 0; j < 9; j++) {
      quotient(ends[i], ends[j]);
      checked(ends[i], ends[j]);
    }
  }
  for (int i = 0; i < 8; i++)
    for (int j = 0; j < 8; j++)
      wide_quotient(wide[i], wide[j]);
  printf("%d %d %u %d %d\n", CHAR_MIN, SCHAR_MAX, UINT_MAX, SHRT_MIN, USHRT_MAX);
  printf("%lld %llu %d\n", (long long)INT64_MIN, (unsigned long long)UINT64_MAX, INT32_C(-2147483647) - 1 == INT_MIN);
  return 0;
}
