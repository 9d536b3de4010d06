/* The layout of a state (machine/section.h), which must be the same in a build that reads it. */
#ifndef TRAX_ENGINE_LAYOUT_H
#define TRAX_ENGINE_LAYOUT_H

#include "engine/engine.h"

enum { TRAX_MOST_LAYOUTS = 128 };

/* The layout of all sections of one name. */
struct trax_layout {
  char name[40];
  uint64_t hash; /* of its fields: types, names, sizes, order */
};

/* Makes an entry for each name of a section with fields, for operations and causes, whose numbers the fields hold, and
   for the sources that give the fields their meaning.
   Returns the number of entries, which is less than TRAX_MOST_LAYOUTS. */
size_t trax_layout_of(const struct trax_engine *engine, void *chip, struct trax_layout *layouts);

#endif
