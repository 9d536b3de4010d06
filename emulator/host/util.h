/* Small things the host side uses: names that were mistyped, files read and written whole. */
#ifndef TRAX_HOST_UTIL_H
#define TRAX_HOST_UTIL_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "core/machine.h" /* trax_fail */
#include "trax/emulator.h"

/* The name among count names that mistyped most probably means, or NULL if none is near: at most two edits, and at most
   a third of its letters. name(context, i) gives the i-th. */
const char *trax_nearest_name(const char *mistyped, size_t count, const char *(*name)(const void *context, size_t i),
                              const void *context);

/* Reads a whole file of at most limit bytes. *bytes is allocated with malloc, has a NUL behind the last byte, and is
   the caller's. */
trax_status trax_read_file(const char *path, size_t limit, uint8_t **bytes, size_t *size, trax_error *error);

/* A file that appears under its name only when it is complete: written beside it and renamed. What is not a regular
   file (a device, a pipe) is written directly, "-" is standard output. */
typedef struct trax_output {
  FILE *file; /* NULL: closed */
  char *path;
  char *temporary; /* NULL: path is written directly */
} trax_output;

trax_status trax_output_open(trax_output *output, const char *path, trax_error *error);
/* Closes and renames. On an error nothing is left behind, and an earlier file of that name is untouched. */
trax_status trax_output_commit(trax_output *output, trax_error *error);
void trax_output_discard(trax_output *output);
/* Can path be written? Asked before a long run, so that its results are not lost. */
trax_status trax_output_check(const char *path, trax_error *error);

#endif
