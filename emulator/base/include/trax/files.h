/* Which files a command reads and writes, so that it destroys nothing that it was given: no output may be an input, and
   no file may be written twice. Files are compared, not names: by device and inode, and those that do not exist yet by
   their folder and last component. So hard and symbolic links and other spellings of a path make no difference.

   What is no regular file (a device, a pipe, a terminal) and standard output may be written any number of times. */
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

/* option: as the user gave it, with its dashes; NULL if that is clear. A path of NULL is left out. Inputs named "-" are
   standard input. Files are looked at now. */
void trax_files_input(trax_files *files, const char *option, const char *path);
void trax_files_output(trax_files *files, const char *option, const char *path);
/* Before any work begins. */
trax_status trax_files_check(const trax_files *files, trax_error *error);
/* Of a file that turns out to be read later, as one that another refers to. files may be NULL. */
trax_status trax_files_check_input(const trax_files *files, const char *path, trax_error *error);
void trax_files_release(trax_files *files);

#ifdef __cplusplus
}
#endif
#endif
