/* One picture of the command line, and the progress of one step. */
#ifndef TRAX_RENDER_STEPS_H
#define TRAX_RENDER_STEPS_H

#include "options.h"
#include "trax/progress.h"

struct job {
  const struct options *options;
  const struct trax_frame *frame;
  trax_progress_line *progress;
  struct trax_rays *rays; /* of the frame, which get their hits; NULL: the frame is a picture */
};

struct step {
  trax_progress_line *line;
  const char *name;
};

/* For trax_render_run.progress; context is a struct step. */
void show_step(void *context, uint64_t done, uint64_t total);

#endif
