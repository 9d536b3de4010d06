/* The state of a chip between cycles, in the structures of tm.h, tp.h and memory.h (engine/engine.h, "Checkpoints"). */
#ifndef TRAX_FAST_STATE_H
#define TRAX_FAST_STATE_H

#include "fast/chip.h"

void trax_state_visit(void *chip, trax_state_visitor *visit, void *context);

/* A hash of names, order and sizes of what is visited, and of what numbers in it mean. Another build of the simulator
   with another hash cannot read the state; the configuration makes no difference. */
uint64_t trax_state_layout(void *chip);

/* All places and numbers are within bounds and fit together, so that the run stays within its structures and comes to
   an end if its program does. */
const char *trax_state_check(void *chip, uint64_t t, char text[128]);

#endif
