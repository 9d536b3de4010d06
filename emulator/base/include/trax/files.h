/* The list of files that a command reads and writes. Its check makes sure that the command destroys none of its inputs:
   no output may be an input, and no file may be written twice. Files are compared by device and inode, and files that
   do not exist yet by their folder and the rest of the path. So links and different spellings of a path are recognised.

   Standard output, and outputs that are not regular files (devices, pipes, terminals), may be written any number of
   times. */
#ifndef TRAX_FILES_H
#define TRAX_FILES_H

#include "trax/status.h"

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct trax_files {
  struct trax_file_use *uses;
  size_t count, capacity;
  bool out_of_memory;
} trax_files;

/* Adds a file. option: as the user gave it, with its dashes, for messages; NULL if a message needs no option. A NULL
   path is ignored. The input "-" is standard input. The file is identified (stat) by this call. */
void trax_files_input(trax_files *files, const char *option, const char *path);
void trax_files_output(trax_files *files, const char *option, const char *path);
/* Errors: an output is an input, a file is written twice, or out of memory. To be called before any work begins. */
trax_status trax_files_check(const trax_files *files, trax_error *error);
/* Checks one more input, which became known later: a file that an input refers to. files may be NULL. */
trax_status trax_files_check_input(const trax_files *files, const char *path, trax_error *error);
void trax_files_release(trax_files *files);

#ifdef __cplusplus
}
#endif
#endif
