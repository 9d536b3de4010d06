/* The reading of passages: each reader reads all of them, and what readers want to know of each instruction is counted
   for all of them at once (explain/tally.h). Several threads of the host run several readers at the same time. */
#ifndef TRAX_EXPLAIN_READING_H
#define TRAX_EXPLAIN_READING_H

#include "explain/span.h"

struct trax_reading;

struct trax_reading *trax_reading_create(struct trax_explain *explain); /* NULL: out of memory */
void trax_reading_destroy(struct trax_reading *reading);                /* which may be NULL */
/* Reads with so many threads of the host from now on. The readers are open. False: out of memory. */
bool trax_reading_start(struct trax_reading *reading, unsigned threads);
/* Passages that should be read at once: with one thread few, which stay in its caches. */
size_t trax_reading_batch(const struct trax_reading *reading);
/* Reads passages, which are in the order of the chip. */
void trax_reading_read(struct trax_reading *reading, struct trax_passage *const *passages, size_t count);
/* Gives counts to the readers: some, after all passages up to a cycle have been read; and all. */
void trax_reading_drain(struct trax_reading *reading, uint64_t cycle);
void trax_reading_flush(struct trax_reading *reading);

#endif
