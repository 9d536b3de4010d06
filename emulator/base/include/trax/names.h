/* Names that were mistyped. */
#ifndef TRAX_NAMES_H
#define TRAX_NAMES_H

#include <stddef.h>

/* The name among count names that mistyped most probably means, or NULL if none is near: at most two edits, and at most
   a third of its letters. name(context, i) gives the i-th. */
const char *trax_nearest_name(const char *mistyped, size_t count, const char *(*name)(const void *context, size_t i),
                              const void *context);

#endif
