/* The quanta of an epoch, and the threads of the host that simulate them. With several threads a quantum has half a
   latency, and a TM may begin the next one before the requests of this one are served. So threads seldom wait for each
   other, although their TMs take different times. With one thread it has a whole latency. */
#ifndef TRAX_FAST_QUANTA_H
#define TRAX_FAST_QUANTA_H

#include "fast/merge.h"

struct trax_quanta;

/* latency: the least number of cycles from a request to its completion. NULL: out of memory. */
struct trax_quanta *trax_quanta_create(struct trax_chip *chip, struct trax_merge *merge, unsigned threads,
                                       uint64_t latency);
void trax_quanta_destroy(struct trax_quanta *quanta); /* may be NULL */

/* Begins an epoch of the cycles from `begin` to `end`. */
void trax_quanta_begin(struct trax_quanta *quanta, uint64_t begin, uint64_t end);
/* Simulates quanta, and serves their requests, until the epoch is over or has failed. Several threads do so at once,
   each with another TM, `first`, that it begins with. */
void trax_quanta_run(struct trax_quanta *quanta, uint32_t first);

#endif
