/* Hashes of the emulator's arithmetic over numbered pairs, a line an operation: what every compiler, level and
   processor must agree on. With BUILDS_ORACLE the answers are the oracle's. Operations on results of others, which a
   compiler could merge, are among them. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#ifdef BUILDS_ORACLE
#include "oracle.h"
#define DO(name) oracle_##name
#define REDUCE oracle_reduce
#else
#include "trax/semantics.h"
#define DO(name) trax_##name
#define REDUCE trax_reduce_precision
#endif
#include "pairs.h"

#ifdef BUILDS_MERGEABLE
#define MULTIPLY_ADD(a, b, c) trax_canonical(trax_to_float(a) * trax_to_float(b) + trax_to_float(c))
#else
#define MULTIPLY_ADD(a, b, c) DO(fadd)(DO(fmul)(a, b), c)
#endif

#define OPERATIONS(X)                                                                                                  \
  X(fadd, DO(fadd)(a, b))                                                                                              \
  X(fsub, DO(fsub)(a, b))                                                                                              \
  X(fmul, DO(fmul)(a, b))                                                                                              \
  X(fdiv, DO(fdiv)(a, b))                                                                                              \
  X(fmin, DO(fmin)(a, b))                                                                                              \
  X(fmax, DO(fmax)(a, b))                                                                                              \
  X(feq, DO(feq)(a, b))                                                                                                \
  X(flt, DO(flt)(a, b))                                                                                                \
  X(fle, DO(fle)(a, b))                                                                                                \
  X(frsqrt, DO(frsqrt)(a))                                                                                             \
  X(fcvt_w_s, DO(fcvt_w_s)(a))                                                                                         \
  X(fcvt_wu_s, DO(fcvt_wu_s)(a))                                                                                       \
  X(fcvt_s_w, DO(fcvt_s_w)(a))                                                                                         \
  X(fcvt_s_wu, DO(fcvt_s_wu)(a))                                                                                       \
  X(reduce, REDUCE(a, 1 + b % 24))                                                                                     \
  X(multiply_add, MULTIPLY_ADD(a, b, c))                                                                               \
  X(multiply_subtract, DO(fsub)(DO(fmul)(a, b), c))                                                                    \
  X(sum_of_sums, DO(fsub)(DO(fadd)(a, b), a))                                                                          \
  X(quotient_of_product, DO(fdiv)(DO(fmul)(a, b), b))                                                                  \
  X(product_of_quotient, DO(fmul)(DO(fdiv)(a, b), b))                                                                  \
  X(root_of_root, DO(frsqrt)(DO(frsqrt)(a)))                                                                           \
  X(converted_twice, DO(fcvt_s_w)(DO(fcvt_w_s)(a)))

/* Each is a function of its own, so that none shares a product with another that would then not be merged. */
#define FUNCTION(name, expression)                                                                                     \
  static __attribute__((noinline)) uint32_t do_##name(uint32_t a, uint32_t b, uint32_t c) {                            \
    (void)b, (void)c;                                                                                                  \
    return expression;                                                                                                 \
  }
OPERATIONS(FUNCTION)

#define NAME(name, expression) #name,
static const char *const names[] = {OPERATIONS(NAME)};

int main(int argc, char **argv) {
  uint64_t hashes[COUNT(names)] = {0}, count = argc == 2 ? strtoull(argv[1], NULL, 10) : 0;
  if (count == 0) {
    fprintf(stderr, "usage: builds PAIRS\n");
    return 1;
  }
  for (uint64_t number = 0; number < count; number++) {
    struct pair p = pair_of(number);
    uint32_t a = p.a, b = p.b, c = pair_of(number + 1).a;
    unsigned n = 0;
#define ADD(name, expression)                                                                                          \
  hashes[n] = (hashes[n] ^ do_##name(a, b, c)) * 0x9E3779B97F4A7C15u;                                                  \
  hashes[n] ^= hashes[n] >> 29;                                                                                        \
  n++;
    OPERATIONS(ADD)
  }
  for (unsigned n = 0; n < COUNT(names); n++)
    printf("%s %016" PRIx64 "\n", names[n], hashes[n]);
  return 0;
}
