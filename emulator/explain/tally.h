/* The counts of all passages: the executions of each instruction, its refusals and its accesses, by the call chain and
   the kind of ray of its thread. Readers take them from here, so that a passage's instructions are visited once. */
#ifndef TRAX_EXPLAIN_TALLY_H
#define TRAX_EXPLAIN_TALLY_H

#include "explain/objects.h"
#include "explain/span.h"

enum { TRAX_TALLY_CONTEXTS = 64 /* the first contexts; passages of others are added alone */ };

struct trax_tally;

struct trax_tally *trax_tally_create(struct trax_explain *explain); /* NULL: out of memory */
void trax_tally_destroy(struct trax_tally *tally);                  /* which may be NULL */
/* Adds a passage of one of the first contexts. Threads of the host may add to different tallies. */
void trax_tally_add(struct trax_tally *tally, const struct trax_passage *passage);
/* Gives the counts of a single passage to the readers. As the following ones, one thread calls it. */
void trax_tally_add_alone(const struct trax_tally *tally, const struct trax_passage *passage);
/* Gives the accesses to which the tally does not add any more. */
void trax_tally_drain(struct trax_tally *tally);
/* Gives all counts, and begins anew. They have 32 bits, so no more than 2^32 thread-cycles may pass between two calls.
 */
void trax_tally_flush(struct trax_tally *tally);

#endif
