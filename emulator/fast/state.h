/* The state of a chip with the fast engine, as the core's structures hold it between cycles. */
#ifndef TRAX_FAST_STATE_H
#define TRAX_FAST_STATE_H

#include "fast/chip.h"

/* `count` elements of `size` bytes each; name: of the field in the source, a literal. */
typedef void trax_state_visitor(void *context, const char *name, void *bytes, size_t size, size_t count);

/* Calls visit for all that the rest of the run depends on besides global memory, and for all that was counted, in
   pieces whose sizes and order depend on the configuration alone. After trax_chip_gather; to read it also after
   trax_chip_settle, and to write it before trax_state_check and trax_state_taken. */
void trax_state_visit(struct trax_chip *chip, trax_state_visitor *visit, void *context);

/* A hash of what is visited: names, order and sizes of elements, and what numbers in it mean. Another build of the
   simulator with another hash cannot read the state; the configuration makes no difference. */
uint64_t trax_state_layout(struct trax_chip *chip);

/* Whether the state, of a run whose next cycle is t, which may have come from anywhere, can be taken: all places and
   numbers in it are within bounds and fit together, so that the run stays within its structures and comes to an end if
   its program does. NULL if so, else what is wrong, in `text`. */
const char *trax_state_check(struct trax_chip *chip, uint64_t t, char text[128]);

/* The state was written, of a run whose next cycle is t: the run goes on from there. */
void trax_state_taken(struct trax_chip *chip, uint64_t t);

#endif
