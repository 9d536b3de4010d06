/* trax-render's emulated machine: which program it runs, on what chip, and what is told about the run. */
#ifndef TRAX_RENDER_EMULATED_H
#define TRAX_RENDER_EMULATED_H

#include "live.h"
#include "trax/progress.h"

/* The lines of the chip's data cache, as trax_build_options.cache_lines takes them. */
trax_status emulated_cache_lines(unsigned *lines, const struct options *options, trax_error *error);

/* The picture, and what the options want to know of the run; view is the frame's; live may be NULL. */
trax_status emulate(struct trax_picture *picture, const struct options *options, const struct trax_frame *frame,
                    const struct trax_view *view, trax_progress_line *progress, struct live *live,
                    const volatile int *interrupt, trax_error *error);

#endif
