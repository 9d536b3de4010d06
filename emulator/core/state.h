/* The state of a chip with the fast engine, as the core's structures hold it between cycles. */
#ifndef TRAX_CORE_STATE_H
#define TRAX_CORE_STATE_H

#include "core/chip.h"

/* Calls visit for all that the rest of the run depends on besides global memory, and for all that was counted, in
   pieces whose sizes and order depend on the configuration alone. After trax_chip_gather; to read it also after
   trax_chip_settle, and to write it before trax_state_taken. */
void trax_state_visit(struct trax_chip *chip, void (*visit)(void *context, void *bytes, size_t size), void *context);

/* The state was written, of a run whose next cycle is t: the run goes on from there. */
void trax_state_taken(struct trax_chip *chip, uint64_t t);

#endif
