#include "trax/run_progress.h"

#include <inttypes.h>

void trax_run_progress_show(void *context, const trax_progress *status) {
  struct trax_run_progress *progress = context;
  const double seconds = status->host_seconds - progress->last.host_seconds;
  const uint64_t before = progress->shown ? progress->last.instructions : status->instructions_before;
  const double rate = seconds > 0 ? (double)(status->instructions - before) / seconds / 1e6 : 0;
  char detail[160], items[64] = "";
  if (status->total_items)
    snprintf(items, sizeof items, ", %" PRIu64 " of %" PRIu64 " items", status->items, status->total_items);
  else if (status->items)
    snprintf(items, sizeof items, ", %" PRIu64 " items", status->items);
  snprintf(detail, sizeof detail, "%.2f million cycles, %.1f million instructions/s%s", (double)status->cycle / 1e6,
           rate, items);
  const double fraction = status->total_items ? (double)status->items / (double)status->total_items : -1;
  if (trax_progress_line_show(progress->line, progress->task, fraction, detail)) {
    progress->shown = true;
    progress->last = *status;
  }
}
