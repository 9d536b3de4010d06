/* A progress line on a terminal: the task, how much of it is done, and the time left. */
#ifndef TRAX_PROGRESS_H
#define TRAX_PROGRESS_H

#include <stdbool.h>
#include <stdio.h>

typedef struct trax_progress_line {
  FILE *terminal;      /* NULL: there is no terminal, and nothing is drawn */
  const char *program; /* the line's first word */
  bool drawn;          /* the line is on the terminal */
  char task[64];
  double begun, drawn_at, moved_at; /* seconds, of trax_seconds; moved_at: the last change of the fraction */
  double first, latest;             /* the fraction at the beginning of the task, and now */
} trax_progress_line;

/* The line is on standard error. Nothing is drawn if that is not a terminal or if `quiet`. */
void trax_progress_line_begin(trax_progress_line *line, const char *program, bool quiet);
/* Draws the line, at most ten times a second, and returns whether it has drawn it. fraction: 0 to 1, negative if
   unknown; detail: more text, or NULL. A new text of `task` begins a new task, for which the time left starts again.
   The time left is that of the rest at the rate so far, and no less than the time for which the fraction has not
   changed: a task that waits near its end does not end at once. Less than a second is not shown. */
bool trax_progress_line_show(trax_progress_line *line, const char *task, double fraction, const char *detail);
void trax_progress_line_clear(trax_progress_line *line);
/* Clears the line of this process that is on the terminal, if there is one. */
void trax_progress_clear_drawn(void);

/* A stream to standard output that erases the line before it writes. NULL: out of memory. fclose leaves standard output
   open. */
FILE *trax_progress_line_output(trax_progress_line *line);

/* Seconds of the monotonic clock. */
double trax_seconds(void);

#endif
