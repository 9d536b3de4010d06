#define _GNU_SOURCE /* O_PATH */
/* The allowed folders, and the walk from one of them along a path. Each part of a path is looked up in the folder
   before it, links are followed here, and ".." goes back along the walk: so nothing outside can be reached, even if the
   host's folders change meanwhile. */
#include "calls/internal.h"

#include "machine/machine.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_DEPTH = 256, MOST_LINKS = 40 };

/* Skips what does not change a name: "./" and "//" at its beginning. */
static const char *plain(const char *name) {
  while (name[0] == '.' && (name[1] == '/' || name[1] == '\0')) {
    name += name[1] ? 2 : 1;
    while (*name == '/')
      name++;
  }
  return name;
}

trax_status trax_calls_allow(struct trax_machine *machine, const char *folder, const char *name, trax_error *error) {
  struct trax_calls *calls = trax_calls_of(machine);
  struct trax_folder *folders =
      calls ? realloc(calls->folders, (calls->folder_count + 1) * sizeof *calls->folders) : NULL;
  if (!folders)
    return trax_fail(error, "out of memory");
  calls->folders = folders;
  const int descriptor = open(folder, O_PATH | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0)
    return trax_fail(error, "%s: %s", folder, strerror(errno));
  struct trax_folder *fresh = &folders[calls->folder_count];
  *fresh = (struct trax_folder){strdup(folder), strdup(plain(name)), descriptor};
  if (!fresh->host || !fresh->name) {
    free(fresh->host);
    free(fresh->name);
    close(descriptor);
    return trax_fail(error, "out of memory");
  }
  for (size_t length = strlen(fresh->name); length > 1 && fresh->name[length - 1] == '/';)
    fresh->name[--length] = '\0';
  calls->folder_count++;
  return TRAX_OK;
}

/* Returns what follows the folder's name in the path; NULL if the path does not begin with it. */
static const char *below(const struct trax_folder *folder, const char *path) {
  const size_t length = strlen(folder->name);
  if (length == 0 || strcmp(folder->name, "/") == 0)
    return (*path == '/') == (length != 0) ? path : NULL;
  if (strncmp(path, folder->name, length) != 0 || (path[length] != '/' && path[length] != '\0'))
    return NULL;
  return path + length;
}

/* The folder with the longest name that the path begins with. */
static const struct trax_folder *find_folder(const struct trax_calls *calls, const char *path, const char **rest) {
  const struct trax_folder *found = NULL;
  for (size_t i = 0; i < calls->folder_count; i++) {
    const char *after = below(&calls->folders[i], path);
    if (after && (!found || strlen(calls->folders[i].name) >= strlen(found->name))) {
      found = &calls->folders[i];
      *rest = after;
    }
  }
  return found;
}

/* A walk: the folders from the allowed one to where it is, and the path that is left. */
struct walk {
  int folders[MOST_DEPTH];
  unsigned depth, links;
  char *left; /* from malloc */
};

static void end_walk(struct walk *walk) {
  while (walk->depth)
    close(walk->folders[--walk->depth]);
  free(walk->left);
}

/* Puts the link's target before the rest of the path. */
static int follow_link(struct walk *walk, const char *target, const char *rest) {
  if (target[0] == '/')
    return EPERM;
  if (++walk->links > MOST_LINKS)
    return ELOOP;
  char *joined = malloc(strlen(target) + strlen(rest) + 2);
  if (!joined)
    return ENOMEM;
  strcat(strcat(strcpy(joined, target), *rest ? "/" : ""), rest);
  free(walk->left);
  walk->left = joined;
  return 0;
}

/* Goes one part further; *name receives the last part, which is not entered. */
static int step(struct walk *walk, bool follow, char name[NAME_MAX + 1]) {
  const char *part = walk->left + strspn(walk->left, "/");
  const size_t length = strcspn(part, "/");
  const char *rest = part + length + strspn(part + length, "/");
  const bool is_last = !*rest, ends_in_slash = is_last && part[length] == '/';
  char target[PATH_MAX];
  if (length > NAME_MAX)
    return ENAMETOOLONG;
  memcpy(name, part, length);
  name[length] = '\0';
  if (strcmp(name, "..") == 0) {
    if (walk->depth == 1)
      return EPERM;
    close(walk->folders[--walk->depth]);
    strcpy(name, ".");
  } else if (length != 0 && strcmp(name, ".") != 0) {
    const int here = walk->folders[walk->depth - 1];
    const ssize_t got = is_last && !follow && !ends_in_slash ? -1 : readlinkat(here, name, target, sizeof target - 1);
    if (got >= 0) {
      target[got] = '\0';
      return follow_link(walk, target, rest);
    }
    if (is_last && !ends_in_slash) {
      walk->left[0] = '\0';
      return 0;
    }
    if (walk->depth == MOST_DEPTH)
      return ENAMETOOLONG;
    const int next = openat(here, name, O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (next < 0)
      return errno;
    walk->folders[walk->depth++] = next;
    strcpy(name, ".");
  } else {
    strcpy(name, ".");
  }
  memmove(walk->left, rest, strlen(rest) + 1);
  return 0;
}

int trax_place_find(const struct trax_calls *calls, const char *path, bool follow, struct trax_place *place) {
  const char *rest = NULL;
  if (!*path)
    return ENOENT;
  const struct trax_folder *folder = find_folder(calls, plain(path), &rest);
  if (!folder)
    return ENOENT;
  struct walk walk = {.depth = 1, .left = strdup(rest)};
  walk.folders[0] = fcntl(folder->descriptor, F_DUPFD_CLOEXEC, 0);
  int failure = !walk.left ? ENOMEM : walk.folders[0] < 0 ? errno : 0;
  if (walk.folders[0] < 0)
    walk.depth = 0;
  do {
    if (!failure)
      failure = step(&walk, follow, place->name);
  } while (!failure && *walk.left);
  struct stat status;
  if (!failure && fstat(walk.folders[walk.depth - 1], &status) != 0)
    failure = errno;
  if (!failure) {
    place->folder = walk.folders[--walk.depth];
    place->device = status.st_dev;
    place->inode = status.st_ino;
  }
  end_walk(&walk);
  return failure;
}

void trax_place_release(struct trax_place *place) {
  if (place->folder >= 0)
    close(place->folder);
  place->folder = -1;
}

int trax_place_stat(const struct trax_place *place, struct stat *status) {
  return fstatat(place->folder, place->name, status, AT_SYMLINK_NOFOLLOW) == 0 ? 0 : errno;
}
