/* Cycles of the runtime's binary64 functions and of integer division on one TP, warm, the call included;
   docs/results/functions.md and docs/runtime.md have the tables. accuracy/cost.c is for binary32.

     clang --target=trax -O2 tests/numerics/cycles.c -o cycles.elf
     trax-sim --set icache.bytes=1048576 --set dcache.bytes=1048576 cycles.elf

   Each is called through a pointer four times with the same arguments; the last call counts. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <trax.h>

typedef double function_1(double);
typedef double function_2(double, double);

static double sum(double x, double y) {
  return x + y;
}
static double product(double x, double y) {
  return x * y;
}
static double quotient(double x, double y) {
  return x / y;
}
static double less(double x, double y) {
  return x < y;
}

static uint64_t unsigned32(uint64_t n, uint64_t d) {
  return (uint32_t)n / (uint32_t)d;
}
static uint64_t signed32(uint64_t n, uint64_t d) {
  return (uint64_t)((int32_t)n % (int32_t)d);
}
static uint64_t unsigned64(uint64_t n, uint64_t d) {
  return n / d;
}
static uint64_t signed64(uint64_t n, uint64_t d) {
  return (uint64_t)((int64_t)n % (int64_t)d);
}

/* Right at once, refined, less than the divisor; divisors of one and two words. */
static const struct {
  const char *name;
  uint64_t (*function)(uint64_t, uint64_t);
  uint64_t n, d;
} divisions[] = {
    {"u32 /", unsigned32, 1000000, 7},
    {"u32 /", unsigned32, 4000000001, 3},
    {"u32 /", unsigned32, 6, 7},
    {"i32 %", signed32, 1000000, 7},
    {"i32 %", signed32, 2000000001, 3},
    {"u64 /", unsigned64, 1000000, 7},
    {"u64 /", unsigned64, 1234567890123456789, 1000003},
    {"u64 /", unsigned64, 1234567890123456789, 123456789012},
    {"i64 %", signed64, 1000000, 7},
    {"i64 %", signed64, 1234567890123456789, 1000003},
    {"i64 %", signed64, 1234567890123456789, 123456789012},
};

static const struct {
  const char *name;
  function_1 *function;
  double argument;
} functions_1[] = {
    {"sqrt", sqrt, 0.7},     {"sin", sin, 0.7},       {"sin", sin, 5.3},       {"sin", sin, 1e22},
    {"cos", cos, 0.7},       {"cos", cos, 5.3},       {"tan", tan, 0.6},       {"tan", tan, 5.3},
    {"asin", asin, 0.3},     {"asin", asin, 0.7},     {"acos", acos, 0.3},     {"acos", acos, 0.7},
    {"atan", atan, 0.3},     {"atan", atan, 5.3},     {"sinh", sinh, 0.7},     {"cosh", cosh, 0.7},
    {"tanh", tanh, 0.7},     {"asinh", asinh, 0.7},   {"acosh", acosh, 1.7},   {"atanh", atanh, 0.7},
    {"exp", exp, 0.7},       {"exp2", exp2, 0.7},     {"expm1", expm1, 0.7},   {"log", log, 0.7},
    {"log", log, 1.01},      {"log2", log2, 0.7},     {"log10", log10, 0.7},   {"log1p", log1p, 0.7},
    {"cbrt", cbrt, 0.7},     {"erf", erf, 0.7},       {"erfc", erfc, 0.7},     {"erfc", erfc, 5.3},
    {"lgamma", lgamma, 1.7}, {"lgamma", lgamma, 5.3}, {"tgamma", tgamma, 1.7}, {"tgamma", tgamma, 25.3},
    {"rint", rint, 5.3},
};

static const struct {
  const char *name;
  function_2 *function;
  double x, y;
} functions_2[] = {
    {"+", sum, 0.7, 5.3},       {"*", product, 0.7, 5.3},
    {"/", quotient, 0.7, 5.3},  {"<", less, 0.7, 5.3},
    {"pow", pow, 0.7, 5.3},     {"atan2", atan2, 0.7, -5.3},
    {"hypot", hypot, 0.7, 5.3}, {"fmod", fmod, 5.3, 0.7},
    {"fmod", fmod, 1e300, 0.7}, {"remainder", remainder, 5.3, 0.7},
};

volatile double result;
volatile uint64_t result64;

int main(void) {
  unsigned cycles = 0;
  for (unsigned i = 0; i < sizeof functions_2 / sizeof functions_2[0]; i++) {
#pragma clang loop unroll(disable) /* the fourth call would be in code of its own, not yet in the cache */
    for (int round = 0; round < 4; round++) {
      function_2 *volatile function = functions_2[i].function;
      double x = functions_2[i].x, y = functions_2[i].y;
      unsigned start = trax_cycles();
      double value = function(x, y);
      cycles = trax_cycles() - start;
      result = value;
    }
    printf("%-10s %8g %8g %6u\n", functions_2[i].name, functions_2[i].x, functions_2[i].y, cycles);
  }
  for (unsigned i = 0; i < sizeof functions_1 / sizeof functions_1[0]; i++) {
#pragma clang loop unroll(disable) /* the fourth call would be in code of its own, not yet in the cache */
    for (int round = 0; round < 4; round++) {
      function_1 *volatile function = functions_1[i].function;
      double x = functions_1[i].argument;
      unsigned start = trax_cycles();
      double value = function(x);
      cycles = trax_cycles() - start;
      result = value;
    }
    printf("%-10s %8g          %6u\n", functions_1[i].name, functions_1[i].argument, cycles);
  }
  for (unsigned i = 0; i < sizeof divisions / sizeof divisions[0]; i++) {
#pragma clang loop unroll(disable)
    for (int round = 0; round < 4; round++) {
      uint64_t (*volatile function)(uint64_t, uint64_t) = divisions[i].function;
      uint64_t n = divisions[i].n, d = divisions[i].d;
      unsigned start = trax_cycles();
      uint64_t value = function(n, d);
      cycles = trax_cycles() - start;
      result64 = value;
    }
    printf("%-5s %20llu %12llu %5u\n", divisions[i].name, (unsigned long long)divisions[i].n,
           (unsigned long long)divisions[i].d, cycles);
  }
  return 0;
}
