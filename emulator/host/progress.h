/* The progress line of a terminal. */
#ifndef TRAX_HOST_PROGRESS_H
#define TRAX_HOST_PROGRESS_H

#include <stdbool.h>
#include <stdio.h>

#include "trax/emulator.h"

struct trax_progress_line {
  FILE *terminal;
  bool shown;
  struct trax_progress last; /* the rate is that since the last line */
};

/* For trax_run_options.progress; context is a trax_progress_line. */
void trax_progress_show(void *context, const trax_progress *status);
void trax_progress_clear(struct trax_progress_line *line);

/* Standard output for the guest on a terminal that shows the line: takes the line away before it writes. NULL if there
   is no memory for it. Closed with fclose; standard output stays open. */
FILE *trax_progress_guest_output(struct trax_progress_line *line);

#endif
