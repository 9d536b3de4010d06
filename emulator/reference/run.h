/* The reference engine: docs/timing.md as a program, to be read beside that page. */
#ifndef TRAX_REFERENCE_RUN_H
#define TRAX_REFERENCE_RUN_H

#include "machine/machine.h"

/* Runs the machine from cycle 0 to its end, a fault, an interrupt or the watchdog, and fills in its statistics and the
   fault; *cycles receives the length of the run. */
trax_status trax_reference_run(struct trax_machine *machine, const trax_run_options *options, uint64_t *cycles,
                               trax_error *error);

struct trax_ref_chip;
/* How many places of a TM's memory queue are taken. */
uint32_t trax_reference_queued(const struct trax_ref_chip *chip, uint32_t tm);

#endif
