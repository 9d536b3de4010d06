/* One line on a terminal that says how far a long step has come, and how long it will take. */
#ifndef TRAX_PROGRESS_H
#define TRAX_PROGRESS_H

#include <stdbool.h>
#include <stdio.h>

typedef struct trax_progress_line {
  FILE *terminal;      /* NULL: nobody sees it */
  const char *program; /* the line's first word */
  bool drawn;          /* a line is there */
  char step[64];
  double begun, drawn_at; /* seconds */
  double first;           /* the fraction when the step began */
} trax_progress_line;

/* On standard error, if that is a terminal and nobody asked for quiet. */
void trax_progress_line_begin(trax_progress_line *line, const char *program, bool quiet);
/* Draws the line, but at most ten times a second; returns whether it did. fraction: 0 to 1, or negative if unknown;
   detail: NULL or what to add. A new step, by its text, starts the clock anew. */
bool trax_progress_line_show(trax_progress_line *line, const char *step, double fraction, const char *detail);
void trax_progress_line_clear(trax_progress_line *line);

/* Standard output for others that write to the same terminal: takes the line away before it writes. NULL if there is no
   memory for it. Closed with fclose; standard output stays open. */
FILE *trax_progress_line_output(trax_progress_line *line);

/* Of a clock that is never set. */
double trax_seconds(void);

#endif
