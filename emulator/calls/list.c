#define _GNU_SOURCE /* DTTOIF */
/* The names in a folder: what the host has there, with what the program has made and without what it has removed. The
   folder is opened in the one before it, to which the walk has come, and not if a link has taken its name: so nothing
   outside the allowed folders is listed. */
#include "calls/internal.h"
#include "trax/grow.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct list {
  char **names; /* each from malloc */
  size_t count, capacity;
};

static int add(struct list *list, char kind, const char *name) {
  if (!trax_grow((void **)&list->names, list->count, &list->capacity, sizeof *list->names))
    return ENOMEM;
  char *copy = list->names[list->count] = malloc(strlen(name) + 2);
  if (!copy)
    return ENOMEM;
  *copy = kind;
  strcpy(copy + 1, name);
  list->count++;
  return 0;
}

static int by_bytes(const void *a, const void *b) {
  return strcmp(*(char *const *)a + 1, *(char *const *)b + 1);
}

/* The kind of what the folder has under the name. Some file systems tell it only here. */
static char kind_of(DIR *stream, const struct dirent *entry) {
  struct stat status;
  const bool is_known = entry->d_type != DT_UNKNOWN;
  if (!is_known && fstatat(dirfd(stream), entry->d_name, &status, AT_SYMLINK_NOFOLLOW) != 0)
    return 'o';
  switch (is_known ? DTTOIF(entry->d_type) : status.st_mode & S_IFMT) {
  case S_IFREG:
    return 'f';
  case S_IFDIR:
    return 'd';
  case S_IFLNK:
    return 'l';
  default:
    return 'o';
  }
}

static int add_all(struct trax_calls *calls, const struct trax_folder *folder, DIR *stream, struct list *list) {
  int failure = 0;
  for (const struct trax_name *it = calls->names; it && !failure; it = it->next)
    if (it->file && it->place.folder->device == folder->device && it->place.folder->inode == folder->inode)
      failure = add(list, 'f', it->place.name);
  while (!failure) {
    errno = 0;
    const struct dirent *entry = readdir(stream);
    if (!entry)
      return errno;
    if (!trax_name_at(calls, folder, entry->d_name))
      failure = add(list, kind_of(stream, entry), entry->d_name);
  }
  return failure;
}

static int join(const struct list *list, char **names, size_t *size) {
  *size = 0;
  for (size_t i = 0; i < list->count; i++)
    *size += strlen(list->names[i]) + 1;
  char *to = *names = malloc(*size + 1);
  for (size_t i = 0; to && i < list->count; i++)
    to = stpcpy(to, list->names[i]) + 1;
  return to ? 0 : ENOMEM;
}

/* Opens the folder at the place. */
static int open_folder(struct trax_calls *calls, const struct trax_place *place, DIR **stream) {
  struct trax_name *name;
  mode_t kind = S_IFDIR;
  int failure = place->last == TRAX_LAST_NAME ? trax_name_look(calls, place, &kind, &name) : 0;
  if (!failure && !S_ISDIR(kind))
    failure = kind ? ENOTDIR : ENOENT;
  const int parent = trax_folder_descriptor(calls, place->folder);
  if (failure || parent < 0)
    return failure ? failure : -parent;
  const int listed = openat(parent, place->name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  *stream = listed < 0 ? NULL : fdopendir(listed);
  failure = *stream ? 0 : errno;
  if (!*stream && listed >= 0)
    close(listed);
  return failure;
}

int trax_folder_list(struct trax_calls *calls, const struct trax_place *place, char **names, size_t *size) {
  struct list list = {0};
  struct stat status;
  DIR *stream;
  *names = NULL;
  int failure = open_folder(calls, place, &stream);
  if (failure)
    return failure;
  failure = fstat(dirfd(stream), &status) == 0 ? 0 : errno;
  if (!failure)
    failure = add_all(calls, &(struct trax_folder){.device = status.st_dev, .inode = status.st_ino}, stream, &list);
  closedir(stream);
  if (!failure && list.count)
    qsort(list.names, list.count, sizeof *list.names, by_bytes);
  if (!failure)
    failure = join(&list, names, size);
  for (size_t i = 0; i < list.count; i++)
    free(list.names[i]);
  free(list.names);
  return failure;
}
