/* The chip: TMs, memory controller, and the run from cycle to cycle. */
#ifndef TRAX_FAST_CHIP_H
#define TRAX_FAST_CHIP_H

#include "fast/memory.h"
#include "fast/tm.h"

struct trax_chip;

/* Somebody who looks at the machine between cycles: called when all cycles before t are over and nothing of t has
   happened, for all TMs alike. t is `next`, or the first cycle of a run that begins later. Sets `next` anew, to a cycle
   after t or TRAX_NEVER. Anything but TRAX_OK ends the run with that status. */
struct trax_watch {
  uint64_t next;
  trax_status (*look)(struct trax_watch *watch, struct trax_chip *chip, uint64_t t);
  /* If not NULL: the run has ended before cycle t, with this status; the chip is as it was then. */
  void (*end)(struct trax_watch *watch, struct trax_chip *chip, trax_status status, uint64_t t);
  void *context;
  struct trax_watch *others; /* the next one of the machine's list */
};

/* From now on the watch, which must outlive that, looks at the machine: before those that came earlier. */
void trax_machine_watch(struct trax_machine *machine, struct trax_watch *watch);
/* No longer; a watch that is not of the machine's list stays as it is. */
void trax_machine_unwatch(struct trax_machine *machine, const struct trax_watch *watch);

/* With the reference engine, which has structures of its own, only machine, tms and reference are set: a watch may read
   the machine's statistics and memory. */
struct trax_chip {
  struct trax_machine *machine;
  struct trax_text text;
  struct trax_tm *tm; /* [tms]; NULL with the reference engine */
  uint32_t tms;
  struct trax_memory memory;
  const struct trax_fast_engine *engine;
  struct trax_fast *fast;                /* the engine's */
  struct trax_windows *windows;          /* if its TMs run ahead of each other; else NULL */
  struct trax_functional *functional;    /* instead of an engine, where time is not wanted; else NULL */
  const struct trax_ref_chip *reference; /* the reference engine's; else NULL */
  struct trax_slots *slots;              /* if most of the run's work is left out; else NULL */
  uint64_t begin;                        /* the run's first cycle; not 0 if it goes on with another's */
};

/* How many threads have not ended. */
static inline uint32_t trax_chip_running(const struct trax_chip *chip) {
  uint32_t running = 0;
  for (uint32_t i = 0; i < chip->tms; i++)
    running += chip->tm[i].running;
  return running;
}

trax_status trax_chip_create(struct trax_chip *chip, struct trax_machine *machine, const trax_run_options *options,
                             trax_error *error);
void trax_chip_destroy(struct trax_chip *chip);
/* Completes the machine's statistics and charges for the cycles before `t`, which must be over: at the run's end, and
   for a watch that wants to read them; and hands it the fault that ended the run. */
void trax_chip_settle(struct trax_chip *chip, uint64_t t);

/* How many places of a TM's memory queue are taken when all cycles before `t` are over. */
uint32_t trax_chip_queued(const struct trax_chip *chip, uint32_t tm, uint64_t t);

/* Calls those whose time it is to look at the machine before cycle t. *next receives the cycle in which someone looks
   again. */
trax_status trax_chip_look(struct trax_chip *chip, uint64_t t, uint64_t *next);

/* Between cycles: brings the fast engine's machine into the core's structures. The run can go on. */
void trax_chip_gather(struct trax_chip *chip);
/* Takes up the run before cycle t with what the core's structures hold. */
void trax_chip_scatter(struct trax_chip *chip, uint64_t t);

/* Runs from cycle 0 to the end, a fault, an interrupt or the watchdog; *cycles receives the length. */
trax_status trax_chip_run(struct trax_chip *chip, const struct trax_run_options *options, uint64_t *cycles);

#endif
