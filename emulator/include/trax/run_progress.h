/* Shows a run's progress on the progress line (trax/progress.h). */
#ifndef TRAX_RUN_PROGRESS_H
#define TRAX_RUN_PROGRESS_H

#include "trax/emulator.h"
#include "trax/progress.h"

struct trax_run_progress {
  trax_progress_line *line;
  const char *task;
  bool shown;
  trax_progress last; /* as of the latest line, since which the rate is measured */
};

/* For trax_run_options.progress; context is a trax_run_progress. */
void trax_run_progress_show(void *context, const trax_progress *status);

#endif
