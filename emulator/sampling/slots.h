/* Slot-sampled simulation: of a program whose threads take numbered pieces of work, slots, by the atomic increment of
   one word, only some ranges of slots are simulated, each of their cycles exactly, and the others are left out
   altogether (docs/emulator.md, "Slot-sampled simulation"). */
#ifndef TRAX_SAMPLING_SLOTS_H
#define TRAX_SAMPLING_SLOTS_H

#include "engine/run.h"

struct trax_slots;

/* Begins to watch the run. NULL with the reason in *error: bad options, or out of memory. */
struct trax_slots *trax_slots_create(struct trax_run *run, const trax_slot_sampling *sampling, trax_error *error);
void trax_slots_destroy(struct trax_slots *slots); /* which may be NULL */

/* After the run, whose counts are complete up to cycle t: makes the machine's statistics estimates of the whole run.
   TRAX_ERROR: the program did not take its slots as it was said to. */
trax_status trax_slots_finish(struct trax_slots *slots, uint64_t t, trax_error *error);

#endif
