/* Hashes of the results of arithmetic over numbered operands (sweep.h), one line a routine. The same source three
   times:

     for the TP, where the compiler's calls and the runtime's code do the work;
     for the host, whose hardware does it: the reference;
     for the host with SWEEP_RUNTIME, where it is the runtime's sources compiled for the host.

   sweep.py runs them and finds the first operands whose results differ. WHICH is the group. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#ifdef __trax__
#include <trax.h>
#endif

#ifndef __trax__
#include "routines.h"
#endif
#include "sweep.h"

#define BLOCK 1024 /* operands that a thread takes at a time */

static double as_double(uint64_t bits) {
  return double_of(bits);
}
static float as_float(uint32_t bits) {
  return float_of(bits);
}

static inline uint64_t canonical(double x) {
  return x == x ? bits_of(x) : 0x7FF8000000000000u;
}
static inline uint32_t canonical_float(float x) {
  return x == x ? float_bits_of(x) : 0x7FC00000u;
}
/* On the host a NaN's bits are what they happen to be; the TP's arithmetic gives one NaN. */
#ifdef __trax__
#define BITS(x) bits_of(x)
#define FLOAT_BITS(x) float_bits_of(x)
#else
#define BITS(x) canonical(x)
#define FLOAT_BITS(x) canonical_float(x)
#endif

#ifdef SWEEP_RUNTIME
#define RUNTIME(runtime, plain) (runtime)
#else
#define RUNTIME(runtime, plain) (plain)
#endif

/* Conversions to integers: C leaves open what the TP defines, saturation and 0 for a NaN. */
#if defined(__trax__) || defined(SWEEP_RUNTIME)
#define TO_SIGNED(type, x, limit, least, greatest) (type)(x)
#define TO_UNSIGNED(type, x, limit, greatest) (type)(x)
#else
#define TO_SIGNED(type, x, limit, least, greatest)                                                                     \
  ((x) != (x) ? 0 : (x) >= (limit) ? (greatest) : (x) < -(limit) ? (least) : (type)(x))
#define TO_UNSIGNED(type, x, limit, greatest) (!((x) > 0) ? 0 : (x) >= (limit) ? (greatest) : (type)(x))
#endif

/* All six comparisons and "unordered" in one number. */
static inline uint32_t comparisons(double a, double b) {
#ifdef SWEEP_RUNTIME
  return (rt___eqdf2(a, b) == 0) | (rt___nedf2(a, b) != 0) << 1 | (rt___ltdf2(a, b) < 0) << 2 |
         (rt___ledf2(a, b) <= 0) << 3 | (rt___gtdf2(a, b) > 0) << 4 | (rt___gedf2(a, b) >= 0) << 5 |
         (rt___unorddf2(a, b) != 0) << 6;
#else
  return (a == b) | (uint32_t)(a != b) << 1 | (uint32_t)(a < b) << 2 | (uint32_t)(a <= b) << 3 |
         (uint32_t)(a > b) << 4 | (uint32_t)(a >= b) << 5 | (uint32_t)__builtin_isunordered(a, b) << 6;
#endif
}

static inline uint32_t integer_comparisons(uint64_t a, uint64_t b) {
#ifdef SWEEP_RUNTIME
  int s = rt___cmpdi2((int64_t)a, (int64_t)b), u = rt___ucmpdi2(a, b);
  return (uint32_t)(s < 1) | (uint32_t)(s <= 1) << 1 | (uint32_t)(u < 1) << 2 | (uint32_t)(u <= 1) << 3 |
         (uint32_t)(u == 1) << 4;
#else
  return ((int64_t)a < (int64_t)b) | (uint32_t)((int64_t)a <= (int64_t)b) << 1 | (uint32_t)(a < b) << 2 |
         (uint32_t)(a <= b) << 3 | (uint32_t)(a == b) << 4;
#endif
}

/* The same of floats, which the TP compares by itself. */
static inline uint32_t float_comparisons(float a, float b) {
#ifdef SWEEP_RUNTIME
  return (rt___eqsf2(a, b) == 0) | (rt___nesf2(a, b) != 0) << 1 | (rt___ltsf2(a, b) < 0) << 2 |
         (rt___lesf2(a, b) <= 0) << 3 | (rt___gtsf2(a, b) > 0) << 4 | (rt___gesf2(a, b) >= 0) << 5 |
         (rt___unordsf2(a, b) != 0) << 6;
#else
  return comparisons((double)a, (double)b);
#endif
}

/* A quotient and its remainder in one number, as a function gives both. */
#define BOTH(quotient, rest) ((uint64_t)(quotient) ^ ((uint64_t)(rest) << 32 | (uint64_t)(rest) >> 32))
#ifdef SWEEP_RUNTIME
#define DIVIDE_BOTH(name, type, a, b)                                                                                  \
  ({                                                                                                                   \
    type rest, quotient = name((type)(a), (type)(b), &rest);                                                           \
    BOTH(quotient, rest);                                                                                              \
  })
#else
#define DIVIDE_BOTH(name, type, a, b) BOTH((type)(a) / (type)(b), (type)(a) % (type)(b))
#endif

/* A product, sum or difference that may overflow: the wrapped value with the flag in it. */
#define OVERFLOW(operation, type, a, b)                                                                                \
  ({                                                                                                                   \
    type wrapped;                                                                                                      \
    uint64_t flag = operation((type)(a), (type)(b), &wrapped);                                                         \
    (uint64_t)wrapped ^ flag << 62 ^ flag << 17;                                                                       \
  })

#ifdef SWEEP_RUNTIME
static inline int multiply_overflow(int64_t a, int64_t b, int64_t *wrapped) {
  int flag;
  *wrapped = rt___mulodi4(a, b, &flag);
  return flag;
}
#define MULTIPLY_OVERFLOW multiply_overflow
#else
#define MULTIPLY_OVERFLOW __builtin_mul_overflow
#endif

/* Name and result; x, y, z are doubles of the bits a, b, c. */
#define DOUBLE_ROUTINES(X)                                                                                             \
  X(add, BITS(RUNTIME(rt___adddf3(x, y), x + y)))                                                                      \
  X(subtract, BITS(RUNTIME(rt___subdf3(x, y), x - y)))                                                                 \
  X(multiply, BITS(RUNTIME(rt___muldf3(x, y), x *y)))                                                                  \
  X(divide, BITS(RUNTIME(rt___divdf3(x, y), x / y)))                                                                   \
  X(negate, bits_of(RUNTIME(rt___negdf2(x), -x)))                                                                      \
  X(compare, comparisons(x, y))                                                                                        \
  X(order, (uint32_t)RUNTIME(rt___cmpdf2(x, y), x < y ? -1 : x == y ? 0 : 1))                                          \
  X(to_float, FLOAT_BITS(RUNTIME(rt___truncdfsf2(x), (float)x)))                                                       \
  X(to_int32, (uint32_t)RUNTIME(rt___fixdfsi(x), TO_SIGNED(int32_t, x, 0x1p31, INT32_MIN, INT32_MAX)))                 \
  X(to_uint32, RUNTIME(rt___fixunsdfsi(x), TO_UNSIGNED(uint32_t, x, 0x1p32, UINT32_MAX)))                              \
  X(to_int64, (uint64_t)RUNTIME(rt___fixdfdi(x), TO_SIGNED(int64_t, x, 0x1p63, INT64_MIN, INT64_MAX)))                 \
  X(to_uint64, RUNTIME(rt___fixunsdfdi(x), TO_UNSIGNED(uint64_t, x, 0x1p64, UINT64_MAX)))                              \
  X(sqrt, BITS(RUNTIME(rt_sqrt(x), sqrt(x))))                                                                          \
  X(fma, BITS(RUNTIME(rt_fma(x, y, z), fma(x, y, z))))

#define INTEGER_ROUTINES(X)                                                                                            \
  X(divide_unsigned, RUNTIME(rt___udivdi3(a, b), a / b))                                                               \
  X(remainder_unsigned, RUNTIME(rt___umoddi3(a, b), a % b))                                                            \
  X(divide_signed, (uint64_t)RUNTIME(rt___divdi3((int64_t)a, (int64_t)b), (int64_t)a / (int64_t)b))                    \
  X(remainder_signed, (uint64_t)RUNTIME(rt___moddi3((int64_t)a, (int64_t)b), (int64_t)a % (int64_t)b))                 \
  X(divide_unsigned32, RUNTIME(rt___udivsi3((uint32_t)a, (uint32_t)b), (uint32_t)a / (uint32_t)b))                     \
  X(remainder_unsigned32, RUNTIME(rt___umodsi3((uint32_t)a, (uint32_t)b), (uint32_t)a % (uint32_t)b))                  \
  X(divide_signed32, (uint32_t)RUNTIME(rt___divsi3((int32_t)a, (int32_t)b), (int32_t)a / (int32_t)b))                  \
  X(remainder_signed32, (uint32_t)RUNTIME(rt___modsi3((int32_t)a, (int32_t)b), (int32_t)a % (int32_t)b))               \
  X(divide_both, DIVIDE_BOTH(rt___udivmoddi4, uint64_t, a, b))                                                         \
  X(divide_both_signed, DIVIDE_BOTH(rt___divmoddi4, int64_t, a, b))                                                    \
  X(divide_both32, DIVIDE_BOTH(rt___udivmodsi4, uint32_t, a, b))                                                       \
  X(divide_both_signed32, DIVIDE_BOTH(rt___divmodsi4, int32_t, a, b))                                                  \
  X(negate64, RUNTIME(rt___negdi2(a), 0 - a))                                                                          \
  X(multiply64, RUNTIME(rt___muldi3(a, c), a *c))                                                                      \
  X(shift_left, RUNTIME(rt___ashldi3(a, n), a << n))                                                                   \
  X(shift_right, RUNTIME(rt___lshrdi3(a, n), a >> n))                                                                  \
  X(shift_right_signed, (uint64_t)RUNTIME(rt___ashrdi3((int64_t)a, n), (int64_t)a >> n))                               \
  X(compare64, integer_comparisons(a, b))                                                                              \
  X(multiply_overflow, OVERFLOW(MULTIPLY_OVERFLOW, int64_t, a, c >> n))                                                \
  X(multiply_overflow_limit, OVERFLOW(MULTIPLY_OVERFLOW, int64_t, a | 1, limit))                                       \
  X(multiply_overflow_unsigned, OVERFLOW(__builtin_mul_overflow, uint64_t, a, c >> n))                                 \
  X(multiply_overflow32, OVERFLOW(__builtin_mul_overflow, int32_t, a, b))                                              \
  X(add_overflow, OVERFLOW(__builtin_add_overflow, int64_t, a, b))                                                     \
  X(subtract_overflow, OVERFLOW(__builtin_sub_overflow, int64_t, a, b))                                                \
  X(leading_zeros, (uint32_t)RUNTIME(rt___clzdi2(a | 1), __builtin_clzll(a | 1)))                                      \
  X(leading_zeros32, (uint32_t)RUNTIME(rt___clzsi2((uint32_t)a | 1), __builtin_clz((uint32_t)a | 1)))                  \
  X(trailing_zeros, (uint32_t)RUNTIME(rt___ctzdi2(b), __builtin_ctzll(b)))                                             \
  X(trailing_zeros32, (uint32_t)RUNTIME(rt___ctzsi2((uint32_t)b), __builtin_ctz((uint32_t)b)))                         \
  X(first_one, (uint32_t)RUNTIME(rt___ffsdi2(a &c), __builtin_ffsll((long long)(a & c))))                              \
  X(first_one32, (uint32_t)RUNTIME(rt___ffssi2((uint32_t)(a & c)), __builtin_ffs((int)(uint32_t)(a & c))))             \
  X(population, (uint32_t)RUNTIME(rt___popcountdi2(a), __builtin_popcountll(a)))                                       \
  X(population32, (uint32_t)RUNTIME(rt___popcountsi2((uint32_t)a), __builtin_popcount((uint32_t)a)))                   \
  X(parity, (uint32_t)RUNTIME(rt___paritydi2(a), __builtin_parityll(a)))                                               \
  X(parity32, (uint32_t)RUNTIME(rt___paritysi2((uint32_t)a), __builtin_parity((uint32_t)a)))                           \
  X(swap_bytes, RUNTIME(rt___bswapdi2(a), __builtin_bswap64(a)))                                                       \
  X(swap_bytes32, RUNTIME(rt___bswapsi2((uint32_t)a), __builtin_bswap32((uint32_t)a)))                                 \
  X(int64_to_double, BITS(RUNTIME(rt___floatdidf((int64_t)a), (double)(int64_t)a)))                                    \
  X(uint64_to_double, BITS(RUNTIME(rt___floatundidf(a), (double)a)))                                                   \
  X(int32_to_double, BITS(RUNTIME(rt___floatsidf((int32_t)a), (double)(int32_t)a)))                                    \
  X(uint32_to_double, BITS(RUNTIME(rt___floatunsidf((uint32_t)a), (double)(uint32_t)a)))                               \
  X(int64_to_float, FLOAT_BITS(RUNTIME(rt___floatdisf((int64_t)a), (float)(int64_t)a)))                                \
  X(uint64_to_float, FLOAT_BITS(RUNTIME(rt___floatundisf(a), (float)a)))                                               \
  X(float_to_double, BITS(RUNTIME(rt___extendsfdf2(f), (double)f)))                                                    \
  X(float_to_int64, (uint64_t)RUNTIME(rt___fixsfdi(f), TO_SIGNED(int64_t, f, 0x1p63f, INT64_MIN, INT64_MAX)))          \
  X(compare_floats, float_comparisons(f, g))                                                                           \
  X(float_to_uint64, RUNTIME(rt___fixunssfdi(f), TO_UNSIGNED(uint64_t, f, 0x1p64f, UINT64_MAX)))

/* The runtime's functions that are compared with themselves: on the TP and compiled for the host. */
// clang-format off
#define SIMPLE_FUNCTIONS(F, X)                                                                                         \
  F(X, sin) F(X, cos) F(X, tan) F(X, asin) F(X, acos) F(X, atan) F(X, sinh) F(X, cosh) F(X, tanh) F(X, asinh)          \
  F(X, acosh) F(X, atanh) F(X, exp) F(X, exp2) F(X, expm1) F(X, log) F(X, log2) F(X, log10) F(X, log1p) F(X, cbrt)     \
  F(X, erf) F(X, erfc) F(X, tgamma) F(X, lgamma)
// clang-format on
#ifdef __trax__
#define OURS(name) name
double __powidf2(double, int);
float __powisf2(float, int);
double _Complex __muldc3(double, double, double, double);
double _Complex __divdc3(double, double, double, double);
#else
#define OURS(name) rt_##name
#define DECLARE(X, name) double rt_##name(double);
SIMPLE_FUNCTIONS(DECLARE, )
#endif

/* Functions may hand on the NaN they were given, whose bits nothing promises. Both parts of a complex result in one
   number. */
static inline uint64_t complex_bits(double _Complex value) {
  return canonical(__real__ value) ^ (canonical(__imag__ value) << 1 | canonical(__imag__ value) >> 63);
}

#define FUNCTION(X, name) X(name, canonical(OURS(name)(u)))
#define FUNCTION_ROUTINES(X)                                                                                           \
  SIMPLE_FUNCTIONS(FUNCTION, X)                                                                                        \
  X(pow, canonical(OURS(pow)(u, w)))                                                                                   \
  X(atan2, canonical(OURS(atan2)(u, w)))                                                                               \
  X(hypot, canonical(OURS(hypot)(x, y)))                                                                               \
  X(fmod, canonical(OURS(fmod)(x, w)))                                                                                 \
  X(remainder, canonical(OURS(remainder)(u, w)))                                                                       \
  X(integer_power, canonical(OURS(__powidf2)(x, (int)(c % 141) - 70)))                                                 \
  X(integer_power_float, canonical_float(OURS(__powisf2)((float)u, (int)(c % 141) - 70)))                              \
  X(multiply_complex, complex_bits(OURS(__muldc3)(x, y, z, w)))                                                        \
  X(divide_complex, complex_bits(OURS(__divdc3)(x, y, z, w)))

#define COUNT_ONE(name, expression) +1
#define NAME(name, expression) #name,
enum { DOUBLES, INTEGERS, FUNCTIONS, GROUPS };
static const char *const double_names[] = {DOUBLE_ROUTINES(NAME)};
static const char *const integer_names[] = {INTEGER_ROUTINES(NAME)};
static const char *const function_names[] = {FUNCTION_ROUTINES(NAME)};
#define MOST_ROUTINES (0 INTEGER_ROUTINES(COUNT_ONE) FUNCTION_ROUTINES(COUNT_ONE))

#include "sweep_main.h"

static void show(int verbose, const char *name, uint64_t value, struct operands o) {
  if (verbose)
    printf("%s %016llx: %016llx %016llx %016llx\n", name, (unsigned long long)value, (unsigned long long)o.a,
           (unsigned long long)o.b, (unsigned long long)o.c);
}

#define APPLY(name, expression)                                                                                        \
  {                                                                                                                    \
    uint64_t value = expression;                                                                                       \
    add(hash++, value);                                                                                                \
    show(verbose, #name, value, o);                                                                                    \
  }

static __attribute__((noinline)) void sweep_doubles(uint32_t *hash, uint32_t number, int verbose) {
  struct operands o = double_operands(number);
  double x = as_double(o.a), y = as_double(o.b), z = as_double(o.c);
  DOUBLE_ROUTINES(APPLY)
}

static __attribute__((noinline)) void sweep_integers(uint32_t *hash, uint32_t number, int verbose) {
  struct operands o = integer_operands(number);
  uint64_t a = o.a, b = o.b, c = o.c;
  int n = (int)(number >> 3 & 63);
  int64_t limit = INT64_MAX / (int64_t)(a | 1) + (int64_t)(c & 3) - 1; /* where products begin to overflow */
  /* Any float, one of an integer's size, a special one; and another or a neighbour. */
  uint32_t bits = (uint32_t)(number & 1 ? c : (c & 0x807FFFFF) | (127 - 4 + (c >> 32 & 127)) << 23);
  uint32_t other = number & 2 ? (uint32_t)(o.a ^ o.b) : bits + (uint32_t)(c >> 40 & 3) - 1;
  if ((number & 0x18) == 0) {
    bits = special_floats[c % COUNT(special_floats)] | (bits & 0x80000000u);
    other = special_floats[(c >> 20) % COUNT(special_floats)] | (other & 0x80000000u);
  }
  float f = as_float(bits), g = as_float(other);
  INTEGER_ROUTINES(APPLY)
}

/* u and w are ordinary numbers, such as functions are called with. */
static __attribute__((noinline)) void sweep_functions(uint32_t *hash, uint32_t number, int verbose) {
  struct operands o = double_operands(number);
  uint64_t c = o.c;
  double x = as_double(o.a), y = as_double(o.b), z = as_double(o.c);
  double u = as_double(with_exponent(o.a, 1023 - 8 + (int)(number >> 4 & 15))),
         w = as_double(with_exponent(o.b, 1023 - 4 + (int)(c & 7)));
  FUNCTION_ROUTINES(APPLY)
}

static void sweep_block(const struct parameters *p, uint64_t first, uint32_t count, uint32_t *hashes) {
  for (uint32_t i = 0; i < count; i++)
    (p->which == DOUBLES    ? sweep_doubles
     : p->which == INTEGERS ? sweep_integers
                            : sweep_functions)(hashes, (uint32_t)first + i, (int)p->verbose);
}

static const char *const *routine_names(const struct parameters *p, int *count) {
  static const char *const *const names[GROUPS] = {double_names, integer_names, function_names};
  static const int counts[GROUPS] = {COUNT(double_names), COUNT(integer_names), COUNT(function_names)};
  *count = counts[p->which % GROUPS];
  return names[p->which % GROUPS];
}
