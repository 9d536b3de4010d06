/* Bursts: instructions that are executed before their issue. */
#ifndef TRAX_FAST_BURST_H
#define TRAX_FAST_BURST_H

#include "fast/tm/tm.h"

/* Executes instructions from `resume` on, as steps from 0 on, and returns their number: at most `limit`; exactly
   `limit` if that is less than TRAX_BURST and no instruction ends the burst. An instruction that needs a register of
   trax_tp.atomics ends it. */
unsigned trax_fast_burst(struct trax_chip *chip, struct trax_tm *tm, unsigned tp, unsigned limit);

/* Returns the labels of all operations, by trax_op; TRAX_OP_ILLEGAL: the end of a burst; TRAX_OP_COUNT: the label that
   records a chunk. */
const void *const *trax_fast_operations(void);

#endif
