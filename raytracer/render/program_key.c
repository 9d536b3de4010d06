/* The key of a program for one picture: the hash of all inputs of its compilation. */
#include "specialise.h"
#include "trax/input.h"
#include "trax/output.h"
#include "trax/reads.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <xxhash.h>

/* The installed files that a compiled program depends on. */
static const char *const ingredients[] = {
    "bin/trax-clang",    "bin/trax-ld",     "lib/trax/crt0.o",         "lib/trax/libc.a",
    "lib/trax/libgcc.a", "lib/trax/libm.a", "lib/trax/include/trax.h",
};

static trax_status hash_file(XXH3_state_t *state, const char *root, const char *name, trax_error *error) {
  char path[TRAX_PATH_SIZE];
  uint8_t *bytes;
  size_t size;
  if (!join_path(path, root, name, ""))
    return trax_fail(error, "%s: the path is too long", name);
  if (trax_read_file(path, (size_t)1 << 30, &bytes, &size, error) != TRAX_OK)
    return TRAX_ERROR;
  XXH3_128bits_update(state, name, strlen(name) + 1);
  XXH3_128bits_update(state, &size, sizeof size);
  XXH3_128bits_update(state, bytes, size);
  free(bytes);
  return TRAX_OK;
}

static int is_visible(const struct dirent *entry) {
  return entry->d_name[0] != '.';
}

bool trax_is_source_name(const char *name) {
  static const char *const endings[] = {"c", "h", "inc", "def", "s", "cc", "cpp", "hpp"};
  bool found = false;
  for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
    found = found || trax_output_has_ending(name, endings[i]);
  return found;
}

/* Other files of the folder, such as pictures of earlier runs, are part of the key, but no inputs. */
static void drop_other(const char *folder, const char *name) {
  char path[TRAX_PATH_SIZE];
  if (!trax_is_source_name(name) && strcmp(name, OWN_FLAGS) != 0 && join_path(path, folder, name, ""))
    trax_reads_drop_path(path);
}

/* All files of a folder, by name; deep: with those of its folders, which have no dot in their names. */
static trax_status hash_folder(XXH3_state_t *state, const char *folder, bool deep, trax_error *error) {
  struct dirent **entries;
  char below[TRAX_PATH_SIZE];
  struct stat found;
  const int count = scandir(folder, &entries, is_visible, alphasort);
  if (count < 0)
    return trax_fail(error, "%s: %s", folder, strerror(errno));
  trax_status status = TRAX_OK;
  for (int i = 0; i < count; i++) {
    const char *name = entries[i]->d_name;
    if (!strchr(name, '.')) {
      if (deep && status == TRAX_OK && join_path(below, folder, name, "") && stat(below, &found) == 0 &&
          S_ISDIR(found.st_mode)) {
        XXH3_128bits_update(state, name, strlen(name) + 1);
        status = hash_folder(state, below, deep, error);
      }
    } else {
      if (status == TRAX_OK)
        status = hash_file(state, folder, name, error);
      drop_other(folder, name);
    }
    free(entries[i]);
  }
  free(entries);
  return status;
}

/* Size and date stand for the content of the compiler's library, which is large and belongs to the distribution. */
static void hash_library(XXH3_state_t *state, const char *path) {
  struct stat status = {0};
  stat(path, &status);
  const int64_t identity[] = {status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
  XXH3_128bits_update(state, identity, sizeof identity);
}

/* Increased whenever the same files are compiled in another way. */
#define WAYS_TO_COMPILE "4"

trax_status trax_program_key(char key[33], const char *root, const char *source, const char *constants,
                             const struct flags *flags, uint32_t icache_bytes, trax_error *error) {
  static const char *const folders[] = {"layouts", "trax"};
  char folder[TRAX_PATH_SIZE];
  XXH3_state_t *state = XXH3_createState();
  if (!state)
    return trax_fail(error, "out of memory");
  XXH3_128bits_reset(state);
  XXH3_128bits_update(state, WAYS_TO_COMPILE, sizeof WAYS_TO_COMPILE);
  trax_status status = TRAX_OK;
  for (size_t i = 0; i < sizeof ingredients / sizeof *ingredients && status == TRAX_OK; i++)
    status = hash_file(state, root, ingredients[i], error);
  if (status == TRAX_OK)
    status = hash_folder(state, source, false, error);
  for (size_t i = 0; i < sizeof folders / sizeof *folders && status == TRAX_OK; i++)
    status = join_path(folder, source, folders[i], "") ? hash_folder(state, folder, true, error)
                                                       : trax_fail(error, "%s: the path is too long", source);
  hash_library(state, TRAX_LLVM_LIBRARY);
  for (size_t i = 0; i < flags->count; i++)
    XXH3_128bits_update(state, flags->words[i], strlen(flags->words[i]) + 1);
  if (icache_bytes != PAPERS_CACHE)
    XXH3_128bits_update(state, &icache_bytes, sizeof icache_bytes);
  XXH3_128bits_update(state, constants, strlen(constants));
  const XXH128_hash_t hash = XXH3_128bits_digest(state);
  snprintf(key, 33, "%016llx%016llx", (unsigned long long)hash.high64, (unsigned long long)hash.low64);
  XXH3_freeState(state);
  return status;
}
