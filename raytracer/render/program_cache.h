/* The cache of compiled programs: KEY.elf, and KEY.h that it was made with, for debugging. A checksum of the bytes and
   the key follows each program, so that a damaged or foreign file is not run. */
#ifndef TRAX_PROGRAM_CACHE_H
#define TRAX_PROGRAM_CACHE_H

#include "render.h"

/* FOLDER/NAME with its suffix; false: longer than TRAX_PATH_SIZE. */
bool join_path(char path[TRAX_PATH_SIZE], const char *folder, const char *name, const char *suffix);

/* Makes the folder and those above; false with errno if it cannot be written. */
bool cache_make_folders(const char *path);

enum cache_entry { CACHE_GOOD, CACHE_ABSENT, CACHE_BAD };

/* Looks up the key at `path`. Sets a valid entry's time of use to now. */
enum cache_entry cache_find(const char *path, const char *key);

/* A folder of this process's own within the cache, in which a program is made: KEY.h and KEY.elf. */
struct cache_work {
  char folder[TRAX_PATH_SIZE], header[TRAX_PATH_SIZE], program[TRAX_PATH_SIZE];
};

trax_status cache_begin(struct cache_work *work, const char *cache, const char *key, trax_error *error);
/* Makes an entry of it, which replaces whatever has its name. */
trax_status cache_commit(const struct cache_work *work, const char *cache, const char *key, trax_error *error);
void cache_end(const struct cache_work *work);

/* Removes the least recently used programs, but not KEY, and unfinished ones. */
void cache_prune(const char *cache, const char *key);

#endif
