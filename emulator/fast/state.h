/* The state of a chip, as sections (machine/section.h): one list, for those who go back to it and those who save it. */
#ifndef TRAX_FAST_STATE_H
#define TRAX_FAST_STATE_H

#include "fast/chip.h"

/* All that changes during a run, but global memory, in an order that depends on the configuration alone. What the fast
   engine has for itself has no fields: between cycles it follows from the rest (transfer.c). */
void trax_state_visit(void *chip, trax_section_visitor *visit, void *context);

/* All places and numbers are within bounds and fit together, so that the run stays within its structures and comes to
   an end if its program does. */
const char *trax_state_check(void *chip, uint64_t t, char text[128]);

#endif
