#define _GNU_SOURCE /* fopencookie */
#include "trax/progress.h"

#include <string.h>
#include <time.h>
#include <unistd.h>

#define REDRAW_SECONDS 0.1

static trax_progress_line *drawn; /* the line that is on the terminal */

double trax_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void trax_progress_line_begin(trax_progress_line *line, const char *program, bool quiet) {
  *line = (trax_progress_line){.terminal = !quiet && isatty(STDERR_FILENO) ? stderr : NULL, .program = program};
}

/* The larger of both times. */
static void print_time_left(FILE *out, double rest, double waited) {
  const unsigned long whole = (unsigned long)((rest > waited ? rest : waited) + 0.5);
  if (whole == 0)
    return;
  if (whole >= 3600)
    fprintf(out, ", %lu:%02lu:%02lu left", whole / 3600, whole / 60 % 60, whole % 60);
  else
    fprintf(out, ", %lu:%02lu left", whole / 60, whole % 60);
}

/* Whether the line must be drawn again. A new task starts the clock. */
static bool is_due(trax_progress_line *line, const char *task, double fraction, double now) {
  const bool is_new = strncmp(line->task, task, sizeof line->task - 1) != 0;
  if (is_new || (line->first < 0 && fraction >= 0)) {
    line->begun = now;
    line->first = fraction;
    line->drawn_at = is_new ? 0 : line->drawn_at;
    snprintf(line->task, sizeof line->task, "%s", task);
  }
  if (is_new || fraction != line->latest)
    line->moved_at = now;
  line->latest = fraction;
  return now - line->drawn_at >= REDRAW_SECONDS;
}

bool trax_progress_line_show(trax_progress_line *line, const char *task, double fraction, const char *detail) {
  if (!line->terminal)
    return false;
  const double now = trax_seconds();
  if (!is_due(line, task, fraction, now))
    return false;
  /* The line is one write, so that an interrupt between writes cannot leave a part of it. */
  char text[512];
  FILE *out = fmemopen(text, sizeof text, "w");
  if (!out)
    return false;
  line->drawn_at = now;
  line->drawn = true;
  drawn = line;
  fprintf(out, "\r%s: %s", line->program, line->task);
  if (detail)
    fprintf(out, ", %.300s", detail);
  if (fraction >= 0)
    fprintf(out, ", %.1f %%", 100 * (fraction < 1 ? fraction : 1));
  if (line->first >= 0 && fraction > line->first && fraction < 1 && now - line->begun > 2 * REDRAW_SECONDS)
    print_time_left(out, (now - line->begun) * (1 - fraction) / (fraction - line->first), now - line->moved_at);
  fprintf(out, "\033[K"); /* erases the rest of a longer line before */
  fclose(out);
  fputs(text, line->terminal);
  fflush(line->terminal);
  return true;
}

void trax_progress_line_clear(trax_progress_line *line) {
  if (line->drawn) {
    fputs("\r\033[K", line->terminal);
    fflush(line->terminal);
  }
  line->drawn = false;
  drawn = drawn == line ? NULL : drawn;
}

void trax_progress_clear_drawn(void) {
  if (drawn)
    trax_progress_line_clear(drawn);
}

static ssize_t write_beside(void *cookie, const char *bytes, size_t size) {
  trax_progress_line_clear(cookie);
  size_t written = fwrite(bytes, 1, size, stdout);
  return fflush(stdout) == 0 ? (ssize_t)written : 0;
}

FILE *trax_progress_line_output(trax_progress_line *line) {
  FILE *output = fopencookie(line, "w", (cookie_io_functions_t){.write = write_beside});
  if (output)
    setvbuf(output, NULL, _IOLBF, BUFSIZ);
  return output;
}
