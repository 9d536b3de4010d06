/* Runs of random programs, and what must be the same of two of them. */
#ifndef TRAX_TIMING_COMPARE_H
#define TRAX_TIMING_COMPARE_H

#include "engine/run.h"
#include "generate.h"

enum { LOOKS = 64, LOOK_EVERY = 61 };

struct run {
  struct bench bench;
  char *output;
  size_t output_bytes;
  /* All counts as they were between cycles. */
  struct trax_tm_stats looks[LOOKS]; /* sums over the TMs */
  unsigned look_count;
  bool looked; /* or it ran alone */
  struct transfers {
    uint64_t count, bytes, hash, last_cycle;
    unsigned last_channel;
  } transfers; /* as a listener got them (machine/transfers.h) */
};

/* Runs the words on the same random data each time, on TRAX_HOST_THREADS host threads (environment; 1). other may be
   NULL. */
struct run run_watched(const struct trax_config *config, const uint32_t *program, size_t count, const char *engine,
                       bool traced, uint64_t max_cycles, struct trax_watch *other);
struct run run(const struct trax_config *config, const uint32_t *program, size_t count, const char *engine, bool traced,
               uint64_t max_cycles);
/* Nobody looks at it. */
struct run run_alone(const struct trax_config *config, const uint32_t *program, size_t count, const char *engine,
                     uint64_t max_cycles, unsigned host_threads);
/* The same with any options but the output. */
struct run run_with(const struct trax_config *config, const uint32_t *program, size_t count,
                    const trax_run_options *options);
/* With something done to the loaded machine before. */
struct run run_prepared(const struct trax_config *config, const uint32_t *program, size_t count,
                        const trax_run_options *options, void (*prepare)(void *context, struct trax_machine *machine),
                        void *context);
void end(struct run *run);

/* The difference of two runs, in words. */
struct difference {
  char text[512];
};
/* Functions return true if they have found and described a difference. */
__attribute__((format(printf, 2, 3))) bool differs(struct difference *to, const char *format, ...);
bool different_number(struct difference *to, const char *name, uint64_t x, uint64_t y);
bool different_bytes(struct difference *to, const char *name, const void *x, const void *y, size_t size);
/* Whether observers were told other charges of a thread: their causes, their order, or the registers waited for. */
bool different_charges(struct difference *to, const struct bench *a, const struct bench *b);
/* Reduces issues to what stretches have of them. */
void reduce_issues(struct bench_issues *issues);
bool different_issues(struct difference *to, const struct bench_issues *a, const struct bench_issues *b);
/* Outcome, cycles, every count and charge, memory and output. */
bool different_runs(struct difference *to, const struct run *a, const struct run *b);
/* Runs from their beginning: requests to off-chip memory, in order. */
bool different_transfers(struct difference *to, const struct run *a, const struct run *b);
/* Of them what does not depend on time: instructions, exit statuses, memory and output. */
bool different_effects(struct difference *to, const struct run *a, const struct run *b);

void expect_same(const struct run *a, const struct run *b);

/* A number from the environment. */
unsigned setting(const char *name, unsigned otherwise);

#endif
