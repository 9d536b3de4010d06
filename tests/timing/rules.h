/* One small program for each rule of docs/timing.md, with what follows from that rule by hand. */
#ifndef TRAX_TIMING_RULES_H
#define TRAX_TIMING_RULES_H

#include "bench.h"

enum { RULE_WORDS = 40 };

struct rule {
  const char *chapter, *rule; /* of the page */
  enum { NEAR, FAR } base;    /* bench_near, bench_far, of one TP */
  const char *set;            /* keys and values that differ, as for --set, with blanks between */
  uint64_t cycles;            /* the run's length */
  trax_fault_kind fault;
  const char *issues;  /* cycles of each thread's issues, with / between threads; NULL: not written down */
  const char *charges; /* thread-cycles of all threads together, cause=cycles; those not named are 0, but for "issued"
                          and "halted" */
  const char *counts;  /* counters and words of memory that are checked besides; NULL: none */
  bool is_unlisted;    /* the page does not have it */
  size_t count;
  uint32_t words[RULE_WORDS];
};

/* rules[rule_count], in the order of the page. Encoded when called first. */
const struct rule *timing_rules(size_t *count);

#endif
