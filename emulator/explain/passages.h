/* The way of passages from the engine to their readers. The engine's stretches are copied to chunks, which are read
   when they are full: by a thread of the host that does nothing else, if the run may use two, and else by the engine's.
   Both are faster than readers that are called for each stretch, since those and the engine need different data. */
#ifndef TRAX_EXPLAIN_PASSAGES_H
#define TRAX_EXPLAIN_PASSAGES_H

#include "explain/span.h"

/* A limit that readers find with this delay (trax_observer.single) must be set so much earlier. */
enum {
  TRAX_PASSAGES_CHUNKS = 4,
  TRAX_PASSAGES_INSTRUCTIONS = 1 << 14, /* in a chunk, with which it is full */
  TRAX_PASSAGES_CALLS = 800             /* the same of stretches of one instruction, as calls are */
};

/* NULL: out of memory. `read` is called for each passage, in the order of the stretches. */
struct trax_passages *trax_passages_create(struct trax_explain *explain,
                                           void (*read)(struct trax_explain *explain, struct trax_passage *passage));
/* Reads in a thread of its own from now on. Without one, as before. */
void trax_passages_start(struct trax_passages *passages);
void trax_passages_add(struct trax_passages *passages, const struct trax_stretch *stretch, struct trax_thread_log *log);
/* Returns when all has been read that was added. */
void trax_passages_finish(struct trax_passages *passages);
void trax_passages_destroy(struct trax_passages *passages); /* which may be NULL */

#endif
