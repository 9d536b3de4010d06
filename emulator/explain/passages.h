/* The way of passages from the engine to their readers. The engine's stretches are copied to a log of each TM, to which
   a thread of the host may add while others add to those of other TMs. When the logs are full, or the engine no longer
   goes back behind what is in them (trax_observer.keep), they are read in the order of their cycles and TMs
   (explain/reading.h). */
#ifndef TRAX_EXPLAIN_PASSAGES_H
#define TRAX_EXPLAIN_PASSAGES_H

#include "explain/reading.h"

/* The instructions in the logs with which they are full, where each stretch counts as 64 more: few while a reader finds
   much that is new (trax_explain.found), since it finds a limit (trax_observer.single) with this delay. */
enum { TRAX_PASSAGES_FEW = 1 << 16, TRAX_PASSAGES_MANY = 3 << 19 };
/* With stories, passages stay where they are for so many rounds of reading, trax_explain.round being the present one.
 */
enum { TRAX_PASSAGES_ROUNDS = 4 };

/* NULL: out of memory. */
struct trax_passages *trax_passages_create(struct trax_explain *explain);
/* trax_reading_start */
bool trax_passages_start(struct trax_passages *passages, struct trax_pool *pool);
/* trax_observer.room */
void *trax_passages_room(struct trax_passages *passages, uint32_t tm);
void trax_passages_add(struct trax_passages *passages, const struct trax_stretch *stretch, struct trax_thread_log *log);
/* Keeps all additions so far; they may be read at once. holds: later additions are not read before the next call, and
   trax_passages_go_back removes them. */
void trax_passages_keep(struct trax_passages *passages, bool holds);
/* Reads all that has been added; it is not held. */
void trax_passages_finish(struct trax_passages *passages);
/* Gives the counts of all that has been read to the readers. */
void trax_passages_end(struct trax_passages *passages);
void trax_passages_go_back(struct trax_passages *passages);
void trax_passages_destroy(struct trax_passages *passages); /* which may be NULL */

#endif
