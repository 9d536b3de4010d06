/* A run of trax-render --rays. */
#ifndef TRAX_RENDER_RAYS_RUN_H
#define TRAX_RENDER_RAYS_RUN_H

#include "options.h"
#include "trax/progress.h"

/* Traces the rays and writes what the options ask for. *agrees: with --compare, the results are those of the file. */
trax_status run_rays(const struct options *options, struct trax_scene *scene, trax_progress_line *progress,
                     bool *agrees, trax_error *error);

#endif
