/* Hashes of the results of arithmetic over numbered operands (sweep.h), one line a routine. The same source three
   times:

     for the TP, where the compiler's calls and the runtime's code do the work;
     for the host, whose hardware does it: the reference;
     for the host with SWEEP_RUNTIME, where it is the runtime's sources compiled for the host.

   sweep.py runs them and finds the first operands whose results differ. A program is told GROUP FIRST COUNT VERBOSE:
   which routines, from which operands on, how many; and whether to print every result. */
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
  X(multiply64, RUNTIME(rt___muldi3(a, c), a *c))                                                                      \
  X(shift_left, RUNTIME(rt___ashldi3(a, n), a << n))                                                                   \
  X(shift_right, RUNTIME(rt___lshrdi3(a, n), a >> n))                                                                  \
  X(shift_right_signed, (uint64_t)RUNTIME(rt___ashrdi3((int64_t)a, n), (int64_t)a >> n))                               \
  X(compare64, integer_comparisons(a, b))                                                                              \
  X(multiply_overflow, OVERFLOW(MULTIPLY_OVERFLOW, int64_t, a, c >> n))                                                \
  X(multiply_overflow_unsigned, OVERFLOW(__builtin_mul_overflow, uint64_t, a, c >> n))                                 \
  X(multiply_overflow32, OVERFLOW(__builtin_mul_overflow, int32_t, a, b))                                              \
  X(add_overflow, OVERFLOW(__builtin_add_overflow, int64_t, a, b))                                                     \
  X(subtract_overflow, OVERFLOW(__builtin_sub_overflow, int64_t, a, b))                                                \
  X(leading_zeros, (uint32_t)RUNTIME(rt___clzdi2(a | 1), __builtin_clzll(a | 1)))                                      \
  X(trailing_zeros, (uint32_t)RUNTIME(rt___ctzdi2(b), __builtin_ctzll(b)))                                             \
  X(population, (uint32_t)RUNTIME(rt___popcountdi2(a), __builtin_popcountll(a)))                                       \
  X(parity, (uint32_t)RUNTIME(rt___paritydi2(a), __builtin_parityll(a)))                                               \
  X(swap_bytes, RUNTIME(rt___bswapdi2(a), __builtin_bswap64(a)))                                                       \
  X(int64_to_double, BITS(RUNTIME(rt___floatdidf((int64_t)a), (double)(int64_t)a)))                                    \
  X(uint64_to_double, BITS(RUNTIME(rt___floatundidf(a), (double)a)))                                                   \
  X(int32_to_double, BITS(RUNTIME(rt___floatsidf((int32_t)a), (double)(int32_t)a)))                                    \
  X(uint32_to_double, BITS(RUNTIME(rt___floatunsidf((uint32_t)a), (double)(uint32_t)a)))                               \
  X(int64_to_float, FLOAT_BITS(RUNTIME(rt___floatdisf((int64_t)a), (float)(int64_t)a)))                                \
  X(uint64_to_float, FLOAT_BITS(RUNTIME(rt___floatundisf(a), (float)a)))                                               \
  X(float_to_double, BITS(RUNTIME(rt___extendsfdf2(f), (double)f)))                                                    \
  X(float_to_int64, (uint64_t)RUNTIME(rt___fixsfdi(f), TO_SIGNED(int64_t, f, 0x1p63f, INT64_MIN, INT64_MAX)))          \
  X(float_to_uint64, RUNTIME(rt___fixunssfdi(f), TO_UNSIGNED(uint64_t, f, 0x1p64f, UINT64_MAX)))

/* The runtime's functions that are compared with themselves: on the TP and compiled for the host. */
#ifdef __trax__
#define OURS(name) name
#else
#define OURS(name) rt_##name
#define DECLARE(name, expression) double rt_##name(double);
#define SIMPLE_FUNCTIONS(X)                                                                                            \
  X(sin, 0)                                                                                                            \
  X(cos, 0)                                                                                                            \
  X(tan, 0)                                                                                                            \
  X(asin, 0)                                                                                                           \
  X(acos, 0)                                                                                                           \
  X(atan, 0)                                                                                                           \
  X(sinh, 0) X(cosh, 0) X(tanh, 0) X(asinh, 0) X(acosh, 0) X(atanh, 0) X(exp, 0) X(exp2, 0) X(expm1, 0) X(log, 0)      \
      X(log2, 0) X(log10, 0) X(log1p, 0) X(cbrt, 0) X(erf, 0) X(erfc, 0) X(tgamma, 0) X(lgamma, 0)
SIMPLE_FUNCTIONS(DECLARE)
#endif
#ifdef __trax__
double __powidf2(double, int);
float __powisf2(float, int);
double _Complex __muldc3(double, double, double, double);
double _Complex __divdc3(double, double, double, double);
#endif

/* Functions may hand on the NaN they were given, whose bits nothing promises. Both parts of a complex result in one
   number. */
static inline uint64_t complex_bits(double _Complex value) {
  return canonical(__real__ value) ^ (canonical(__imag__ value) << 1 | canonical(__imag__ value) >> 63);
}

#define FUNCTION(X, name) X(name, canonical(OURS(name)(u)))
#define FUNCTION_ROUTINES(X)                                                                                           \
  FUNCTION(X, sin)                                                                                                     \
  FUNCTION(X, cos)                                                                                                     \
  FUNCTION(X, tan)                                                                                                     \
  FUNCTION(X, asin)                                                                                                    \
  FUNCTION(X, acos)                                                                                                    \
  FUNCTION(X, atan)                                                                                                    \
  FUNCTION(X, sinh)                                                                                                    \
  FUNCTION(X, cosh)                                                                                                    \
  FUNCTION(X, tanh)                                                                                                    \
  FUNCTION(X, asinh)                                                                                                   \
  FUNCTION(X, acosh)                                                                                                   \
  FUNCTION(X, atanh)                                                                                                   \
  FUNCTION(X, exp)                                                                                                     \
  FUNCTION(X, exp2)                                                                                                    \
  FUNCTION(X, expm1)                                                                                                   \
  FUNCTION(X, log)                                                                                                     \
  FUNCTION(X, log2)                                                                                                    \
  FUNCTION(X, log10)                                                                                                   \
  FUNCTION(X, log1p)                                                                                                   \
  FUNCTION(X, cbrt)                                                                                                    \
  FUNCTION(X, erf)                                                                                                     \
  FUNCTION(X, erfc)                                                                                                    \
  FUNCTION(X, tgamma)                                                                                                  \
  FUNCTION(X, lgamma)                                                                                                  \
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
static const char *const *const names[GROUPS] = {double_names, integer_names, function_names};
static const int routine_counts[GROUPS] = {COUNT(double_names), COUNT(integer_names), COUNT(function_names)};
#define MOST_ROUTINES (0 INTEGER_ROUTINES(COUNT_ONE) FUNCTION_ROUTINES(COUNT_ONE))

static void add(uint32_t *hash, uint64_t value) {
  uint32_t h = (*hash ^ (uint32_t)value) * 0x9E3779B1u;
  h = ((h ^ h >> 15) ^ (uint32_t)(value >> 32)) * 0x85EBCA6Bu;
  *hash = h ^ h >> 13;
}

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
  float f = as_float((uint32_t)(number & 1 ? c : (c & 0x807FFFFF) | (127 - 4 + (c >> 32 & 127)) << 23));
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

static void sweep_block(int group, uint32_t first, uint32_t count, int verbose, uint32_t *hashes) {
  for (uint32_t i = 0; i < count; i++)
    (group == DOUBLES    ? sweep_doubles
     : group == INTEGERS ? sweep_integers
                         : sweep_functions)(hashes, first + i, verbose);
}

static void print_sums(int group, const uint64_t *sums) {
  for (int i = 0; i < routine_counts[group]; i++)
    printf("%s %016llx\n", names[group][i], (unsigned long long)sums[i]);
}

/* A block's hash goes into the sum multiplied by an odd number of its own, so that no order of the blocks is asked for.
 */
static void add_block(int group, uint32_t first, const uint32_t *hashes, uint64_t *sums) {
  for (int i = 0; i < routine_counts[group]; i++)
    sums[i] += (uint64_t)hashes[i] * (2 * (uint64_t)first + 1);
}

struct parameters {
  uint32_t group, first, count, verbose;
};

#ifdef __trax__

#define MOST_THREADS 64

struct trax_buffer parameters;
static uint32_t hashes[MOST_THREADS][MOST_ROUTINES];
static uint64_t sums[MOST_THREADS][MOST_ROUTINES];
static unsigned next_block, finished;

int main(void) {
  const struct parameters *p = parameters.data;
  unsigned thread = trax_thread();
  if (thread >= MOST_THREADS)
    return 0;
  for (;;) {
    uint32_t done = trax_atomic_inc(&next_block) * BLOCK;
    if (done >= p->count)
      break;
    uint32_t count = p->count - done < BLOCK ? p->count - done : BLOCK;
    for (int i = 0; i < MOST_ROUTINES; i++)
      hashes[thread][i] = 0;
    sweep_block((int)p->group, p->first + done, count, (int)p->verbose, hashes[thread]);
    add_block((int)p->group, p->first + done, hashes[thread], sums[thread]);
  }
  unsigned threads = trax_threads() < MOST_THREADS ? trax_threads() : MOST_THREADS;
  if (trax_atomic_inc(&finished) != threads - 1)
    return 0;
  for (unsigned t = 1; t < threads; t++)
    for (int i = 0; i < MOST_ROUTINES; i++)
      sums[0][i] += sums[t][i];
  if (!p->verbose)
    print_sums((int)p->group, sums[0]);
  return 0;
}

#else

int main(int argc, char **argv) {
  if (argc != 5) {
    fprintf(stderr, "usage: sweep GROUP FIRST COUNT VERBOSE\n");
    return 1;
  }
  struct parameters p = {(uint32_t)strtoul(argv[1], NULL, 0), (uint32_t)strtoul(argv[2], NULL, 0),
                         (uint32_t)strtoul(argv[3], NULL, 0), (uint32_t)strtoul(argv[4], NULL, 0)};
  if (p.group >= GROUPS) {
    fprintf(stderr, "sweep: there are %d groups\n", GROUPS);
    return 1;
  }
  uint64_t sums[MOST_ROUTINES] = {0};
  for (uint32_t done = 0; done < p.count; done += BLOCK) {
    uint32_t hashes[MOST_ROUTINES] = {0};
    sweep_block((int)p.group, p.first + done, p.count - done < BLOCK ? p.count - done : BLOCK, (int)p.verbose, hashes);
    add_block((int)p.group, p.first + done, hashes, sums);
  }
  if (!p.verbose)
    print_sums((int)p.group, sums);
  return 0;
}

#endif
