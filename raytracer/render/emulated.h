/* Runs a program on trax-render's emulated machine, and reports about the run. */
#ifndef TRAX_RENDER_EMULATED_H
#define TRAX_RENDER_EMULATED_H

#include "steps.h"

/* The lines of the chip's data cache, as trax_build_options.cache_lines takes them. */
trax_status emulated_cache_lines(unsigned *lines, const struct options *options, trax_error *error);

/* Renders the picture, and writes what the options ask of the run. */
trax_status emulate(struct trax_picture *picture, const struct job *job, trax_error *error);

#endif
