/* Names that were mistyped. */
#ifndef TRAX_NAMES_H
#define TRAX_NAMES_H

#include "trax/status.h"

#include <getopt.h>
#include <stddef.h>

/* The name among count names that mistyped most probably means, or NULL if none is near: at most two edits, and at most
   a third of its letters. name(context, i) gives the i-th. */
const char *trax_nearest_name(const char *mistyped, size_t count, const char *(*name)(const void *context, size_t i),
                              const void *context);

/* Why getopt_long returned `which`, '?' or, for a value that is missing, ':' (which it does if the short options begin
   with a colon). */
trax_status trax_wrong_option(const struct option *options, char **argv, int which, trax_error *error);

#endif
