#include "steps.h"

void show_step(void *context, uint64_t done, uint64_t total) {
  const struct step *step = context;
  trax_progress_line_show(step->line, step->name, (double)done / (double)total, NULL);
}
