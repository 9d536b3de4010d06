/* Writes the files of trax-render --keep and --prepare: a run of trax-sim (trax/manifest.h). */
#ifndef TRAX_RENDER_PREPARE_H
#define TRAX_RENDER_PREPARE_H

#include "render.h"

/* The machine was loaded by trax_simulated_load. */
trax_status prepare_write(const char *folder, const struct trax_frame *frame, const struct trax_program *program,
                          trax_machine *machine, trax_error *error);
/* The files that it writes, by number; NULL behind the last one. */
const char *prepared_file(size_t number);

#endif
