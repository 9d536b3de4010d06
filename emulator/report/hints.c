/* Hints: limits of a run that its figures prove, each with the page that explains it. */
#include "machine/timing.h"
#include "report/statistics.h"

/* A shorter run says little: programs and data are loaded, and threads begin and end. */
enum { LEAST_CYCLES = 10000 };

/* The figures that the rules are about, as shares. */
struct figures {
  double adders, multipliers, special, memory; /* busy */
  double not_sums;                             /* of the adders' operations: comparisons, minima, conversions */
  double cause[TRAX_CAUSE_COUNT];              /* of the thread-cycles */
};

static double share(double part, double whole) {
  return whole > 0 ? part / whole : 0;
}

static struct figures figures_of(const struct trax_stats *S, const struct trax_config *C) {
  const double cycles = (double)S->cycles * C->chip.tms, thread_cycles = (double)S->threads * (double)S->cycles;
  struct figures figures = {.memory = share((double)S->memory.bytes / TRAX_SECONDS(S, C) / 1e9, trax_memory_gbps(C))};
#define BUSY(UNIT, OPERATIONS)                                                                                         \
  share(trax_shared_cycles(UNIT, C, &S->total, OPERATIONS), cycles *trax_shared_units(UNIT, C))
  figures.adders = BUSY(TRAX_SHARED_FP_ADD, S->total.fp_add_ops);
  figures.multipliers = BUSY(TRAX_SHARED_FP_MUL, S->total.fp_mul_ops);
  figures.special = BUSY(TRAX_SHARED_SPECIAL, S->total.special_ops);
#undef BUSY
  uint64_t not_sums = 0;
  for (unsigned op = 1; op < TRAX_OP_COUNT; op++)
    if (trax_timing_of(op, C).unit == TRAX_SHARED_FP_ADD && trax_class_of(op) != TRAX_CLASS_FP_ADD)
      not_sums += S->total.instructions[op];
  figures.not_sums = share((double)not_sums, (double)S->total.fp_add_ops);
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    figures.cause[cause] = share((double)S->total.cycles[cause], thread_cycles);
  return figures;
}

#define PERCENT(SHARE) (100 * (SHARE))
#define CAUSE(ID) F.cause[TRAX_CAUSE_##ID]

/* The rules: condition, page, text and its values. F: the figures, C: the configuration. */
/* clang-format off */
#define TRAX_HINTS(H)                                                                                                                    \
  H(F.adders >= 0.9 && F.multipliers <= F.adders - 0.25 && F.not_sums >= 0.25, "docs/timing.md, \"Units\"",                              \
    "The adders are %.0f %% busy, the multipliers %.0f %%. %.0f %% of the adders' operations are comparisons, minima, maxima and\n"      \
    "    conversions: floats can be compared as integers, and fpu.compare_units gives each TP a unit for them.",                         \
    PERCENT(F.adders), PERCENT(F.multipliers), PERCENT(F.not_sums))                                                                      \
  H(F.adders >= 0.9 && F.multipliers <= F.adders - 0.25 && F.not_sums < 0.25, "docs/timing.md, \"Units\"",                               \
    "The adders are %.0f %% busy, the multipliers %.0f %%: fpu.adders_per_cluster gives each cluster more adders.",                      \
    PERCENT(F.adders), PERCENT(F.multipliers))                                                                                           \
  H(F.multipliers >= 0.9 && F.adders <= F.multipliers - 0.25, "docs/timing.md, \"Units\"",                                               \
    "The multipliers are %.0f %% busy, the adders %.0f %%: fpu.multipliers_per_cluster gives each cluster more multipliers.",            \
    PERCENT(F.multipliers), PERCENT(F.adders))                                                                                           \
  H(F.special >= 0.9, "docs/timing.md, \"Units\"",                                                                                       \
    "The FPDIV/iSQRT units are %.0f %% busy: special.units_per_tm gives each TM more.", PERCENT(F.special))                              \
  H(F.memory >= 0.9, "docs/timing-memory.md, \"Memory controller\"",                                                                     \
    "Off-chip memory is busy for %.0f %% of the time: more threads or units cannot make this run faster, fewer bytes can.",              \
    PERCENT(F.memory))                                                                                                                   \
  H(CAUSE(MEMORY_QUEUE) >= 0.1, "docs/timing-memory.md, \"Memory queue\"",                                                               \
    "For %.0f %% of the thread-cycles no miss register or place in the memory queue is free (dcache.mshrs, memory.queue_depth).",        \
    PERCENT(CAUSE(MEMORY_QUEUE)))                                                                                                        \
  H(CAUSE(ICACHE_MISS) >= 0.1, "docs/timing.md, \"Fetch\"",                                                                              \
    "For %.0f %% of the thread-cycles an instruction's line is on its way: the code that runs does not stay in the instruction\n"        \
    "    caches of %u bytes.", PERCENT(CAUSE(ICACHE_MISS)), (unsigned)C->icache.bytes)                                                   \
  H(CAUSE(DATA_ATOMIC) >= 0.1, "docs/parallel.md, \"Costs\"",                                                                            \
    "For %.0f %% of the thread-cycles threads wait for atomic increments: take several items with one.", PERCENT(CAUSE(DATA_ATOMIC)))    \
  H(CAUSE(HALTED) >= 0.25, "docs/explaining.md, \"By item and by ray\"",                                                                 \
    "For %.0f %% of the thread-cycles threads have ended while others run: work is not divided evenly, or the last items are long.",     \
    PERCENT(CAUSE(HALTED)))
/* clang-format on */

void trax_hints_print(const struct trax_stats *S, const struct trax_config *C, FILE *out) {
  if (S->cycles < LEAST_CYCLES)
    return;
  const struct figures F = figures_of(S, C);
  bool any = false;
#define HINT(CONDITION, PAGE, ...)                                                                                     \
  if (CONDITION) {                                                                                                     \
    fputs(any ? "  - " : "\nHints\n  - ", out);                                                                        \
    fprintf(out, __VA_ARGS__);                                                                                         \
    fprintf(out, "\n    (%s)\n", PAGE);                                                                                \
    any = true;                                                                                                        \
  }
  TRAX_HINTS(HINT)
#undef HINT
}
