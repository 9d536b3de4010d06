/* Sampled simulation: most of the program is executed without time, and windows in between tell how long it would have
   taken (sampled.c). */
#ifndef TRAX_FAST_SAMPLED_H
#define TRAX_FAST_SAMPLED_H

#include "core/chip.h"

struct trax_sampled;

/* Begins to watch the chip, which has the fast engine. NULL if there is no memory for it. */
struct trax_sampled *trax_sampled_create(struct trax_chip *chip, const trax_run_options *options, trax_error *error);
void trax_sampled_destroy(struct trax_sampled *sampled); /* which may be NULL */

/* After the run, whose counts are complete up to cycle t: makes the machine's statistics estimates of the whole run. */
void trax_sampled_finish(struct trax_sampled *sampled, uint64_t t);

/* Student's t: with probability 0.95 the value of this distribution lies between minus and plus the result. */
double trax_student_95(uint64_t degrees_of_freedom);

#endif
