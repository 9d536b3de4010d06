/* The reading of passages: each reader reads all of them, and what readers want to know of each instruction is counted
   for all of them at once (explain/tally.h). Several threads of the host run several readers at the same time. */
#ifndef TRAX_EXPLAIN_READING_H
#define TRAX_EXPLAIN_READING_H

#include "explain/span.h"

struct trax_pool;
struct trax_reading;

/* The passages of a TM in their order, in runs, of which each but the last one ends with a single instruction. */
struct trax_read_log {
  struct trax_passage *const *passages; /* [count] */
  size_t count;
  const struct trax_read_run {
    uint64_t cycle; /* of its last passage */
    size_t end;     /* the number of the next run's first passage */
  } *runs;          /* [run_count] */
  size_t run_count;
};

struct trax_reading *trax_reading_create(struct trax_explain *explain); /* NULL: out of memory */
void trax_reading_destroy(struct trax_reading *reading);                /* which may be NULL */
/* Reads with these threads of the host from now on; NULL: with one. The readers are open. False: out of memory. */
bool trax_reading_start(struct trax_reading *reading, struct trax_pool *pool);
/* Returns the logs, [tms], to be set before the next call. */
struct trax_read_log *trax_reading_logs(struct trax_reading *reading);
/* Reads the passages of all logs, run by run, in the order of their cycles and TMs. */
void trax_reading_read(struct trax_reading *reading);
/* Gives all counts to the readers. */
void trax_reading_flush(struct trax_reading *reading);

#endif
