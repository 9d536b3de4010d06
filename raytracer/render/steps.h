/* One picture of the command line, and the progress of one step of its making. */
#ifndef TRAX_RENDER_STEPS_H
#define TRAX_RENDER_STEPS_H

#include "live.h"
#include "trax/progress.h"

struct job {
  const struct options *options;
  const struct trax_frame *frame;
  trax_progress_line *progress;
  struct live *live; /* NULL: nobody watches the picture arrive */
};

struct step {
  trax_progress_line *line;
  const char *name;
  struct live *live;                 /* NULL: nobody watches */
  const struct trax_render_run *run; /* whose picture arrives; NULL: none does */
};

/* For trax_render_run.progress; context is a struct step. */
void show_step(void *context, uint64_t done, uint64_t total);

#endif
