/* Pictures and hits by the native twin and by Embree, and how the emulated machine's compare with them. */
#ifndef TRAX_RENDER_COMPARE_H
#define TRAX_RENDER_COMPARE_H

#include "steps.h"

/* Renders the picture by one of the engines that need no emulator. */
trax_status run_on_host(struct trax_picture *picture, const struct job *job, enum engine engine, trax_error *error);

/* --compare. *agrees: whether all comparisons agree. */
trax_status compare(const struct trax_picture *picture, const struct job *job, bool *agrees, trax_error *error);

/* --hits: the figures of --compare about hits, as JSON. */
trax_status measure_hits(const struct job *job, trax_error *error);

/* --ray-trace; picture: of the same frame by another engine, or NULL. */
trax_status trace_rays(const struct job *job, int scaled, const struct trax_picture *picture, trax_error *error);

#endif
