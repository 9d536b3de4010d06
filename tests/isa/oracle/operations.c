#include "operations.h"

#include "oracle.h"
#include "pairs.h"
#include "trax/semantics.h"

float rt_sqrtf(float x); /* the TP's library, compiled for the host */

void add_difference(struct differences *differences, struct difference one) {
  unsigned place = differences->count < MOST_KEPT ? (unsigned)differences->count : MOST_KEPT;
  differences->count++;
  while (place > 0 && differences->kept[place - 1].number > one.number) {
    if (place < MOST_KEPT)
      differences->kept[place] = differences->kept[place - 1];
    place--;
  }
  if (place < MOST_KEPT)
    differences->kept[place] = one;
}

/* Every word once, with all upper halves for each lower one: 0 and the 63 about it first, where exponents and exact
   numbers meet, then the others, spread. So few cases see every boundary and some of everything. */
static inline uint32_t word_of(uint64_t number) {
  const uint32_t near = 64, rest = 65536 - near;
  uint32_t upper = (uint32_t)number << 16, turn = (uint32_t)number >> 16;
  uint32_t about_zero = turn & 1 ? 0 - (turn + 1) / 2 : turn / 2;
  uint32_t lower = turn < near ? about_zero : near / 2 + (turn - near) * 40009 % rest; /* a prime */
  return upper + lower;
}

#define COMPARE(name, operands, result, oracle)                                                                        \
  static void compare_##name(uint64_t first, uint64_t count, struct differences *found) {                              \
    for (uint64_t number = first; number < first + count; number++) {                                                  \
      struct pair p = operands;                                                                                        \
      uint32_t ours = result, theirs = oracle;                                                                         \
      if (ours != theirs)                                                                                              \
        add_difference(found, (struct difference){number, p.a, p.b, ours, theirs});                                    \
    }                                                                                                                  \
  }
#define COMPARE_ONE(name) COMPARE(name, ((struct pair){word_of(number), 0}), trax_##name(p.a), oracle_##name(p.a))
#define COMPARE_TWO(name) COMPARE(name, pair_of(number), trax_##name(p.a, p.b), oracle_##name(p.a, p.b))

COMPARE_ONE(frsqrt)
COMPARE_ONE(fcvt_w_s)
COMPARE_ONE(fcvt_wu_s)
COMPARE_ONE(fcvt_s_w)
COMPARE_ONE(fcvt_s_wu)
/* A function may return its operand's NaN, with unspecified bits. */
COMPARE(sqrtf, ((struct pair){word_of(number), 0}), trax_canonical(rt_sqrtf(trax_to_float(p.a))),
        oracle_fsqrt_rounded(p.a))

/* Values for units of 1 to 24 bits (b of the pair): first, in every binade, the fractions at both its edges, and those
   halfway between two results and next to that; then all fractions of the first, middle and last binades. */
static const uint8_t whole_binades[] = {0, 1, 2, 126, 127, 128, 253, 254, 255};
enum {
  WIDTHS = 24,
  BINADES = 2 * 256, /* with either sign */
  EDGES = BINADES * 2 * 64,
  TIES = BINADES * 23 * 2 * 3,
  WHOLE = 2 * (int)COUNT(whole_binades) << 23,
  VALUES = EDGES + TIES + WHOLE
};

static struct pair value_and_width(uint64_t number) {
  uint32_t index = (uint32_t)(number / WIDTHS), binade = index % BINADES << 23;
  struct pair p = {0, 1 + (uint32_t)(number % WIDTHS)};
  if (index < EDGES) {
    uint32_t near = index / BINADES / 2;
    p.a = binade | (index / BINADES % 2 ? FRACTION_BITS - near : near);
  } else if (index < EDGES + TIES) {
    index = (index - EDGES) / BINADES;
    uint32_t step = 1 + index % 3, half = (uint32_t)1 << (index / 6), even = index / 3 % 2 * 2 * half;
    uint64_t state = number / WIDTHS;
    uint32_t above = (uint32_t)random64(&state) & FRACTION_BITS & ~(4 * half - 1);
    p.a = (binade | above | ((even | half) & FRACTION_BITS)) + step - 2;
  } else {
    index = (uint32_t)((uint64_t)(index - EDGES - TIES) * 0x9E3779B1u % WHOLE); /* a prime: all, and runs are spread */
    p.a = index << 31 | (uint32_t)whole_binades[index >> 24] << 23 | (index >> 1 & FRACTION_BITS);
  }
  return p;
}
COMPARE(reduce, value_and_width(number), trax_reduce_precision(p.a, p.b), oracle_reduce(p.a, p.b))

COMPARE_TWO(fadd)
COMPARE_TWO(fsub)
COMPARE_TWO(fmul)
COMPARE_TWO(fdiv)
COMPARE_TWO(fmin)
COMPARE_TWO(fmax)
COMPARE_TWO(feq)
COMPARE_TWO(flt)
COMPARE_TWO(fle)

#define WORDS "all words"
#define PAIRS "pairs"
const struct operation operations[] = {
    {"frsqrt", 1, WORDS, (uint64_t)1 << 32, compare_frsqrt},
    {"fcvt.w.s", 1, WORDS, (uint64_t)1 << 32, compare_fcvt_w_s},
    {"fcvt.wu.s", 1, WORDS, (uint64_t)1 << 32, compare_fcvt_wu_s},
    {"fcvt.s.w", 1, WORDS, (uint64_t)1 << 32, compare_fcvt_s_w},
    {"fcvt.s.wu", 1, WORDS, (uint64_t)1 << 32, compare_fcvt_s_wu},
    {"sqrtf", 1, WORDS, (uint64_t)1 << 32, compare_sqrtf},
    {"reduce", 2, "values, each to 1 to 24 bits", (uint64_t)VALUES *WIDTHS, compare_reduce},
    {"fadd", 2, PAIRS, 0, compare_fadd},
    {"fsub", 2, PAIRS, 0, compare_fsub},
    {"fmul", 2, PAIRS, 0, compare_fmul},
    {"fdiv", 2, PAIRS, 0, compare_fdiv},
    {"fmin", 2, PAIRS, 0, compare_fmin},
    {"fmax", 2, PAIRS, 0, compare_fmax},
    {"feq", 2, PAIRS, 0, compare_feq},
    {"flt", 2, PAIRS, 0, compare_flt},
    {"fle", 2, PAIRS, 0, compare_fle},
};
const unsigned operation_count = COUNT(operations);
