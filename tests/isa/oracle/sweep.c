/* Hashes of what the floating-point instructions give over numbered pairs (pairs.h), a line each. The same source
   twice: for the TP, where the instructions themselves execute, and the library's sqrtf; and for the host, where the
   oracle answers. sweep.py compares. Told FIRST COUNT BITS VERBOSE: pairs from which number on, how many, the special
   unit's precision, whether to print every result. */
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

static void add(uint32_t *hash, uint32_t value) {
  uint32_t h = (*hash ^ value) * 0x9E3779B1u;
  *hash = h ^ h >> 15;
}

/* sqrtf follows a reduced unit in its last bits, so it counts at full precision only. */
static void sweep_block(uint64_t first, uint32_t count, uint32_t bits, uint32_t verbose, uint32_t *hashes) {
  for (uint64_t number = first; number < first + count; number++) {
    struct pair p = pair_of(number);
    uint32_t results[OPERATIONS];
    unsigned n = 0;
#define APPLY_TWO(name, instruction, reduced) results[n++] = do_##name(p.a, p.b);
#define APPLY_ONE(name, instruction, reduced) results[n++] = do_##name(p.a);
    INSTRUCTIONS_OF_TWO(APPLY_TWO)
    INSTRUCTIONS_OF_ONE(APPLY_ONE)
    results[n] = bits == 24 ? do_sqrtf(p.a) : 0;
    for (n = 0; n < OPERATIONS; n++) {
      add(&hashes[n], results[n]);
      if (verbose)
        printf("%s %08lx of %08lx %08lx\n", names[n], (unsigned long)results[n], (unsigned long)p.a,
               (unsigned long)p.b);
    }
  }
}

/* Blocks come in any order: each has a factor of its own in the sum. */
static void add_block(uint64_t first, const uint32_t *hashes, uint64_t *sums) {
  for (unsigned i = 0; i < OPERATIONS; i++)
    sums[i] += (uint64_t)hashes[i] * (2 * first + 1);
}

static void print_sums(const uint64_t *sums) {
  for (unsigned i = 0; i < OPERATIONS; i++)
    printf("%s %016llx\n", names[i], (unsigned long long)sums[i]);
}

struct parameters {
  uint32_t first, count, bits, verbose;
};

#ifdef __trax__

#define MOST_THREADS 64

struct trax_buffer parameters;
static uint32_t hashes[MOST_THREADS][OPERATIONS];
static uint64_t sums[MOST_THREADS][OPERATIONS];
static unsigned next_block, finished;

int main(void) {
  const struct parameters *p = parameters.data;
  unsigned thread = trax_thread(), threads = trax_threads();
  if (threads > MOST_THREADS)
    abort();
  for (;;) {
    uint32_t done = trax_atomic_inc(&next_block) * BLOCK;
    if (done >= p->count)
      break;
    uint64_t first = (uint64_t)p->first + done;
    for (unsigned i = 0; i < OPERATIONS; i++)
      hashes[thread][i] = 0;
    sweep_block(first, p->count - done < BLOCK ? p->count - done : BLOCK, p->bits, p->verbose, hashes[thread]);
    add_block(first, hashes[thread], sums[thread]);
  }
  if (trax_atomic_inc(&finished) != threads - 1)
    return 0;
  for (unsigned t = 1; t < threads; t++)
    for (unsigned i = 0; i < OPERATIONS; i++)
      sums[0][i] += sums[t][i];
  if (!p->verbose)
    print_sums(sums[0]);
  return 0;
}

#else

int main(int argc, char **argv) {
  uint32_t numbers[4] = {0};
  if (argc != 5) {
    fprintf(stderr, "usage: isa-oracle-sweep FIRST COUNT BITS VERBOSE\n");
    return 1;
  }
  for (int i = 0; i < 4; i++)
    numbers[i] = (uint32_t)strtoul(argv[i + 1], NULL, 10);
  struct parameters p = {numbers[0], numbers[1], numbers[2], numbers[3]};
  precision = p.bits;
  uint64_t sums[OPERATIONS] = {0};
  for (uint32_t done = 0; done < p.count; done += BLOCK) {
    uint32_t hashes[OPERATIONS] = {0};
    uint64_t first = (uint64_t)p.first + done;
    sweep_block(first, p.count - done < BLOCK ? p.count - done : BLOCK, p.bits, p.verbose, hashes);
    add_block(first, hashes, sums);
  }
  if (!p.verbose)
    print_sums(sums);
  return 0;
}

#endif
