/* The layout of a state (machine/section.h): what another build must agree on to read it. */
#ifndef TRAX_ENGINE_LAYOUT_H
#define TRAX_ENGINE_LAYOUT_H

#include "engine/engine.h"

enum { TRAX_MOST_LAYOUTS = 128 };

/* Of all sections of one name. */
struct trax_layout {
  char name[40];
  uint64_t hash; /* of its fields: types, names, sizes, order */
};

/* Returns how many entries it made, fewer than TRAX_MOST_LAYOUTS: one for each name of a section that has fields, and
   one for each table whose numbers the fields hold. */
size_t trax_layout_of(const struct trax_engine *engine, void *chip, struct trax_layout *layouts);

#endif
