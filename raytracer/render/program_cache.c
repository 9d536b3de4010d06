#include "program_cache.h"

#include "trax/input.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include <xxhash.h>

/* The cache keeps no more: a program is some 30 kB, most of it debug information. */
#define MOST_PROGRAMS 256
#define LARGEST_PROGRAM ((size_t)64 << 20)

enum { KEY_LENGTH = 32, UNFINISHED_SECONDS = 3600 };

bool join_path(char path[TRAX_PATH_SIZE], const char *folder, const char *name, const char *suffix) {
  int length = snprintf(path, TRAX_PATH_SIZE, "%s/%s%s", folder, name, suffix);
  return length > 0 && length < TRAX_PATH_SIZE;
}

bool trax_program_cache(char path[TRAX_PATH_SIZE]) {
  const char *base = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
  if (base && base[0] == '/') /* the XDG Base Directory Specification ignores others */
    return join_path(path, base, "trax/programs", "");
  return home && home[0] == '/' && join_path(path, home, ".cache/trax/programs", "");
}

bool cache_make_folders(const char *path) {
  char part[TRAX_PATH_SIZE];
  if (snprintf(part, sizeof part, "%s", path) >= (int)sizeof part)
    return false;
  for (char *slash = part + 1; (slash = strchr(slash, '/')); *slash++ = '/') {
    *slash = '\0';
    if (mkdir(part, 0777) != 0 && errno != EEXIST)
      return false;
  }
  return (mkdir(part, 0777) == 0 || errno == EEXIST) && access(path, W_OK | X_OK) == 0;
}

/* --- entries --- */

/* The trailer behind the ELF file. */
struct seal {
  char magic[16];
  XXH128_canonical_t hash; /* of the program and its key */
};

static bool make_seal(struct seal *seal, const uint8_t *program, size_t size, const char *key) {
  static const char magic[sizeof seal->magic] = "trax program 1\n";
  XXH3_state_t *state = XXH3_createState();
  if (!state)
    return false;
  XXH3_128bits_reset(state);
  XXH3_128bits_update(state, key, KEY_LENGTH);
  XXH3_128bits_update(state, program, size);
  memcpy(seal->magic, magic, sizeof magic);
  XXH128_canonicalFromHash(&seal->hash, XXH3_128bits_digest(state));
  XXH3_freeState(state);
  return true;
}

enum cache_entry cache_find(const char *path, const char *key) {
  struct stat status;
  if (stat(path, &status) != 0)
    return errno == ENOENT ? CACHE_ABSENT : CACHE_BAD;
  uint8_t *bytes = NULL;
  size_t size = 0;
  trax_error ignored;
  struct seal seal;
  /* A pipe or a device might keep the reader waiting. */
  const bool good = S_ISREG(status.st_mode) &&
                    trax_read_file(path, LARGEST_PROGRAM, &bytes, &size, &ignored) == TRAX_OK && size > sizeof seal &&
                    make_seal(&seal, bytes, size - sizeof seal, key) &&
                    memcmp(bytes + size - sizeof seal, &seal, sizeof seal) == 0;
  free(bytes);
  if (good)
    utimensat(AT_FDCWD, path, NULL, 0); /* it may fail in another user's cache */
  return good ? CACHE_GOOD : CACHE_BAD;
}

/* --- making one --- */

trax_status cache_begin(struct cache_work *work, const char *cache, const char *key, trax_error *error) {
  if (!join_path(work->folder, cache, key, ".elf.XXXXXX"))
    return trax_fail(error, "%s: the path is too long", cache);
  if (!mkdtemp(work->folder))
    return trax_fail(error, "%s: %s", cache, strerror(errno));
  if (join_path(work->header, work->folder, key, ".h") && join_path(work->program, work->folder, key, ".elf"))
    return TRAX_OK;
  rmdir(work->folder);
  return trax_fail(error, "%s: the path is too long", cache);
}

static trax_status append_seal(const char *path, const char *key, trax_error *error) {
  uint8_t *bytes;
  size_t size;
  struct seal seal;
  if (trax_read_file(path, LARGEST_PROGRAM, &bytes, &size, error) != TRAX_OK)
    return TRAX_ERROR;
  const bool sealed = make_seal(&seal, bytes, size, key);
  free(bytes);
  FILE *file = sealed ? fopen(path, "ab") : NULL;
  if (!sealed)
    return trax_fail(error, "out of memory");
  bool written = file && fwrite(&seal, sizeof seal, 1, file) == 1;
  int reason = errno;
  if (file && fclose(file) != 0 && written) {
    written = false;
    reason = errno;
  }
  return written ? TRAX_OK : trax_fail(error, "%s: %s", path, strerror(reason));
}

/* If the entry's name is a folder, that is moved into the work folder, and removed only if it is empty. */
static bool move(const struct cache_work *work, const char *from, const char *to) {
  if (rename(from, to) == 0)
    return true;
  char aside[TRAX_PATH_SIZE];
  if (errno != EISDIR || !join_path(aside, work->folder, strrchr(to, '/') + 1, ".was") || rename(to, aside) != 0)
    return false;
  rmdir(aside);
  return rename(from, to) == 0;
}

trax_status cache_commit(const struct cache_work *work, const char *cache, const char *key, trax_error *error) {
  char header[TRAX_PATH_SIZE], program[TRAX_PATH_SIZE];
  if (!join_path(header, cache, key, ".h") || !join_path(program, cache, key, ".elf"))
    return trax_fail(error, "%s: the path is too long", cache);
  if (append_seal(work->program, key, error) != TRAX_OK)
    return TRAX_ERROR;
  if (!move(work, work->header, header) || !move(work, work->program, program))
    return trax_fail(error, "%s: %s", program, strerror(errno));
  return TRAX_OK;
}

void cache_end(const struct cache_work *work) {
  unlink(work->header);
  unlink(work->program);
  rmdir(work->folder);
}

/* --- pruning --- */

struct kept {
  char name[KEY_LENGTH + 5];
  struct timespec used;
};

static int by_use(const void *a, const void *b) {
  const struct kept *x = a, *y = b;
  if (x->used.tv_sec != y->used.tv_sec)
    return x->used.tv_sec < y->used.tv_sec ? 1 : -1;
  return x->used.tv_nsec < y->used.tv_nsec ? 1 : x->used.tv_nsec > y->used.tv_nsec ? -1 : strcmp(x->name, y->name);
}

/* Removes the rest of a compilation that was killed: our folder, or a file of an earlier version. Foreign files in the
   folder stay. */
static void remove_unfinished(const char *cache, const char *name) {
  struct cache_work work;
  char key[KEY_LENGTH + 1];
  snprintf(key, sizeof key, "%.*s", KEY_LENGTH, name);
  if (join_path(work.folder, cache, name, "") && join_path(work.header, work.folder, key, ".h") &&
      join_path(work.program, work.folder, key, ".elf") && unlink(work.folder) != 0)
    cache_end(&work);
}

/* Another process may remove entries at the same time. */
void cache_prune(const char *cache, const char *key) {
  DIR *folder = opendir(cache);
  struct kept *kept = NULL;
  size_t count = 0, capacity = 0;
  const time_t now = time(NULL);
  for (const struct dirent *entry; folder && (entry = readdir(folder));) {
    const size_t length = strlen(entry->d_name);
    struct stat status;
    if (length < KEY_LENGTH + 4 || memcmp(entry->d_name + KEY_LENGTH, ".elf", 4) != 0 ||
        strncmp(entry->d_name, key, KEY_LENGTH) == 0 || fstatat(dirfd(folder), entry->d_name, &status, 0) != 0)
      continue;
    if (length > KEY_LENGTH + 4) {
      if (status.st_mtim.tv_sec + UNFINISHED_SECONDS < now)
        remove_unfinished(cache, entry->d_name);
      continue;
    }
    if (count == capacity) {
      struct kept *more = realloc(kept, (capacity = 2 * capacity + 64) * sizeof *kept);
      if (!more)
        break;
      kept = more;
    }
    memcpy(kept[count].name, entry->d_name, length + 1);
    kept[count++].used = status.st_mtim;
  }
  if (count >= MOST_PROGRAMS) { /* and KEY itself */
    qsort(kept, count, sizeof *kept, by_use);
    for (size_t i = MOST_PROGRAMS - 1; i < count; i++) {
      unlinkat(dirfd(folder), kept[i].name, 0);
      memcpy(kept[i].name + KEY_LENGTH, ".h", 3);
      unlinkat(dirfd(folder), kept[i].name, 0);
    }
  }
  free(kept);
  if (folder)
    closedir(folder);
}
