/* A random case, and the engines' runs of it compared to the last count and byte. */
#ifndef TRAX_TIMING_CASES_H
#define TRAX_TIMING_CASES_H

#include "compare.h"

enum { MAX_WORDS = BODY + 64 };

struct random_case {
  struct trax_config config;
  uint32_t words[MAX_WORDS];
  size_t count;
  uint64_t max_cycles;  /* 0: no limit */
  bool one_thread;      /* others would get in its way */
  bool functional_mode; /* compared with the fast engine; else that with the reference */
};

/* The common results of equal runs. */
struct comparison {
  struct difference difference; /* "" if there is none */
  trax_status status;
  trax_fault_kind fault;
  uint64_t cycles, instructions;
};

/* Kinds of cases, chosen by seed % CASE_KINDS: any instruction with what belongs to it, races, races on machines near
   the defaults, threads with words of their own, words of any bits, the functional mode. */
enum case_kind {
  CASE_ISA,
  CASE_RACES,
  CASE_RACES_NEAR_DEFAULTS,
  CASE_OWN_WORDS,
  CASE_WORDS,
  CASE_FUNCTIONAL,
  CASE_KINDS
};
extern const char *const case_kind_names[CASE_KINDS];

/* What is compared with the reference: the fast engine or a variant of it (control/engines.h). */
extern const char *tested_engine;

struct random_case case_of_seed(unsigned seed);
struct comparison compare_case(const struct random_case *random_case);

#endif
