/* The inputs and outputs of trax-render. */
#ifndef TRAX_RENDER_FILES_H
#define TRAX_RENDER_FILES_H

#include "options.h"
#include "trax/files.h"

/* No output is an input, and none is written twice. files has all that is known from the command line, also after an
   error, and is released by the caller. */
trax_status check_files(trax_files *files, const struct options *options, trax_error *error);

#endif
