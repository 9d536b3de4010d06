/* A random program in the emulator's engines and in the model of the manual, and the difference of their results. */
#ifndef TRAX_ISA_DIFFERENTIAL_CASE_H
#define TRAX_ISA_DIFFERENTIAL_CASE_H

#include "compare.h" /* tests/timing: differences in words */
#include "model.h"
#include "program.h"

struct differential_case {
  enum program_kind kind;
  struct trax_config config;
  uint32_t words[MOST_WORDS];
  size_t count, prologue; /* words; the first so many set up the threads */
  uint64_t data_seed;
};

struct differential_outcome {
  struct difference difference; /* "" if there is none */
  bool unended;                 /* the model came to its limit, and nothing was compared */
  enum model_fault_kind fault;
  uint64_t instructions;
  uint64_t executed[TRAX_OP_COUNT]; /* by the reference engine */
};

/* Everything follows from the seed. */
void differential_case_of_seed(struct differential_case *c, unsigned seed);
void differential_compare(const struct model_isa *isa, const struct differential_case *c,
                          struct differential_outcome *outcome);

/* Takes away instructions and threads as long as anything still differs. */
void differential_minimise(const struct model_isa *isa, struct differential_case *c);
void differential_print(const struct differential_case *c, FILE *out);

#endif
