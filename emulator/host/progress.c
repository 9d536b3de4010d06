#define _GNU_SOURCE /* fopencookie */
#include "progress.h"

#include <inttypes.h>

static void print_time_left(FILE *out, const trax_progress *status) {
  if (!status->total_items || status->items <= status->items_before || status->items > status->total_items)
    return;
  double left = status->host_seconds * (double)(status->total_items - status->items) /
                (double)(status->items - status->items_before);
  uint64_t seconds = (uint64_t)(left + 0.5);
  if (seconds >= 3600)
    fprintf(out, ", %" PRIu64 ":%02u:%02u left", seconds / 3600, (unsigned)(seconds / 60 % 60),
            (unsigned)(seconds % 60));
  else
    fprintf(out, ", %u:%02u left", (unsigned)(seconds / 60), (unsigned)(seconds % 60));
}

void trax_progress_show(void *context, const trax_progress *status) {
  struct trax_progress_line *line = context;
  /* One write: an interrupt may end any, and would else leave a line without its beginning. */
  char text[256];
  FILE *out = fmemopen(text, sizeof text, "w");
  if (!out)
    return;
  double seconds = status->host_seconds - line->last.host_seconds;
  uint64_t before = line->shown ? line->last.instructions : status->instructions_before;
  double rate = seconds > 0 ? (double)(status->instructions - before) / seconds / 1e6 : 0;
  fprintf(out, "\r%.2f million cycles, %.1f million instructions/s", (double)status->cycle / 1e6, rate);
  if (status->total_items)
    fprintf(out, ", %" PRIu64 " of %" PRIu64 " items (%.1f %%)", status->items, status->total_items,
            100 * (double)status->items / (double)status->total_items);
  else if (status->items)
    fprintf(out, ", %" PRIu64 " items", status->items);
  print_time_left(out, status);
  fprintf(out, "\033[K"); /* what the line before had more */
  fclose(out);
  fputs(text, line->terminal);
  fflush(line->terminal);
  line->shown = true;
  line->last = *status;
}

void trax_progress_clear(struct trax_progress_line *line) {
  if (line->shown) {
    fprintf(line->terminal, "\r\033[K");
    fflush(line->terminal);
  }
  line->shown = false;
}

static ssize_t write_guest(void *cookie, const char *bytes, size_t size) {
  trax_progress_clear(cookie);
  size_t written = fwrite(bytes, 1, size, stdout);
  return fflush(stdout) == 0 ? (ssize_t)written : 0;
}

FILE *trax_progress_guest_output(struct trax_progress_line *line) {
  FILE *output = fopencookie(line, "w", (cookie_io_functions_t){.write = write_guest});
  if (output)
    setvbuf(output, NULL, _IOLBF, BUFSIZ);
  return output;
}
