// RUN: %run_c %s %t
// Integer promotions, the usual arithmetic conversions, order of evaluation where C fixes it, and _Bool.
#include <stdio.h>

static volatile signed char sc = -1;
static volatile unsigned char uc = 200;
static volatile short ss = -300;
static volatile unsigned short us = 65535;
static volatile int si = -1;
static volatile unsigned ui = 1;
static volatile long long sl = -1;
static volatile unsigned long long ul = 1;

__attribute__((noinline)) static void comparisons(void) {
  printf("%d %d %d %d %d\n", si < (int)ui, (unsigned)si < ui, sc<uc, us> ss, sl < (long long)ui);
  printf("%d %d %d\n", (unsigned long long)sl > ul, (unsigned char)~uc == 55, ~uc == 55);
}

__attribute__((noinline)) static void sums(void) {
  printf("%d %d %d %u\n", sc + uc, ss * us, uc << 8 | uc, us * (unsigned)us);
  printf("%lld %lld %llu\n", sl + (long long)ui, (long long)(si + ui), ul - 2);
  printf("%d %d %d\n", -uc, +sc, (signed char)(uc + 100));
  uc += 100;
  us++;
  ss >>= 4;
  sc /= 2;
  printf("%d %d %d %d\n", uc, us, ss, sc);
  ss += 1.75f;
  uc -= 0.5;
  si *= 2.5;
  printf("%d %d %d\n", ss, uc, si);
}

static int calls;
__attribute__((noinline)) static int count(int result) {
  calls++;
  return result;
}

__attribute__((noinline)) static void order(void) {
  int r = (count(0) && count(1)) + (count(1) || count(0)) * 2;
  printf("%d %d\n", r, calls);
  r = count(0) ? count(5) : (count(6), count(7));
  printf("%d %d\n", r, calls);
  int i = 3;
  i = i++ * 2 == 6 ? i : -i;
  printf("%d %d\n", i, !!count(-8));
}

__attribute__((noinline)) static void booleans(void) {
  volatile float half = 0.5f, zero = -0.0f;
  volatile double tiny = 1e-300;
  volatile unsigned high = 0x100;
  int *volatile where = &calls;
  _Bool a = half, b = zero, c = high, d = tiny, e = (_Bool)where, f = (_Bool)0.1;
  printf("%d%d%d%d%d%d\n", a, b, c, d, e, f);
  a += 5;
  b |= a;
  c ^= 1;
  d = !d;
  e--;
  printf("%d%d%d%d%d %d\n", a, b, c, d, e, (int)sizeof(_Bool));
  struct {
    _Bool x : 1, y : 1;
    unsigned z : 3;
  } s = {2, 0, 15 & 7};
  s.y = s.z;
  printf("%d%d%d\n", s.x, s.y, s.z);
}

int main(void) {
  comparisons();
  sums();
  order();
  booleans();
  return 0;
}
