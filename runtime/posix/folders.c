/* Listing of folders. */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../internal/host.h"
#include "folders.h"

struct trax_folder {
  struct dirent entry;
  char *names; /* of each entry its kind (f, d, l, o), the name and a NUL */
  size_t at, end;
  int descriptor; /* -1: none yet */
  size_t path_length;
  char path[]; /* with a slash, and room for a name */
};

/* Names may be added between the two calls. */
static int read_names(DIR *folder, const char *path) {
  size_t capacity = 0;
  for (;;) {
    const int size = host_result(host_call(TRAX_HOST_LIST, (uintptr_t)path, (uintptr_t)folder->names, capacity));
    if (size < 0)
      return -1;
    folder->end = (size_t)size;
    if (folder->end <= capacity)
      return 0;
    free(folder->names);
    capacity = folder->end;
    if (!(folder->names = malloc(capacity)))
      return -1;
  }
}

static DIR *make(const char *path, int descriptor) {
  const size_t length = strlen(path);
  DIR *folder = calloc(1, sizeof *folder + length + 1 + sizeof folder->entry.d_name);
  if (!folder)
    return NULL;
  folder->descriptor = descriptor;
  memcpy(folder->path, path, length);
  folder->path[length] = '/';
  folder->path_length = length + 1;
  return folder;
}

DIR *opendir(const char *path) {
  DIR *folder = make(path, -1);
  if (!folder || read_names(folder, path) == 0)
    return folder;
  closedir(folder);
  return NULL;
}

DIR *fdopendir(int descriptor) {
  char *path = __trax_folder_path(descriptor, "");
  const int is_removed = !path && errno == ENOENT; /* it is empty then */
  DIR *folder = path || is_removed ? make(path ? path : "", descriptor) : NULL;
  if (folder && path && read_names(folder, path)) {
    folder->descriptor = -1; /* stays the caller's */
    closedir(folder);
    folder = NULL;
  }
  free(path);
  return folder;
}

int dirfd(DIR *folder) {
  folder->path[folder->path_length] = '\0';
  if (folder->descriptor < 0)
    folder->descriptor = open(folder->path, O_RDONLY | O_DIRECTORY);
  return folder->descriptor;
}

struct dirent *readdir(DIR *folder) {
  if (folder->at == folder->end)
    return NULL;
  struct dirent *entry = &folder->entry;
  struct stat status;
  const int number = errno;
  const char *from = folder->names + folder->at;
  entry->d_type = *from == 'f' ? DT_REG : *from == 'd' ? DT_DIR : *from == 'l' ? DT_LNK : DT_UNKNOWN;
  strlcpy(entry->d_name, from + 1, sizeof entry->d_name);
  folder->at += strlen(from) + 1;
  entry->d_reclen = sizeof *entry;
  strcpy(folder->path + folder->path_length, entry->d_name);
  entry->d_ino = lstat(folder->path, &status) == 0 ? status.st_ino : 1; /* ".." may be above what the user allowed */
  errno = number;
  return entry;
}

int closedir(DIR *folder) {
  const int number = errno;
  if (folder->descriptor >= 0)
    close(folder->descriptor);
  free(folder->names);
  free(folder);
  errno = number;
  return 0;
}

void rewinddir(DIR *folder) {
  folder->at = 0;
}

long telldir(DIR *folder) {
  return (long)folder->at;
}

void seekdir(DIR *folder, long place) {
  folder->at = (size_t)place;
}

int alphasort(const struct dirent **a, const struct dirent **b) {
  return strcmp((*a)->d_name, (*b)->d_name);
}

/* Adds a copy of the entry. */
static int keep(struct dirent ***list, size_t count, const struct dirent *entry) {
  struct dirent *copy = malloc(sizeof *copy), **grown = realloc(*list, (count + 1) * sizeof **list);
  if (grown)
    *list = grown;
  if (!copy || !grown) {
    free(copy);
    return -1;
  }
  *copy = *entry;
  grown[count] = copy;
  return 0;
}

int scandir(const char *path, struct dirent ***entries, int (*choose)(const struct dirent *),
            int (*compare)(const struct dirent **, const struct dirent **)) {
  DIR *folder = opendir(path);
  struct dirent **list = NULL;
  size_t count = 0;
  int failed = 0;
  if (!folder)
    return -1;
  for (const struct dirent *entry; !failed && (entry = readdir(folder));)
    if (!choose || choose(entry)) {
      failed = keep(&list, count, entry);
      count += !failed;
    }
  closedir(folder);
  if (failed) {
    while (count)
      free(list[--count]);
    free(list);
    errno = ENOMEM;
    return -1;
  }
  if (compare)
    qsort(list, count, sizeof *list, (int (*)(const void *, const void *))compare);
  *entries = list;
  return (int)count;
}
