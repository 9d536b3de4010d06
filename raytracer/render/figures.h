/* Figures about pictures as an object of JSON. */
#ifndef TRAX_RENDER_FIGURES_H
#define TRAX_RENDER_FIGURES_H

#include <stdio.h>

struct figure {
  const char *key;
  double value;
};

void figures_print(FILE *out, const struct figure *figures, size_t count);

#endif
