/* The compiler's support routines for halves, integer powers and complex numbers, compiled for the host, against the
   host's own arithmetic; sweep.c has the others. The runtime's names carry the prefix rt_ here (CMakeLists.txt). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>

#include "operands.h"
#include "routines.h"

#define RANDOM_OPERANDS 3000000

/* The host compiler's library. */
double __powidf2(double, int);
float __powisf2(float, int);

/* Comparing and reporting with operands in full; cmocka's own assertions would say neither, and take longer. */
#define SAME(got, want, format, ...)                                                                                   \
  do {                                                                                                                 \
    if ((got) != (want))                                                                                               \
      fail_msg("%s: got %#llx, want %#llx for " format, #got, (unsigned long long)(got), (unsigned long long)(want),   \
               __VA_ARGS__);                                                                                           \
  } while (0)

static void same_double(const char *name, double got, double want, uint64_t a, uint64_t b) {
  if (want != want ? bits_of(got) == 0x7FF8000000000000u : bits_of(got) == bits_of(want))
    return;
  fail_msg("%s(%#llx, %#llx) = %#llx, want %#llx", name, (unsigned long long)a, (unsigned long long)b,
           (unsigned long long)bits_of(got), (unsigned long long)bits_of(want));
}

static void same_float(const char *name, float got, float want, uint64_t a) {
  if (want != want ? float_bits_of(got) == 0x7FC00000u : float_bits_of(got) == float_bits_of(want))
    return;
  fail_msg("%s(%#llx) = %#x, want %#x", name, (unsigned long long)a, float_bits_of(got), float_bits_of(want));
}

static uint16_t half_bits_of(_Float16 x) {
  uint16_t bits;
  memcpy(&bits, &x, sizeof bits);
  return x == x ? bits : 0x7E00;
}

static void halves(void **unused) {
  (void)unused;
  for (uint32_t bits = 0; bits < 0x10000; bits++) {
    uint16_t pattern = (uint16_t)bits;
    _Float16 x;
    memcpy(&x, &pattern, sizeof x);
    same_float("__extendhfsf2", rt___extendhfsf2(pattern), (float)x, bits);
  }
  uint64_t state = 8;
  for (int i = 0, last = some_of(RANDOM_OPERANDS); i < last; i++) {
    uint64_t r = random64(&state);
    /* From below the least half to above the greatest; few bits behind its last place, so that many are halfway. */
    uint32_t bits = (uint32_t)(r & 0x80000000u) | (uint32_t)(127 - 27 + (r >> 32) % 46) << 23 |
                    ((uint32_t)r & 0x7FE000) | ((r >> 40 & 3) << 11 & 0x1FFF) | (r >> 42 & (r >> 44 & 1 ? 0x1FFF : 0));
    float f = i & 1 ? float_of(bits) : random_float(&state);
    SAME(rt___truncsfhf2(f), half_bits_of((_Float16)f), "%a", (double)f);
    double d = (double)f + (i & 2 ? (double)f * 0x1p-45 : 0);
    SAME(rt___truncdfhf2(d), half_bits_of((_Float16)d), "%a", d);
  }
}

static void integer_powers(void **unused) {
  (void)unused;
  uint64_t state = 6;
  for (int i = 0, last = some_of(300000); i < last; i++) {
    int n = i < 4 ? (int[]){0, 1, -1, INT32_MIN}[i] : (int)(random64(&state) % 141) - 70;
    double a = random_double(&state);
    float f = random_float(&state);
    double want = __powidf2(a, n);
    float want_float = __powisf2(f, n);
    if (want == want) /* canonical NaNs are a matter of the arithmetic below, which is the host's here */
      same_double("__powidf2", rt___powidf2(a, n), want, bits_of(a), (uint64_t)n);
    if (want_float == want_float)
      same_float("__powisf2", rt___powisf2(f, n), want_float, float_bits_of(f));
  }
}

/* The class of a product or quotient by annex G of the C standard: 0 finite, 1 infinite, 2 NaN. */
static int complex_class(double re, double im) {
  return isinf(re) || isinf(im) ? 1 : re != re || im != im ? 2 : 0;
}

/* Products are the textbook's; quotients are within a few units of the true value, unless parts cancel. */
static void check_complex(double a, double b, double c, double d) {
  double _Complex x = __builtin_complex(a, b), y = __builtin_complex(c, d);
  double _Complex product = rt___muldc3(a, b, c, d), want = x * y;
  int kind = complex_class(__real__ want, __imag__ want);
  if (complex_class(__real__ product, __imag__ product) != kind ||
      (kind == 0 && (__real__ product != __real__ want || __imag__ product != __imag__ want)))
    fail_msg("(%a, %a) * (%a, %a) = %a, %a; want %a, %a", a, b, c, d, __real__ product, __imag__ product, __real__ want,
             __imag__ want);
  long double _Complex exact = (long double _Complex)x / (long double _Complex)y;
  double _Complex quotient = rt___divdc3(a, b, c, d);
  kind = complex_class((double)__real__ exact, (double)__imag__ exact);
  double error = (double)(fabsl(__real__ quotient - __real__ exact) + fabsl(__imag__ quotient - __imag__ exact));
  double size = (double)(fabsl(__real__ exact) + fabsl(__imag__ exact));
  if (complex_class(__real__ quotient, __imag__ quotient) != kind || (kind == 0 && error > size * 0x1p-50 + 0x1p-1070))
    fail_msg("(%a, %a) / (%a, %a) = %a, %a; want %a, %a", a, b, c, d, __real__ quotient, __imag__ quotient,
             (double)__real__ exact, (double)__imag__ exact);
}

static void check_complex_float(float a, float b, float c, float d) {
  double _Complex product = (double _Complex)__builtin_complex(a, b) * (double _Complex)__builtin_complex(c, d);
  double _Complex exact = (double _Complex)__builtin_complex(a, b) / (double _Complex)__builtin_complex(c, d);
  float _Complex got = rt___mulsc3(a, b, c, d), quotient = rt___divsc3(a, b, c, d);
  double size = fabs((double)a) + fabs((double)b), other = fabs((double)c) + fabs((double)d);
  if (fabs(__real__ got - __real__ product) + fabs(__imag__ got - __imag__ product) > size * other * 0x1p-22 + 0x1p-140)
    fail_msg("(%a, %a) * (%a, %a) = %a, %a", a, b, c, d, __real__ got, __imag__ got);
  if (fabs(__real__ quotient - __real__ exact) + fabs(__imag__ quotient - __imag__ exact) >
      size / other * 0x1p-20 + 0x1p-140)
    fail_msg("(%a, %a) / (%a, %a) = %a, %a", a, b, c, d, __real__ quotient, __imag__ quotient);
}

/* Each part by itself, for numbers of all sizes: the error is measured by the terms of which the part is the sum. */
static void check_part(const double *v, const char *part, double got, long double p, long double q, long double divisor,
                       int digits, int least_exponent) {
  long double want = (p + q) / divisor;
  if (fabsl(want) >= ldexpl(1, -least_exponent - digits - 1)) /* close to overflow, or beyond */
    return;
  long double bound = (fabsl(p) + fabsl(q)) / divisor * ldexpl(1, 3 - digits) + ldexpl(1, least_exponent);
  if (!(fabsl(got - want) <= bound))
    fail_msg("%s of (%a, %a) / (%a, %a) = %a; want %La", part, v[0], v[1], v[2], v[3], got, want);
}

static void complex_quotients_of_all_sizes(void **unused) {
  (void)unused;
  uint64_t state = 11;
  for (int i = 0, last = some_of(300000); i < last; i++) {
    double v[4];
    for (int j = 0; j < 4; j++)
      v[j] = ldexp((double)(int64_t)random64(&state), (int)(random64(&state) % 2090) - 1130);
    long double a = v[0], b = v[1], c = v[2], d = v[3];
    if (c == 0 && d == 0)
      continue;
    double _Complex quotient = rt___divdc3(v[0], v[1], v[2], v[3]);
    check_part(v, "real part", __real__ quotient, a * c, b * d, c * c + d * d, 53, -1074);
    check_part(v, "imaginary part", __imag__ quotient, b * c, -a * d, c * c + d * d, 53, -1074);
    for (int j = 0; j < 4; j++)
      v[j] = (float)ldexp((double)(int64_t)random64(&state), (int)(random64(&state) % 270) - 208);
    a = v[0], b = v[1], c = v[2], d = v[3];
    if (c == 0 && d == 0)
      continue;
    float _Complex narrow = rt___divsc3((float)a, (float)b, (float)c, (float)d);
    check_part(v, "real part", __real__ narrow, a * c, b * d, c * c + d * d, 24, -149);
    check_part(v, "imaginary part", __imag__ narrow, b * c, -a * d, c * c + d * d, 24, -149);
  }
}

static void complex_numbers(void **unused) {
  (void)unused;
  static const double special[] = {0.0, -0.0, 1.0, -2.5, 1e300, -1e-300, INFINITY, -INFINITY, NAN};
  for (size_t i = 0; i < COUNT(special) * COUNT(special) * COUNT(special) * COUNT(special); i++) {
    size_t n = COUNT(special);
    check_complex(special[i % n], special[i / n % n], special[i / n / n % n], special[i / n / n / n]);
  }
  uint64_t state = 7;
  for (int i = 0, last = some_of(300000); i < last; i++) {
    double v[4];
    for (int j = 0; j < 4; j++)
      v[j] = ldexp((double)(int64_t)random64(&state), (int)(random64(&state) % 300) - 200);
    check_complex(v[0], v[1], v[2], v[3]);
    for (int j = 0; j < 4; j++)
      v[j] = (float)ldexp((double)(int64_t)random64(&state), (int)(random64(&state) % 40) - 80);
    check_complex_float((float)v[0], (float)v[1], (float)v[2], (float)v[3]);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(halves),
      cmocka_unit_test(integer_powers),
      cmocka_unit_test(complex_numbers),
      cmocka_unit_test(complex_quotients_of_all_sizes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
