/* The compiler's support routines, compiled for the host, against the host's own arithmetic: not one bit may differ.
   The runtime's names carry the prefix rt_ here (CMakeLists.txt). */
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

static void check_division32(uint32_t n, uint32_t d) {
  if (d == 0)
    return;
  uint32_t rest;
  SAME(rt___udivsi3(n, d), n / d, "%u / %u", n, d);
  SAME(rt___umodsi3(n, d), n % d, "%u %% %u", n, d);
  SAME(rt___udivmodsi4(n, d, &rest), n / d, "%u / %u", n, d);
  SAME(rest, n % d, "%u %% %u", n, d);
  int32_t sn = (int32_t)n, sd = (int32_t)d, signed_rest;
  if (sn == INT32_MIN && sd == -1)
    return;
  SAME(rt___divsi3(sn, sd), sn / sd, "%d / %d", sn, sd);
  SAME(rt___modsi3(sn, sd), sn % sd, "%d %% %d", sn, sd);
  SAME(rt___divmodsi4(sn, sd, &signed_rest), sn / sd, "%d / %d", sn, sd);
  SAME(signed_rest, sn % sd, "%d %% %d", sn, sd);
}

static void check_division64(uint64_t n, uint64_t d) {
  if (d == 0)
    return;
  uint64_t rest;
  SAME(rt___udivdi3(n, d), n / d, "%#llx / %#llx", (unsigned long long)n, (unsigned long long)d);
  SAME(rt___umoddi3(n, d), n % d, "%#llx %% %#llx", (unsigned long long)n, (unsigned long long)d);
  SAME(rt___udivmoddi4(n, d, &rest), n / d, "%#llx / %#llx", (unsigned long long)n, (unsigned long long)d);
  SAME(rest, n % d, "%#llx %% %#llx", (unsigned long long)n, (unsigned long long)d);
  int64_t sn = (int64_t)n, sd = (int64_t)d, signed_rest;
  if (sn == INT64_MIN && sd == -1)
    return;
  SAME(rt___divdi3(sn, sd), sn / sd, "%lld / %lld", (long long)sn, (long long)sd);
  SAME(rt___moddi3(sn, sd), sn % sd, "%lld %% %lld", (long long)sn, (long long)sd);
  SAME(rt___divmoddi4(sn, sd, &signed_rest), sn / sd, "%lld / %lld", (long long)sn, (long long)sd);
  SAME(signed_rest, sn % sd, "%lld %% %lld", (long long)sn, (long long)sd);
}

static void check_integers(uint64_t a, uint64_t b) {
  check_division32((uint32_t)a, (uint32_t)b);
  check_division64(a, b);
  int n = (int)(b & 63);
  SAME(rt___ashldi3(a, n), a << n, "%#llx by %d", (unsigned long long)a, n);
  SAME(rt___lshrdi3(a, n), a >> n, "%#llx by %d", (unsigned long long)a, n);
  SAME(rt___ashrdi3((int64_t)a, n), (int64_t)a >> n, "%#llx by %d", (unsigned long long)a, n);
  SAME(rt___muldi3(a, b), a * b, "%#llx, %#llx", (unsigned long long)a, (unsigned long long)b);
  SAME(rt___negdi2(a), 0 - a, "%#llx", (unsigned long long)a);
  SAME(rt___cmpdi2((int64_t)a, (int64_t)b), ((int64_t)a > (int64_t)b) - ((int64_t)a < (int64_t)b) + 1, "%#llx, %#llx",
       (unsigned long long)a, (unsigned long long)b);
  SAME(rt___ucmpdi2(a, b), (a > b) - (a < b) + 1, "%#llx, %#llx", (unsigned long long)a, (unsigned long long)b);
  uint32_t w = (uint32_t)a;
  if (a) {
    SAME(rt___clzdi2(a), __builtin_clzll(a), "%#llx", (unsigned long long)a);
    SAME(rt___ctzdi2(a), __builtin_ctzll(a), "%#llx", (unsigned long long)a);
  }
  if (w) {
    SAME(rt___clzsi2(w), __builtin_clz(w), "%#x", w);
    SAME(rt___ctzsi2(w), __builtin_ctz(w), "%#x", w);
  }
  SAME(rt___ffssi2(w), __builtin_ffs((int)w), "%#x", w);
  SAME(rt___ffsdi2(a), __builtin_ffsll((long long)a), "%#llx", (unsigned long long)a);
  SAME(rt___popcountsi2(w), __builtin_popcount(w), "%#x", w);
  SAME(rt___popcountdi2(a), __builtin_popcountll(a), "%#llx", (unsigned long long)a);
  SAME(rt___paritysi2(w), __builtin_parity(w), "%#x", w);
  SAME(rt___paritydi2(a), __builtin_parityll(a), "%#llx", (unsigned long long)a);
  SAME(rt___bswapsi2(w), __builtin_bswap32(w), "%#x", w);
  SAME(rt___bswapdi2(a), __builtin_bswap64(a), "%#llx", (unsigned long long)a);
  same_double("__floatsidf", rt___floatsidf((int32_t)w), (int32_t)w, w, 0);
  same_double("__floatunsidf", rt___floatunsidf(w), w, w, 0);
  same_double("__floatdidf", rt___floatdidf((int64_t)a), (double)(int64_t)a, a, 0);
  same_double("__floatundidf", rt___floatundidf(a), (double)a, a, 0);
  same_float("__floatdisf", rt___floatdisf((int64_t)a), (float)(int64_t)a, a);
  same_float("__floatundisf", rt___floatundisf(a), (float)a, a);
}

/* Towards zero, saturating, NaN to 0. */
static int64_t to_signed(double x, double limit, int64_t least, int64_t greatest) {
  return x != x ? 0 : x >= limit ? greatest : x < -limit ? least : (int64_t)x;
}
static uint64_t to_unsigned(double x, double limit, uint64_t greatest) {
  return !(x > 0) ? 0 : x >= limit ? greatest : (uint64_t)x;
}

static void check_doubles(double a, double b) {
  uint64_t ua = bits_of(a), ub = bits_of(b);
  same_double("__adddf3", rt___adddf3(a, b), a + b, ua, ub);
  same_double("__subdf3", rt___subdf3(a, b), a - b, ua, ub);
  same_double("__muldf3", rt___muldf3(a, b), a * b, ua, ub);
  same_double("__divdf3", rt___divdf3(a, b), a / b, ua, ub);
  SAME(bits_of(rt___negdf2(a)), ua ^ (uint64_t)1 << 63, "%#llx", (unsigned long long)ua);
  SAME(rt___eqdf2(a, b) == 0, a == b, "%a, %a", a, b);
  SAME(rt___nedf2(a, b) != 0, a != b, "%a, %a", a, b);
  SAME(rt___ltdf2(a, b) < 0, a < b, "%a, %a", a, b);
  SAME(rt___ledf2(a, b) <= 0, a <= b, "%a, %a", a, b);
  SAME(rt___gtdf2(a, b) > 0, a > b, "%a, %a", a, b);
  SAME(rt___gedf2(a, b) >= 0, a >= b, "%a, %a", a, b);
  SAME(rt___cmpdf2(a, b), a < b ? -1 : a == b ? 0 : 1, "%a, %a", a, b);
  SAME(rt___unorddf2(a, b) != 0, a != a || b != b, "%a, %a", a, b);
  same_float("__truncdfsf2", rt___truncdfsf2(a), (float)a, ua);
  SAME(rt___fixdfsi(a), (int32_t)to_signed(a, 0x1p31, INT32_MIN, INT32_MAX), "%a", a);
  SAME(rt___fixunsdfsi(a), (uint32_t)to_unsigned(a, 0x1p32, UINT32_MAX), "%a", a);
  SAME(rt___fixdfdi(a), to_signed(a, 0x1p63, INT64_MIN, INT64_MAX), "%a", a);
  SAME(rt___fixunsdfdi(a), to_unsigned(a, 0x1p64, UINT64_MAX), "%a", a);
}

static void check_floats(float a, float b) {
  same_double("__extendsfdf2", rt___extendsfdf2(a), a, float_bits_of(a), 0);
  SAME(rt___fixsfdi(a), to_signed(a, 0x1p63, INT64_MIN, INT64_MAX), "%a", a);
  SAME(rt___fixunssfdi(a), to_unsigned(a, 0x1p64, UINT64_MAX), "%a", a);
  SAME(rt___eqsf2(a, b) == 0, a == b, "%a, %a", a, b);
  SAME(rt___nesf2(a, b) != 0, a != b, "%a, %a", a, b);
  SAME(rt___ltsf2(a, b) < 0, a < b, "%a, %a", a, b);
  SAME(rt___lesf2(a, b) <= 0, a <= b, "%a, %a", a, b);
  SAME(rt___gtsf2(a, b) > 0, a > b, "%a, %a", a, b);
  SAME(rt___gesf2(a, b) >= 0, a >= b, "%a, %a", a, b);
  SAME(rt___unordsf2(a, b) != 0, a != a || b != b, "%a, %a", a, b);
}

static void special_integer_pairs(void **state) {
  (void)state;
  for (size_t i = 0; i < 2 * COUNT(special_integers); i++)
    for (size_t j = 0; j < 2 * COUNT(special_integers); j++) {
      uint64_t a = special_integers[i / 2], b = special_integers[j / 2];
      check_integers(i & 1 ? 0 - a : a, j & 1 ? 0 - b : b);
    }
}

static void random_integers(void **unused) {
  (void)unused;
  uint64_t state = 1;
  for (int i = 0, last = some_of(RANDOM_OPERANDS); i < last; i++)
    check_integers(random_integer(&state), random_integer(&state));
}

/* Quotients and remainders at their limits: n = q*d + r with r = 0 and r = d - 1, where an estimate one off would show.
 */
static void quotients_at_the_limits(void **unused) {
  (void)unused;
  uint64_t state = 2;
  for (int i = 0, last = some_of(RANDOM_OPERANDS); i < last; i++) {
    uint64_t d = random_integer(&state), q = random_integer(&state);
    if (d == 0)
      continue;
    q %= UINT64_MAX / d;
    check_division64(q * d, d);
    check_division64(q * d + (d - 1), d);
    uint32_t d32 = (uint32_t)d ? (uint32_t)d : 1, q32 = (uint32_t)q % (UINT32_MAX / d32 ? UINT32_MAX / d32 : 1);
    check_division32(q32 * d32, d32);
    check_division32(q32 * d32 + (d32 - 1), d32);
  }
}

static void special_double_pairs(void **state) {
  (void)state;
  for (size_t i = 0; i < 2 * COUNT(special_doubles); i++)
    for (size_t j = 0; j < 2 * COUNT(special_doubles); j++)
      check_doubles(double_of(special_doubles[i / 2] | (uint64_t)(i & 1) << 63),
                    double_of(special_doubles[j / 2] | (uint64_t)(j & 1) << 63));
}

static void random_doubles(void **unused) {
  (void)unused;
  uint64_t state = 3;
  for (int i = 0, last = some_of(RANDOM_OPERANDS); i < last; i++) {
    double a = random_double(&state), b = random_double(&state);
    check_doubles(a, b);
    check_doubles(a, double_of(bits_of(a) + (random64(&state) & 7) - 3)); /* cancellation */
  }
}

/* Products and quotients on the border of the subnormals, where rounding happens at another place. */
static void doubles_near_underflow(void **unused) {
  (void)unused;
  uint64_t state = 4;
  for (int i = 0, last = some_of(RANDOM_OPERANDS); i < last; i++) {
    uint64_t r = random64(&state);
    double a = double_of((random64(&state) & 0x800FFFFFFFFFFFFFu) | (400 + r % 200) << 52);
    double b = double_of((random64(&state) & 0x800FFFFFFFFFFFFFu) | (500 + (r >> 32) % 100) << 52);
    check_doubles(a, b);
    same_double("__divdf3", rt___divdf3(a, 1 / b), a / (1 / b), bits_of(a), bits_of(1 / b));
    float f = float_of((uint32_t)r & 0x80FFFFFF);
    check_doubles((double)f + b, f);
    check_doubles((double)f * 0.5, (double)float_of(float_bits_of(f) + 1) * 0.5); /* halfway between floats */
  }
}

static void floats(void **unused) {
  (void)unused;
  uint64_t state = 5;
  for (int i = 0, last = some_of(RANDOM_OPERANDS); i < last; i++) {
    float a = random_float(&state), b = random_float(&state);
    check_floats(a, b);
    check_floats(a, a);
  }
  static const uint32_t special[] = {0,          1,          0x007FFFFF, 0x00800000, 0x3F7FFFFF, 0x3F800000,
                                     0x4EFFFFFF, 0x4F000000, 0x4F800000, 0x5EFFFFFF, 0x5F000000, 0x5F7FFFFF,
                                     0x5F800000, 0x7F7FFFFF, 0x7F800000, 0x7F800001, 0x7FC00000};
  for (size_t i = 0; i < 2 * COUNT(special); i++)
    for (size_t j = 0; j < 2 * COUNT(special); j++)
      check_floats(float_of(special[i / 2] | (uint32_t)(i & 1) << 31),
                   float_of(special[j / 2] | (uint32_t)(j & 1) << 31));
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

static void products_that_overflow(void **unused) {
  (void)unused;
  uint64_t state = 9;
  for (int i = 0, last = some_of(RANDOM_OPERANDS); i < last; i++) {
    int64_t a = (int64_t)random_integer(&state), b = (int64_t)random_integer(&state), want;
    if (i & 1 && a) /* at the limit */
      b = INT64_MAX / a + (int64_t)(random64(&state) % 3) - 1;
    int overflow, host_overflow = __builtin_mul_overflow(a, b, &want);
    SAME(rt___mulodi4(a, b, &overflow), want, "%lld, %lld", (long long)a, (long long)b);
    SAME(overflow, host_overflow, "%lld, %lld", (long long)a, (long long)b);
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

/* What annex G of the C standard asks of a product or quotient: 0 finite, 1 infinite, 2 NaN. */
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
      cmocka_unit_test(special_integer_pairs),
      cmocka_unit_test(random_integers),
      cmocka_unit_test(quotients_at_the_limits),
      cmocka_unit_test(special_double_pairs),
      cmocka_unit_test(random_doubles),
      cmocka_unit_test(doubles_near_underflow),
      cmocka_unit_test(floats),
      cmocka_unit_test(halves),
      cmocka_unit_test(products_that_overflow),
      cmocka_unit_test(integer_powers),
      cmocka_unit_test(complex_numbers),
      cmocka_unit_test(complex_quotients_of_all_sizes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
