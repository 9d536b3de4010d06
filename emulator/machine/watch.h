/* Those who look at a machine between the cycles of its run: checkpoints, the watchdog, a debugger, time lines. */
#ifndef TRAX_MACHINE_WATCH_H
#define TRAX_MACHINE_WATCH_H

#include "trax/status.h"

#include <stdint.h>

#define TRAX_NEVER UINT64_MAX /* the cycle of an event that is not scheduled */

struct trax_machine;
struct trax_run; /* what a watch may ask and change: engine/run.h */

struct trax_watch {
  uint64_t next; /* the cycle before which it looks; TRAX_NEVER: no more */
  /* All cycles before t are over and nothing of t has happened, for all TMs alike. t is `next`, or the first cycle of a
     run that begins later. Sets `next` to a cycle after t. Anything but TRAX_OK ends the run with that status. */
  trax_status (*look)(struct trax_watch *watch, struct trax_run *run, uint64_t t);
  /* If not NULL: the run has ended before cycle t, with this status; the machine is as it was then. */
  void (*end)(struct trax_watch *watch, struct trax_run *run, trax_status status, uint64_t t);
  void *context;
  void (*release)(void *context); /* if not NULL: called when the machine is destroyed */
  struct trax_watch *others;      /* the next one of the machine's list */
};

/* From now on the watch, which must outlive that, looks at the machine: before those that came earlier. An engine that
   knows no time asks only for `end`. */
void trax_machine_watch(struct trax_machine *machine, struct trax_watch *watch);
/* No longer; a watch that is not of the machine's list stays as it is. */
void trax_machine_unwatch(struct trax_machine *machine, const struct trax_watch *watch);

#endif
