/* Options that were mistyped, of programs that use getopt_long. */
#ifndef TRAX_OPTIONS_H
#define TRAX_OPTIONS_H

#include "trax/status.h"

#include <getopt.h>

/* Why getopt_long returned `which`, '?' or, for a value that is missing, ':' (which it does if the short options begin
   with a colon). */
trax_status trax_wrong_option(const struct option *options, char **argv, int which, trax_error *error);

#endif
