/* The order of accesses by different threads, as vector clocks (Flanagan and Freund, "FastTrack", PLDI 2009).

   A thread's accesses up to a `fence w` happen before those of another thread after a `fence r`, if in between the
   first has stored a word that the second has loaded past the cache, or incremented. A fence w makes a release: a copy
   of the thread's clock, which its later stores leave at their words. Releases that differ only in the thread's own
   part share a copy. */
#ifndef TRAX_EXPLAIN_CLOCKS_H
#define TRAX_EXPLAIN_CLOCKS_H

#include "trax/emulator.h"

struct trax_clocks {
  uint32_t threads;
  struct trax_thread_clock *thread; /* [threads] */
  bool out_of_memory;               /* something was lost */
};

struct trax_release;

trax_status trax_clocks_open(struct trax_clocks *clocks, uint32_t threads, trax_error *error);
void trax_clocks_close(struct trax_clocks *clocks); /* also after an error */

/* The thread's own time, from 1. A `fence w` advances it. */
uint32_t trax_clock_of(const struct trax_clocks *clocks, uint32_t thread);
/* Whether an access of another thread at its time `clock` happens before what the thread does now. Its own do. */
bool trax_clocks_know(const struct trax_clocks *clocks, uint32_t thread, uint32_t other, uint32_t clock);

void trax_clocks_fence(struct trax_clocks *clocks, uint32_t thread, int32_t kind);
/* A store to a word, whose release is *word; NULL: it has none. */
void trax_clocks_store(struct trax_clocks *clocks, uint32_t thread, struct trax_release **word);
/* A store to a part of a word, or an increment: the word keeps its release, too. */
void trax_clocks_add(struct trax_clocks *clocks, uint32_t thread, struct trax_release **word);
/* A load past the cache, or the arrival of an increment's old value. */
void trax_clocks_load(struct trax_clocks *clocks, uint32_t thread, const struct trax_release *word);
void trax_release_drop(struct trax_release **release);

#endif
