/* Hashes of what the floating-point instructions give over numbered pairs (pairs.h), a line each. The same source
   twice: for the TP, where the instructions themselves execute, and the library's sqrtf; and for the host, where the
   oracle answers. sweep.py compares. WHICH is the special unit's precision. */
#include <stdio.h>
#include <stdlib.h>

#ifdef __trax__
#include <math.h>
#include <trax.h>
#else
#include "oracle.h"
#endif
#include "pairs.h"

#define BLOCK 64 /* pairs that a thread takes at a time */

#ifdef __trax__
#define ONE(name, instruction, reduced)                                                                                \
  static inline uint32_t do_##name(uint32_t a) {                                                                       \
    uint32_t result;                                                                                                   \
    __asm__ volatile(instruction " %0, %1" : "=r"(result) : "r"(a));                                                   \
    return result;                                                                                                     \
  }
#define TWO(name, instruction, reduced)                                                                                \
  static inline uint32_t do_##name(uint32_t a, uint32_t b) {                                                           \
    uint32_t result;                                                                                                   \
    __asm__ volatile(instruction " %0, %1, %2" : "=r"(result) : "r"(a), "r"(b));                                       \
    return result;                                                                                                     \
  }
static inline uint32_t do_sqrtf(uint32_t a) {
  float root = sqrtf(float_of(a));
  return root == root ? float_bits_of(root) : 0x7FC00000;
}
#else
static unsigned precision;
#define ONE(name, instruction, reduced)                                                                                \
  static inline uint32_t do_##name(uint32_t a) {                                                                       \
    return reduced ? oracle_reduce(oracle_##name(a), precision) : oracle_##name(a);                                    \
  }
#define TWO(name, instruction, reduced)                                                                                \
  static inline uint32_t do_##name(uint32_t a, uint32_t b) {                                                           \
    return reduced ? oracle_reduce(oracle_##name(a, b), precision) : oracle_##name(a, b);                              \
  }
static inline uint32_t do_sqrtf(uint32_t a) {
  return oracle_fsqrt_rounded(a);
}
#endif

/* Name, instruction, whether the special unit's precision counts. */
#define INSTRUCTIONS_OF_TWO(X)                                                                                         \
  X(fadd, "fadd", 0)                                                                                                   \
  X(fsub, "fsub", 0)                                                                                                   \
  X(fmul, "fmul", 0)                                                                                                   \
  X(fdiv, "fdiv", 1)                                                                                                   \
  X(fmin, "fmin", 0)                                                                                                   \
  X(fmax, "fmax", 0)                                                                                                   \
  X(feq, "feq", 0)                                                                                                     \
  X(flt, "flt", 0)                                                                                                     \
  X(fle, "fle", 0)
#define INSTRUCTIONS_OF_ONE(X)                                                                                         \
  X(frsqrt, "frsqrt", 1)                                                                                               \
  X(fcvt_w_s, "fcvt.w.s", 0)                                                                                           \
  X(fcvt_wu_s, "fcvt.wu.s", 0)                                                                                         \
  X(fcvt_s_w, "fcvt.s.w", 0)                                                                                           \
  X(fcvt_s_wu, "fcvt.s.wu", 0)
INSTRUCTIONS_OF_ONE(ONE)
INSTRUCTIONS_OF_TWO(TWO)

#define NAME(name, instruction, reduced) instruction,
static const char *const names[] = {INSTRUCTIONS_OF_TWO(NAME) INSTRUCTIONS_OF_ONE(NAME) "sqrtf"};
enum { OPERATIONS = COUNT(names) };

#define MOST_ROUTINES OPERATIONS
#include "../../numerics/sweep_main.h"

/* sqrtf follows a reduced unit in its last bits, so it counts at full precision only. */
static void sweep_block(const struct parameters *p, uint64_t first, uint32_t count, uint32_t *hashes) {
#ifndef __trax__
  precision = p->which;
#endif
  for (uint64_t number = first; number < first + count; number++) {
    struct pair pair = pair_of(number);
    uint32_t results[OPERATIONS];
    unsigned n = 0;
#define APPLY_TWO(name, instruction, reduced) results[n++] = do_##name(pair.a, pair.b);
#define APPLY_ONE(name, instruction, reduced) results[n++] = do_##name(pair.a);
    INSTRUCTIONS_OF_TWO(APPLY_TWO)
    INSTRUCTIONS_OF_ONE(APPLY_ONE)
    results[n] = p->which == 24 ? do_sqrtf(pair.a) : 0;
    for (n = 0; n < OPERATIONS; n++) {
      add(&hashes[n], results[n]);
      if (p->verbose)
        printf("%s %08lx of %08lx %08lx\n", names[n], (unsigned long)results[n], (unsigned long)pair.a,
               (unsigned long)pair.b);
    }
  }
}

static const char *const *routine_names(const struct parameters *p, int *count) {
  (void)p;
  *count = OPERATIONS;
  return names;
}
