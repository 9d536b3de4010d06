/* Runs of random programs, and what must be the same of two of them. */
#ifndef TRAX_TIMING_COMPARE_H
#define TRAX_TIMING_COMPARE_H

#include "core/chip.h"
#include "generate.h"

enum { LOOKS = 64, LOOK_EVERY = 61 };

struct run {
  struct bench bench;
  char *output;
  size_t output_bytes;
  /* All counts as they were between cycles. */
  struct trax_tm_stats looks[LOOKS]; /* sums over the TMs */
  unsigned look_count;
};

/* Runs the words on the same random data each time. other may be NULL. */
struct run run_watched(const struct trax_config *config, const uint32_t *program, size_t count, trax_engine engine,
                       bool traced, uint64_t max_cycles, struct trax_watch *other);
struct run run(const struct trax_config *config, const uint32_t *program, size_t count, trax_engine engine, bool traced,
               uint64_t max_cycles);
void end(struct run *run);

void expect_same_issues(const struct bench_issues *a, const struct bench_issues *b);
/* Outcome, cycles, every count and charge, memory and output. */
void expect_same(const struct run *a, const struct run *b);

/* A number from the environment. */
unsigned setting(const char *name, unsigned otherwise);

#endif
