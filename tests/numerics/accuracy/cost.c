/* Cycles of each binary32 function on one TP, the call through a pointer included; accuracy.py compiles and runs it.
   Operands are drawn evenly from the interval of functions.h. Each call is made twice, and the second counts, so that
   code and tables are in the caches. Prints a line per function: name, least, mean and greatest number of cycles. */
#include <math.h>
#include <stdio.h>
#include <trax.h>

#include "adapted.h"
#include "functions.h"

enum { OPERANDS = 256 };

struct cost {
  unsigned least, greatest, sum;
};

static unsigned state;

static float draw(float low, float high) {
  state = state * 1664525u + 1013904223u; /* Knuth's constants */
  return low + (high - low) * ((float)(state >> 8) * 0x1p-24f);
}

static void add(struct cost *cost, unsigned cycles) {
  cost->sum += cycles;
  cost->least = cycles < cost->least ? cycles : cost->least;
  cost->greatest = cycles > cost->greatest ? cycles : cost->greatest;
}

static void print(const char *name, const struct cost *cost) {
  printf("%s %u %.1f %u\n", name, cost->least, (double)cost->sum / OPERANDS, cost->greatest);
}

volatile float result;

/* The last call would get code of its own, not in the cache yet, if the loops were unrolled. */
#define MEASURE(name, low, high, call)                                                                                 \
  static __attribute__((noinline)) void measure_##name(void) {                                                         \
    struct cost cost = {~0u, 0, 0};                                                                                    \
    state = 1;                                                                                                         \
    _Pragma("clang loop unroll(disable)") for (int i = 0; i < OPERANDS; i++) {                                         \
      float x = draw(low, high), y = draw(low, high), z = draw(low, high);                                             \
      unsigned cycles = 0;                                                                                             \
      _Pragma("clang loop unroll(disable)") for (int round = 0; round < 2; round++) {                                  \
        unsigned start = trax_cycles();                                                                                \
        float value = call;                                                                                            \
        __asm__ volatile("add r0, %0, r0" : : "r"(value)); /* when the result is there */                              \
        cycles = trax_cycles() - start;                                                                                \
        result = value;                                                                                                \
      }                                                                                                                \
      add(&cost, cycles);                                                                                              \
      (void)y, (void)z;                                                                                                \
    }                                                                                                                  \
    print(#name, &cost);                                                                                               \
  }
#define PLAIN_1(name, host, exact, low, high)                                                                          \
  static float (*volatile pointer_##name)(float) = name;                                                               \
  MEASURE(name, low, high, pointer_##name(x))
#define PLAIN_2(name, host, exact, low, high)                                                                          \
  static float (*volatile pointer_##name)(float, float) = name;                                                        \
  MEASURE(name, low, high, pointer_##name(x, y))
#define PLAIN_3(name, host, exact, low, high)                                                                          \
  static float (*volatile pointer_##name)(float, float, float) = name;                                                 \
  MEASURE(name, low, high, pointer_##name(x, y, z))
#define ADAPTED_1(name, host, exact, low, high)                                                                        \
  static float (*volatile pointer_##name)(float) = adapted_##name;                                                     \
  MEASURE(name, low, high, pointer_##name(x))
#define ADAPTED_2(name, host, exact, low, high)                                                                        \
  static float (*volatile pointer_##name)(float, float) = adapted_##name;                                              \
  MEASURE(name, low, high, pointer_##name(x, y))
EXACT_FUNCTIONS(PLAIN_1)
ADAPTED_FUNCTIONS(ADAPTED_1)
TRANSCENDENTAL_FUNCTIONS(PLAIN_1)
EXACT_PAIRS(PLAIN_2)
ADAPTED_PAIRS(ADAPTED_2)
TRANSCENDENTAL_PAIRS(PLAIN_2)
TRIPLES(PLAIN_3)

#define RUN(name, host, exact, low, high) measure_##name();

int main(void) {
  EXACT_FUNCTIONS(RUN)
  ADAPTED_FUNCTIONS(RUN)
  TRANSCENDENTAL_FUNCTIONS(RUN)
  EXACT_PAIRS(RUN)
  ADAPTED_PAIRS(RUN)
  TRANSCENDENTAL_PAIRS(RUN)
  TRIPLES(RUN)
  return 0;
}
