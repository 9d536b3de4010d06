/* Suggestions for mistyped names. */
#ifndef TRAX_NAMES_H
#define TRAX_NAMES_H

#include <stddef.h>

/* Returns the nearest of `count` names, or NULL if none is near: at most two edits, and at most a third of the letters
   of `mistyped`. name(context, i) returns the i-th name. */
const char *trax_nearest_name(const char *mistyped, size_t count, const char *(*name)(const void *context, size_t i),
                              const void *context);

#endif
