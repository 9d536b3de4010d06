/* What the general and the specialised program of one picture take: trax-render --report. */
#ifndef TRAX_RENDER_REPORT_H
#define TRAX_RENDER_REPORT_H

#include "render.h"

struct program_figures {
  struct trax_program_size size;
  double scene_bytes, instructions, cycles, memory_bytes;
};

void report_print(const struct program_figures *general, const struct program_figures *specialised, uint32_t features);

/* Adds them as "report" to the statistics that --stats has written. */
trax_status report_add_json(const char *path, const struct program_figures *general,
                            const struct program_figures *specialised, uint32_t features, bool identical,
                            trax_error *error);

#endif
