/* trax-render --bench-accuracy. */
#ifndef TRAX_RENDER_BENCH_ACCURACY_H
#define TRAX_RENDER_BENCH_ACCURACY_H

#include "options.h"
#include "trax/progress.h"

/* Measures every variant of accuracy.h for the scene and view (as trax_normalise left them), prints the table, and
   writes it to the folder options->output: accuracy.md, accuracy.csv, accuracy.json, accuracy.svg. What was measured
   is kept there, so that a run that was stopped goes on, and one with nothing changed only reports. */
trax_status bench_accuracy(const struct options *options, const struct trax_scene *scene, const struct trax_view *view,
                           trax_progress_line *progress, const volatile int *interrupt, trax_error *error);

#endif
