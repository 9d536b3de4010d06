/* Pictures and hits by the native twin and by Embree, and how the emulated machine's compare with them. */
#ifndef TRAX_RENDER_COMPARE_H
#define TRAX_RENDER_COMPARE_H

#include "live.h"
#include "trax/progress.h"

/* The picture by one of the engines of this computer; live may be NULL. */
trax_status run_on_host(struct trax_picture *picture, enum engine engine, const struct options *options,
                        const struct trax_frame *frame, trax_progress_line *progress, struct live *live,
                        trax_error *error);

/* --compare. *agrees: all comparisons came out well. */
trax_status compare(const struct trax_picture *picture, const struct options *options, const struct trax_frame *frame,
                    trax_progress_line *progress, bool *agrees, trax_error *error);

/* --hits: what --compare says of hits, as JSON. */
trax_status measure_hits(const char *path, const struct trax_frame *frame, trax_progress_line *progress,
                         trax_error *error);

/* --id-picture. */
trax_status write_hits(const struct options *options, const struct trax_frame *frame, trax_progress_line *progress,
                       trax_error *error);

/* --ray-trace; picture: of the same frame by another engine, or NULL. */
trax_status trace_rays(const struct options *options, const struct trax_frame *frame,
                       const struct trax_picture *picture, trax_progress_line *progress, trax_error *error);

#endif
