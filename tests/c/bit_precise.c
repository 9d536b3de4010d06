// RUN: %run_c %s %t --cflags "-std=c2x"
// _BitInt of odd widths: arithmetic wraps or is exact at the declared width, in memory and through calls.
// (Expected output by clang.)
#include <stdio.h>

typedef _BitInt(5) s5;
typedef unsigned _BitInt(5) u5;
typedef _BitInt(37) s37;
typedef unsigned _BitInt(37) u37;
typedef unsigned _BitInt(64) u64;
typedef _BitInt(17) s17;

struct packed {
  s5 a;
  s37 b;
  u37 field : 33;
};

__attribute__((noinline)) static u5 add5(u5 a, u5 b) {
  return a + b;
}
__attribute__((noinline)) static s37 mix(s5 a, s37 b, s17 c, struct packed p) {
  return a * b - c / (a ? a : 1) + p.b % 1000 + (s37)p.field;
}
__attribute__((noinline)) static u37 divide(u37 a, u37 b) {
  return a / b + (a % b << 20);
}
__attribute__((noinline)) static u64 shifts(u37 a, int n) {
  return (u64)(u37)(a << n) * 3 ^ (u64)(a >> n);
}

int main(void) {
  volatile u5 x = 30;
  volatile s37 y = -68719476736wb;
  volatile u37 z = 0x1234567890uwb;
  printf("%u %u\n", (unsigned)add5(x, 5), (unsigned)(u5)(x * x));
  struct packed p = {-3, 123456789012wb / 10, 0x1FFFFFFFFuwb};
  printf("%lld %lld\n", (long long)mix(-7, y / 3, 65535 / 2, p), (long long)(s37)(y - 1));
  printf("%llx %llx\n", (unsigned long long)divide(z, 12345), (unsigned long long)shifts(z, 11));
  printf("%d %d %d %d\n", (int)sizeof(s5), (int)sizeof(s17), (int)(p.a < 0), (int)(s5)(p.a << 3));
  printf("%lld %g\n", (long long)p.field, (double)y);
  return 0;
}
