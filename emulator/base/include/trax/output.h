/* Files that are written whole. */
#ifndef TRAX_OUTPUT_H
#define TRAX_OUTPUT_H

#include "trax/status.h"

#include <stddef.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A file that appears under its name only when it is complete: written beside it and renamed. What is not a regular
   file (a device, a pipe) is written directly. "-" and /dev/stdout are standard output, whatever that is; /dev/stderr
   and /dev/fd/N likewise. */
typedef struct trax_output {
  FILE *file;      /* NULL: closed */
  char *path;      /* as it was given, for messages */
  char *temporary; /* NULL: path is written directly */
  char *target;    /* what the temporary file becomes: path, or what it refers to as a symbolic link */
} trax_output;

trax_status trax_output_open(trax_output *output, const char *path, trax_error *error);
/* For everyone whom the umask lets. */
void trax_output_make_executable(trax_output *output);
/* Closes and renames. On an error nothing is left behind, and an earlier file of that name is untouched. */
trax_status trax_output_commit(trax_output *output, trax_error *error);
void trax_output_discard(trax_output *output);
/* Whether all that was printed to standard output is written: asked when a program ends. */
trax_status trax_output_flush(trax_error *error);
/* Can path be written? Asked before a long run, so that its results are not lost. */
trax_status trax_output_check(const char *path, trax_error *error);

/* Is there a writer for the ending of a path? endings: as "png pfm exr", in any case. A name without an ending, and
   what is no file, such as /dev/null, has the first one's. */
trax_status trax_output_name_check(const char *path, const char *endings, trax_error *error);

/* All of it at once. */
trax_status trax_write_file(const char *path, const void *bytes, size_t size, trax_error *error);

/* The descriptor of this process that a path names: 1 of "-" and /dev/stdout, 2 of /dev/stderr, N of /dev/fd/N; -1: it
   names a file. */
int trax_output_descriptor(const char *path);

#ifdef __cplusplus
}
#endif
#endif
