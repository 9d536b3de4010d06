/* trax-sim --bench-modes: what each mode costs, and how far off it is (docs/emulator.md, "Modes compared"). */
#ifndef TRAX_HOST_BENCH_MODES_H
#define TRAX_HOST_BENCH_MODES_H

#include "options.h"

/* Runs the program once in every mode, each on a machine that `load` fills, without its output, and prints a table;
   also to options->stats as JSON. Errors: of loading, and a run that does not finish. */
trax_status trax_bench_modes(const trax_config *config, const struct trax_options *options,
                             trax_status (*load)(trax_machine *machine, const struct trax_options *options,
                                                 trax_error *error),
                             const volatile int *interrupt, FILE *out, trax_error *error);

#endif
