/* The host during a run: progress for whoever asked for it, and whether the run is to stop. All engines use it. */
#ifndef TRAX_ENGINE_POLL_H
#define TRAX_ENGINE_POLL_H

#include "machine/machine.h"

struct trax_poll {
  const struct trax_machine *machine;
  const trax_run_options *options;
  void (*collect)(void *context); /* brings the TMs' statistics up to date; NULL: they always are */
  void *context;
  uint64_t items_before, instructions_before;
  double begun, reported; /* seconds of the host's clock */
  unsigned countdown;     /* calls until the host is looked at */
};

void trax_poll_begin(struct trax_poll *poll, const struct trax_machine *machine, const trax_run_options *options);

/* Looks at the host before cycle t. True if the run is to stop. */
bool trax_poll_now(struct trax_poll *poll, uint64_t t);

/* The same once in some thousand calls; call it before every cycle. */
static inline bool trax_poll(struct trax_poll *poll, uint64_t t) {
  return --poll->countdown == 0 && trax_poll_now(poll, t);
}

/* So many cycles have passed without a look. */
static inline void trax_poll_pass(struct trax_poll *poll, uint64_t cycles) {
  poll->countdown = poll->countdown > cycles ? poll->countdown - (unsigned)cycles : 1;
}

#endif
