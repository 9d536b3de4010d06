// RUN: %run_c %s %t --cflags "-mstack=global"
// Expected output by hand.
// Every function of <math.h> that gives a NaN for a NaN gives the canonical one, in both widths, for quiet and
// signalling operands of either sign; those that only look at the sign keep the bits.
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static uint32_t bits32(float x) {
  uint32_t u;
  memcpy(&u, &x, sizeof u);
  return u;
}
static uint64_t bits64(double x) {
  uint64_t u;
  memcpy(&u, &x, sizeof u);
  return u;
}
static float float_of(uint32_t u) {
  float x;
  memcpy(&x, &u, sizeof x);
  return x;
}
static double double_of(uint64_t u) {
  double x;
  memcpy(&x, &u, sizeof x);
  return x;
}

#define CANONICAL32 0x7FC00000u
#define CANONICAL64 0x7FF8000000000000u
static const uint32_t nans32[] = {0x7FC00000, 0xFFC00000, 0x7FC00001, 0xFFC12345, 0x7FFFFFFF,
                                  0xFFFFFFFF, 0x7F800001, 0xFF800001, 0x7FA5A5A5, 0xFFBFFFFF};
static const uint64_t nans64[] = {0x7FF8000000000000, 0xFFF8000000000000, 0x7FF8000000000001, 0xFFF8123456789ABC,
                                  0x7FFFFFFFFFFFFFFF, 0xFFFFFFFFFFFFFFFF, 0x7FF0000000000001, 0xFFF0000000000001,
                                  0x7FF0000100000000, 0xFFF7FFFFFFFFFFFF};
enum { NANS = sizeof nans32 / sizeof *nans32 };

static int checked;
static void check32(const char *name, uint32_t operand, float result) {
  checked++;
  if (bits32(result) != CANONICAL32)
    printf("%sf(%08x) gives %08x\n", name, (unsigned)operand, (unsigned)bits32(result));
}
static void check64(const char *name, uint64_t operand, double result) {
  checked++;
  if (bits64(result) != CANONICAL64)
    printf("%s(%016llx) gives %016llx\n", name, operand, bits64(result));
}

#define ONE(X)                                                                                                         \
  X(rint)                                                                                                              \
  X(nearbyint) X(floor) X(ceil) X(trunc) X(round) X(sqrt) X(cbrt) X(logb) X(sin) X(cos) X(tan) X(asin) X(acos) X(atan) \
      X(sinh) X(cosh) X(tanh) X(asinh) X(acosh) X(atanh) X(exp) X(exp2) X(expm1) X(log) X(log2) X(log10) X(log1p)      \
          X(erf) X(erfc) X(lgamma) X(tgamma)
#define TWO(X) X(fmod) X(remainder) X(fdim) X(nextafter) X(atan2) X(pow) X(hypot)

static const struct {
  const char *name;
  float (*narrow)(float);
  double (*wide)(double);
} ones[] = {
#define ROW(name) {#name, name##f, name},
    ONE(ROW)};
static const struct {
  const char *name;
  float (*narrow)(float, float);
  double (*wide)(double, double);
} twos[] = {TWO(ROW)};

int main(void) {
  for (int i = 0; i < NANS; i++) {
    uint32_t n = nans32[i];
    uint64_t w = nans64[i];
    volatile float x = float_of(n);
    volatile double y = double_of(w);
    float whole32;
    double whole64;
    int exponent;
    for (unsigned f = 0; f < sizeof ones / sizeof *ones; f++) {
      check32(ones[f].name, n, ones[f].narrow(x));
      check64(ones[f].name, w, ones[f].wide(y));
    }
    for (unsigned f = 0; f < sizeof twos / sizeof *twos; f++) {
      check32(twos[f].name, n, twos[f].narrow(x, 2));
      check32(twos[f].name, n, twos[f].narrow(2, x));
      check64(twos[f].name, w, twos[f].wide(y, 2));
      check64(twos[f].name, w, twos[f].wide(2, y));
    }
    check32("modf", n, modff(x, &whole32));
    check32("modf's whole part ", n, whole32);
    check64("modf", w, modf(y, &whole64));
    check64("modf's whole part ", w, whole64);
    check32("frexp", n, frexpf(x, &exponent));
    check64("frexp", w, frexp(y, &exponent));
    for (int power = -300; power <= 300; power += 100) {
      check32("ldexp", n, ldexpf(x, power));
      check64("ldexp", w, ldexp(y, power));
      check32("scalbn", n, scalbnf(x, power));
      check64("scalbn", w, scalbn(y, power));
      check32("scalbln", n, scalblnf(x, power));
      check64("scalbln", w, scalbln(y, power));
    }
    check32("remquo", n, remquof(x, 2, &exponent));
    check64("remquo", w, remquo(y, 2, &exponent));
    check32("fma", n, fmaf(2, x, 3));
    check64("fma", w, fma(2, y, 3));
    check32("fma", n, fmaf(2, 4, x));
    check64("fma", w, fma(2, 4, y));
    check32("nexttoward", n, nexttowardf(x, 2));
    check64("nexttoward", w, nexttoward(y, 2));
    check32("fmin", n, fminf(x, x));
    check64("fmax", w, fmax(y, y));
    check32("(float)", n, (float)y);
    check64("(double)", w, (double)x);
    if (bits32(fabsf(x)) != (n & 0x7FFFFFFF) || bits32(copysignf(x, -1)) != (n | 0x80000000))
      printf("fabsf, copysignf of %08x\n", (unsigned)n);
    if (bits64(fabs(y)) != (w & 0x7FFFFFFFFFFFFFFF) || bits64(copysign(y, -1)) != (w | 0x8000000000000000))
      printf("fabs, copysign of %016llx\n", w);
    if (bits32(fminf(x, 2)) != bits32(2) || bits64(fmax(3, y)) != bits64(3))
      printf("fmin, fmax of %08x\n", (unsigned)n);
    if (lrintf(x) || lround(y) || llrint(y) || llroundf(x))
      printf("lrint, lround of %08x\n", (unsigned)n);
  }
  printf("%d results\n", checked);
  return 0;
}
