/* Figures about one picture, as JSON: trax-render --error. */
#ifndef TRAX_RENDER_MEASURE_H
#define TRAX_RENDER_MEASURE_H

#include "options.h"
#include "trax/progress.h"

struct figure {
  const char *key;
  double value;
};

/* An object of JSON. */
trax_status write_figures(const char *path, const struct figure *figures, size_t count, trax_error *error);

/* The figures of picture_error.h, to options->error; scene and view as trax_normalise left them. */
trax_status measure_error(const struct options *options, const struct trax_scene *scene, const struct trax_view *view,
                          trax_progress_line *progress, const volatile int *interrupt, trax_error *error);

#endif
