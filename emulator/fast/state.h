/* The state of a chip as sections (machine/section.h): one list, for rollback and for checkpoints. */
#ifndef TRAX_FAST_STATE_H
#define TRAX_FAST_STATE_H

#include "fast/chip.h"

/* Visits all that changes during a run, except global memory, in an order that depends on the configuration alone. What
   follows from the rest between cycles (import.c) has no fields. */
void trax_state_visit(void *chip, trax_section_visitor *visit, void *context);

/* Checks that a state's indices are within bounds, so that the run stays within its structures. Returns NULL, or the
   reason of the refusal, in `text`. */
const char *trax_state_check(void *chip, uint64_t t, char text[128]);

#endif
