/* The functional mode: what a program computes, without time (functional.c). */
#ifndef TRAX_FAST_FUNCTIONAL_H
#define TRAX_FAST_FUNCTIONAL_H

#include "core/chip.h"

struct trax_functional;

/* Into chip->functional. */
trax_status trax_functional_create(struct trax_chip *chip, trax_error *error);
void trax_functional_destroy(struct trax_functional *functional); /* which may be NULL */

/* Runs until all threads have ended, a fault, or a thread has executed `limit` instructions (TRAX_STUCK). `stop` is
   asked now and then, with the number of instructions executed by all threads; true interrupts the run. */
trax_status trax_functional_run(struct trax_functional *functional, uint64_t limit,
                                bool (*stop)(void *context, uint64_t instructions), void *context);

/* The instructions executed since the last call, all in TM 0's statistics: no TM has time of its own. */
void trax_functional_collect(struct trax_functional *functional);

#endif
