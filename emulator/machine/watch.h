/* Watches: checkpoints, the watchdog, a debugger and time lines inspect a machine between the cycles of its run. */
#ifndef TRAX_MACHINE_WATCH_H
#define TRAX_MACHINE_WATCH_H

#include "trax/status.h"

#include <stdint.h>

#define TRAX_NEVER UINT64_MAX /* the cycle of an event that is not scheduled */

struct trax_machine;
struct trax_run; /* engine/run.h has what a watch may read and change */

struct trax_watch {
  uint64_t next; /* the cycle before which the watch is called; TRAX_NEVER: never again */
  /* Called when all cycles before t are over and nothing of t has happened, in all TMs. t is `next`, or the first cycle
     of a run that begins later. It sets `next` to a cycle after t. A status other than TRAX_OK ends the run with it. */
  trax_status (*inspect)(struct trax_watch *watch, struct trax_run *run, uint64_t t);
  /* If not NULL, called when the run has ended before cycle t with this status. */
  void (*end)(struct trax_watch *watch, struct trax_run *run, trax_status status, uint64_t t);
  void *context;
  void (*release)(void *context); /* if not NULL: called when the machine is destroyed */
  struct trax_watch *others;      /* the next one in the machine's list */
};

/* Adds a watch, which must stay valid until it is removed or the machine is destroyed. The watch added last is called
   first. An engine without time calls only `end`. */
void trax_machine_watch(struct trax_machine *machine, struct trax_watch *watch);
/* Removes a watch; one that is not in the machine's list is ignored. */
void trax_machine_unwatch(struct trax_machine *machine, const struct trax_watch *watch);

#endif
