/* Polling during a run: calls the progress callback of the options, and reads their interrupt flag. */
#ifndef TRAX_ENGINE_POLL_H
#define TRAX_ENGINE_POLL_H

#include "machine/machine.h"

enum { TRAX_POLL_INTERVAL = 4096 }; /* cycles between polls */

struct trax_poll {
  const struct trax_machine *machine;
  const trax_run_options *options;
  void (*collect)(void *context); /* brings the TMs' counts of instructions up to date */
  void *context;
  uint64_t items_before, instructions_before;
  double begun, reported; /* seconds of the host's clock */
  unsigned countdown;     /* cycles until the next poll */
};

void trax_poll_begin(struct trax_poll *poll, const struct trax_machine *machine, const trax_run_options *options);

/* Polls before cycle t. True: the run is to stop. */
bool trax_poll_now(struct trax_poll *poll, uint64_t t);

/* Polls if an interval has passed. */
static inline bool trax_poll(struct trax_poll *poll, uint64_t t) {
  return poll->countdown == 0 && trax_poll_now(poll, t);
}

/* Counts `cycles` cycles of the interval. */
static inline void trax_poll_pass(struct trax_poll *poll, uint64_t cycles) {
  poll->countdown -= poll->countdown < cycles ? poll->countdown : (unsigned)cycles;
}

#endif
