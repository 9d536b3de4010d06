/* Replacement policies, which choose the place of an arriving line in its set (docs/timing.md, "Data cache").
   Configurations, their errors and --help-config follow from these rows. fast/tm/cache_tags.h and reference/lines.c
   implement each policy independently. */
#ifndef TRAX_MACHINE_REPLACEMENT_H
#define TRAX_MACHINE_REPLACEMENT_H

#include <stdbool.h>

/* A row X(...) for each policy: identifier; its word in a configuration; whether it depends on the uses of lines; a
   description of the place. */
/* clang-format off */
#define TRAX_REPLACEMENTS(X)                                                                                                               \
  X(FIFO, "fifo", false, "first in, first out: a pointer of the set shows the place and moves on, modulo the ways")                        \
  X(LRU, "lru", true, "an empty one, or else that of the least recently used line")
/* clang-format on */

enum trax_replacement {
#define TRAX_REPLACEMENT(ID, ...) TRAX_REPLACE_##ID,
  TRAX_REPLACEMENTS(TRAX_REPLACEMENT)
#undef TRAX_REPLACEMENT
};

struct trax_replacement_policy {
  const char *word;
  bool by_use;
  const char *place;
};

extern const struct trax_replacement_policy trax_replacements[];

#define TRAX_REPLACEMENT(...) +1
enum { TRAX_REPLACEMENT_COUNT = 0 TRAX_REPLACEMENTS(TRAX_REPLACEMENT) };
#undef TRAX_REPLACEMENT

#endif
