/* The parts of the check of a state that was read from a file (fast/state.h). */
#ifndef TRAX_FAST_STATE_CHECK_H
#define TRAX_FAST_STATE_CHECK_H

#include "fast/state.h"

#define TRAX_STATE_MOST_BYTES 4096u /* limit of a transfer */

struct trax_state_checker {
  struct trax_chip *chip;
  uint64_t t, farthest; /* farthest: a cycle in which all requests must have completed */
  char *text;           /* [128] */
  bool failed;
  /* [tm * depth + place] and [miss register of the second-level cache]: how often each request is in a list of requests
     that wait for a channel or a bank. */
  uint8_t *listed, *lines_listed;
};

/* If something is wrong for the first time, writes the reason. Returns `good`. */
__attribute__((format(printf, 3, 4))) bool trax_state_expect(struct trax_state_checker *checker, bool good,
                                                             const char *format, ...);
/* which: their name in the reason. */
void trax_state_check_tags(struct trax_state_checker *checker, const struct trax_cache_tags *tags, const char *which);
void trax_state_check_arbiters(struct trax_state_checker *checker, const trax_arbiter *arbiter, size_t count,
                               const char *which);

/* --- state_check_tm.c --- */

void trax_state_check_tm(struct trax_state_checker *checker, struct trax_tm *tm);

#endif
