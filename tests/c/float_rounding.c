// RUN: %run_c %s %t
// binary32 rounding: ties to even, sticky bits, gradual underflow, overflow, wide integers to floats and back.
#include <math.h>
#include <stdio.h>
#include <string.h>

static volatile float one = 1, least = 0x1p-149f, normal = 0x1p-126f, most = 0x1.fffffep127f, half_ulp = 0x1p-24f;
static volatile long long integers[] = {16777217,           16777219,           33554433,          0x7FFFFF4000000000,
                                        0x7FFFFFC000000000, 0x7FFFFFFFFFFFFFFF, -16777217,         -0x7FFFFFBFFFFFFFFF,
                                        0x4000004000000000, 0x4000004000000001, 0x400000C000000000};

__attribute__((noinline)) static void show(float x) {
  unsigned u;
  memcpy(&u, &x, 4);
  printf("%08x ", x != x ? 0x7FC00000 : u);
}

__attribute__((noinline)) static void sums(void) {
  show(one + half_ulp);              /* tie, down to even */
  show(one + 0x1p-23f + half_ulp);   /* tie, up to even */
  show(one + half_ulp * 1.0000002f); /* just more than a tie */
  show(one - half_ulp / 2);          /* tie below a power of two */
  show(one + 0x1p-60f);              /* lost */
  show(0x1p24f * one + one);         /* tie */
  show(-one + (one + 0x1p-23f));     /* exact */
  show(most + 0x1p102f);             /* stays */
  show(most + 0x1p103f);             /* tie to infinity */
  puts("");
}

__attribute__((noinline)) static void underflow(void) {
  show(least * 0.5f); /* tie to zero */
  show(least * 0.75f);
  show(least * 1.5f); /* tie to even: two */
  show(normal - least);
  show((normal + least) * 0.5f);
  show(normal * 0x1.fffffep-1f); /* rounds up to the least normal number */
  show(normal / 3);
  show(least / most);
  show(-least * least);
  show(least - least);
  puts("");
}

__attribute__((noinline)) static void quotients(void) {
  unsigned hash = 0;
  for (float a = 1; a < 8; a += 0.37f)
    for (float b = 0.013f; b < 4; b *= 1.7f) {
      float q = a / b, r = q * b - a, m = one / q;
      unsigned u[3];
      memcpy(&u[0], &q, 4);
      memcpy(&u[1], &r, 4);
      memcpy(&u[2], &m, 4);
      for (int i = 0; i < 3; i++)
        hash = hash * 31 + u[i];
    }
  printf("%08x\n", hash);
  show(most / 0x1.fffffep-1f);
  show(one / 0.0f);
  show(-one / INFINITY);
  show(0x1.000002p0f / 0x1.fffffep-1f);
  puts("");
}

__attribute__((noinline)) static void roots(void) {
  unsigned hash = 0;
  for (float x = 0x1p-149f; x < 0x1p120f; x *= 7.3f) {
    float r = sqrtf(x);
    unsigned u;
    memcpy(&u, &r, 4);
    hash = hash * 31 + u;
  }
  printf("%08x\n", hash);
}

__attribute__((noinline)) static void compensated(void) {
  volatile float naive = 0, sum = 0, lost = 0;
  for (int i = 1; i < 400; i++) {
    float x = one / (float)i;
    naive += x;
    float y = x - lost, t = sum + y;
    lost = (t - sum) - y;
    sum = t;
  }
  show(naive);
  show(sum);
  show(lost);
  puts("");
}

int main(void) {
  sums();
  underflow();
  quotients();
  roots();
  compensated();
  for (int i = 0; i < 11; i++) {
    float f = (float)integers[i];
    show(f);
    show((float)(unsigned long long)integers[i]);
    show((float)(int)(integers[i] >> 16));
    puts("");
  }
  return 0;
}
