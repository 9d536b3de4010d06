/* Files that appear only when they are complete. One rule for the outputs of all programs:
   - An output is whole, or is not there, or is the earlier file of its name. Nothing removes that file.
   - What is no regular file is written to, never replaced, and a symbolic link leads to the file that is replaced.
   - No output is a file that was read, or that a simulated program has written (trax/reads.h). */
#ifndef TRAX_OUTPUT_H
#define TRAX_OUTPUT_H

#include "trax/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A file is written under a temporary name in the same folder and then renamed. Devices and pipes are written directly.
   "-" and /dev/stdout are standard output; /dev/stderr and /dev/fd/N are those descriptors. */
typedef struct trax_output {
  FILE *file;      /* NULL: closed */
  char *path;      /* as given, for messages */
  char *temporary; /* NULL: path is written directly */
  char *target;    /* the temporary file's final name: path, or the file that path refers to as a symbolic link */
} trax_output;

trax_status trax_output_open(trax_output *output, const char *path, trax_error *error);
/* Closes and renames the file. On an error the temporary file is removed, and an earlier file of that name stays. */
trax_status trax_output_commit(trax_output *output, trax_error *error);
void trax_output_discard(trax_output *output);
/* Flushes standard output. Error: not everything could be written. To be called when a program ends. */
trax_status trax_output_flush(trax_error *error);
/* Checks that path can be written. To be called before a long run, so that its results are not lost. */
trax_status trax_output_check(const char *path, trax_error *error);

/* Checks that the path's ending is one of `endings` ("png pfm exr"), in upper or lower case. A path without an ending,
   and one that is not a regular file, such as /dev/null, passes: the first ending counts for it. */
trax_status trax_output_name_check(const char *path, const char *endings, trax_error *error);
/* Whether the path has the ending, in upper or lower case. */
bool trax_output_has_ending(const char *path, const char *ending);

/* Writes a whole file, and holds signals until it is done. */
trax_status trax_write_file(const char *path, const void *bytes, size_t size, trax_error *error);
/* The same. executable: for everyone whom the umask permits. */
trax_status trax_write_whole(const char *path, const void *bytes, size_t size, bool executable, trax_error *error);

/* Returns the target of a symbolic link, from malloc; NULL if path is not a symbolic link, or with ENOMEM in errno. A
   path with more than TRAX_MOST_LINKS of them in a row is none. */
char *trax_link_target(const char *path);
enum { TRAX_MOST_LINKS = 40 };

/* Returns the descriptor that a path names: 1 for "-" and /dev/stdout, 2 for /dev/stderr, N for /dev/fd/N; -1 for a
   file. */
int trax_output_descriptor(const char *path);

#ifdef __cplusplus
}
#endif
#endif
