/* Slot-sampled simulation of programs whose threads take numbered pieces of work, called slots, by the atomic increment
   of a counter: some ranges of slots are simulated exactly, and the others are left out (docs/sampling.md,
   "Slot-sampled simulation"). */
#ifndef TRAX_SAMPLING_SLOTS_H
#define TRAX_SAMPLING_SLOTS_H

#include "engine/run.h"

struct trax_slots;

/* Adds a watch to the run, which samples it. NULL with the reason in *error: bad options, or out of memory. */
struct trax_slots *trax_slots_create(struct trax_run *run, const trax_slot_sampling *sampling, trax_error *error);
void trax_slots_destroy(struct trax_slots *slots); /* slots may be NULL */

/* After the run, whose counters are complete up to cycle t: replaces the machine's statistics by estimates of the whole
   run. TRAX_ERROR: the program did not take its slots by the counters that the options name. */
trax_status trax_slots_finish(struct trax_slots *slots, uint64_t t, trax_error *error);

#endif
