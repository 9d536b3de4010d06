#include "progress.h"

#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

double seconds_now(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void progress_init(struct progress *progress, const char *program, bool quiet) {
  *progress = (struct progress){.shown = !quiet && isatty(STDERR_FILENO), .program = program};
}

void progress_show(struct progress *progress, const char *step, double fraction, const char *detail) {
  if (!progress->shown)
    return;
  double now = seconds_now();
  if (!progress->step || strcmp(progress->step, step) != 0) {
    progress->step = step;
    progress->begun = now;
    progress->drawn_at = 0;
  }
  if (now - progress->drawn_at < 0.1)
    return;
  progress->drawn_at = now;
  progress->drawn = true;
  fprintf(stderr, "\r\033[K%s: %s", progress->program, step);
  if (fraction >= 0)
    fprintf(stderr, " %3.0f %%", 100 * fraction);
  if (detail)
    fprintf(stderr, "  %s", detail);
  double elapsed = now - progress->begun;
  if (fraction > 0.001 && elapsed > 1) {
    double left = elapsed * (1 - fraction) / fraction;
    fprintf(stderr, "  %d:%02d left", (int)(left / 60), (int)left % 60);
  }
  fflush(stderr);
}

void progress_clear(struct progress *progress) {
  if (progress->drawn)
    fputs("\r\033[K", stderr);
  progress->drawn = false;
}
