/* One line on a terminal that says how far a long step has come, and how long it will take. */
#ifndef TRAX_RENDER_PROGRESS_H
#define TRAX_RENDER_PROGRESS_H

#include <stdbool.h>

struct progress {
  bool shown;          /* standard error is a terminal and nobody asked for quiet */
  bool drawn;          /* a line is there */
  const char *program; /* the line's first word */
  const char *step;
  double begun, drawn_at; /* seconds */
};

void progress_init(struct progress *progress, const char *program, bool quiet);
/* fraction: 0 to 1, or negative if unknown; detail: NULL or what to add. A new step (by its text) starts the clock
 * anew. */
void progress_show(struct progress *progress, const char *step, double fraction, const char *detail);
void progress_clear(struct progress *progress);

double seconds_now(void);

#endif
