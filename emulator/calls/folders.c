#define _GNU_SOURCE /* O_PATH */
/* The allowed folders, and the walk from one of them along a path. Each part of a path is looked up in the folder
   before it, links are followed here, and ".." goes back along the walk: so nothing outside can be reached, even if the
   host's folders change meanwhile. openat2 would not help, because a place need not exist. */
#include "calls/internal.h"

#include "machine/machine.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_LINKS = 40, MOST_OPEN = 64 /* folders besides the allowed ones */ };

/* Skips "./" and "//" at the beginning of a name: they do not change it. */
static const char *plain(const char *name) {
  while (name[0] == '.' && (name[1] == '/' || name[1] == '\0')) {
    name += name[1] ? 2 : 1;
    while (*name == '/')
      name++;
  }
  return name;
}

static int make_folder(struct trax_calls *calls, struct trax_folder *parent, const char *name, int descriptor) {
  struct trax_folder *fresh = calloc(1, sizeof *fresh);
  struct stat status;
  char *copy = strdup(name);
  if (!fresh || !copy || fstat(descriptor, &status) != 0) {
    const int failure = fresh && copy ? errno : ENOMEM;
    free(fresh);
    free(copy);
    return failure;
  }
  *fresh = (struct trax_folder){.next = calls->folders,
                                .parent = parent,
                                .name = copy,
                                .device = status.st_dev,
                                .inode = status.st_ino,
                                .descriptor = descriptor,
                                .references = 1};
  if (parent)
    trax_folder_refer(parent);
  calls->folders = fresh;
  return 0;
}

trax_status trax_calls_allow(struct trax_machine *machine, const char *folder, const char *name, trax_error *error) {
  struct trax_calls *calls = trax_calls_of(machine);
  char *short_name = strdup(plain(name));
  if (!calls || !short_name) {
    free(short_name);
    return trax_fail(error, "out of memory");
  }
  for (size_t length = strlen(short_name); length > 1 && short_name[length - 1] == '/';)
    short_name[--length] = '\0';
  const int descriptor = open(folder, O_PATH | O_DIRECTORY | O_CLOEXEC);
  const int failure = descriptor < 0 ? errno : make_folder(calls, NULL, short_name, descriptor);
  free(short_name);
  if (failure && descriptor >= 0)
    close(descriptor);
  return failure ? trax_fail(error, "%s: %s", folder, strerror(failure)) : TRAX_OK;
}

/* --- folders on the way --- */

void trax_folder_refer(struct trax_folder *folder) {
  folder->references++;
}

void trax_folder_release(struct trax_calls *calls, struct trax_folder *folder) {
  while (folder && --folder->references == 0) {
    struct trax_folder *parent = folder->parent, **link = &calls->folders;
    while (*link != folder)
      link = &(*link)->next;
    *link = folder->next;
    if (folder->descriptor >= 0)
      close(folder->descriptor);
    free(folder->name);
    free(folder);
    folder = parent;
  }
}

/* Opens a folder in another one; a link is not followed. */
static int open_below(int parent, const char *name) {
  return openat(parent, name, O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

/* Opens a folder that was closed: the same one, at the place that it had. */
static int open_again(const struct trax_folder *folder) {
  if (folder->descriptor >= 0)
    return fcntl(folder->descriptor, F_DUPFD_CLOEXEC, 0);
  const int parent = open_again(folder->parent);
  if (parent < 0)
    return -1;
  int descriptor = open_below(parent, folder->name), failure = errno;
  struct stat status;
  if (descriptor >= 0 && (fstat(descriptor, &status) != 0 || status.st_dev != folder->device ||
                          status.st_ino != folder->inode)) { /* another process has put another one there */
    close(descriptor);
    descriptor = -1;
    failure = ENOENT;
  }
  close(parent);
  errno = failure;
  return descriptor;
}

/* Makes room for one more descriptor: closes the one that was not used for the longest time. */
static void make_room(struct trax_calls *calls) {
  struct trax_folder *oldest = NULL;
  unsigned count = 0;
  for (struct trax_folder *it = calls->folders; it; it = it->next) {
    if (!it->parent || it->descriptor < 0)
      continue;
    count++;
    if (!oldest || it->used < oldest->used)
      oldest = it;
  }
  if (count < MOST_OPEN)
    return;
  close(oldest->descriptor);
  oldest->descriptor = -1;
}

int trax_folder_descriptor(struct trax_calls *calls, struct trax_folder *folder) {
  if (folder->descriptor < 0) {
    make_room(calls);
    folder->descriptor = open_again(folder);
  }
  folder->used = ++calls->folder_uses;
  return folder->descriptor < 0 ? -errno : folder->descriptor;
}

void trax_folder_moved(struct trax_calls *calls, const struct stat *status, const struct trax_place *to) {
  for (struct trax_folder *it = calls->folders; it;) {
    const bool is_there = it->parent == to->folder && strcmp(it->name, to->name) == 0;
    char *name = NULL;
    if (!it->parent || is_there || it->device != status->st_dev || it->inode != status->st_ino ||
        !(name = strdup(to->name))) {
      it = it->next;
      continue;
    }
    struct trax_folder *former = it->parent;
    free(it->name);
    it->name = name;
    it->parent = to->folder;
    trax_folder_refer(to->folder);
    trax_folder_release(calls, former); /* which may be the next one */
    it = calls->folders;
  }
}

/* --- the walk --- */

/* Returns what follows the folder's name in the path; NULL if the path does not begin with it. */
static const char *below(const struct trax_folder *folder, const char *path) {
  const size_t length = strlen(folder->name);
  if (length == 0 || strcmp(folder->name, "/") == 0)
    return (*path == '/') == (length != 0) ? path : NULL;
  if (strncmp(path, folder->name, length) != 0 || (path[length] != '/' && path[length] != '\0'))
    return NULL;
  return path + length;
}

/* The allowed folder with the longest name that the path begins with; of equal ones, the last that was allowed. */
static struct trax_folder *find_folder(const struct trax_calls *calls, const char *path, const char **rest) {
  struct trax_folder *found = NULL;
  for (struct trax_folder *it = calls->folders; it; it = it->next) {
    const char *after = it->parent ? NULL : below(it, path);
    if (after && (!found || strlen(it->name) > strlen(found->name))) {
      found = it;
      *rest = after;
    }
  }
  return found;
}

struct walk {
  struct trax_calls *calls;
  struct trax_folder *here; /* a reference */
  unsigned links;
  char *left; /* of the path; from malloc */
};

/* Puts the link's target before the rest of the path. */
static int follow_link(struct walk *walk, const char *target, const char *rest) {
  if (target[0] == '/')
    return EPERM;
  if (++walk->links > MOST_LINKS)
    return ELOOP;
  char *joined = malloc(strlen(target) + strlen(rest) + 1);
  if (!joined)
    return ENOMEM;
  strcat(strcpy(joined, target), rest);
  free(walk->left);
  walk->left = joined;
  return 0;
}

static void go_to(struct walk *walk, struct trax_folder *folder) {
  struct trax_folder *former = walk->here;
  trax_folder_refer(folder);
  walk->here = folder;
  trax_folder_release(walk->calls, former);
}

static int enter(struct walk *walk, int here, const char *name) {
  struct stat status;
  const int descriptor = open_below(here, name);
  if (descriptor < 0)
    return errno;
  if (fstat(descriptor, &status) != 0) {
    const int failure = errno;
    close(descriptor);
    return failure;
  }
  for (struct trax_folder *it = walk->calls->folders; it; it = it->next) {
    if (it->parent != walk->here || it->device != status.st_dev || it->inode != status.st_ino ||
        strcmp(it->name, name) != 0)
      continue;
    close(descriptor);
    go_to(walk, it);
    return 0;
  }
  make_room(walk->calls);
  const int failure = make_folder(walk->calls, walk->here, name, descriptor);
  if (failure) {
    close(descriptor);
    return failure;
  }
  struct trax_folder *fresh = walk->calls->folders;
  fresh->used = ++walk->calls->folder_uses;
  go_to(walk, fresh);
  fresh->references--;
  return 0;
}

/* Whether the user may look things up where the walk is. */
static int check_search(struct walk *walk) {
  const int here = trax_folder_descriptor(walk->calls, walk->here);
  struct stat status;
  if (here < 0)
    return -here;
  return fstatat(here, ".", &status, 0) == 0 ? 0 : errno;
}

/* A part that is a name. *ends: it is the last one, and not a link to be followed. */
static int advance_by_name(struct walk *walk, enum trax_follow follow, const char *after,
                           const struct trax_place *place, bool *ends) {
  const bool is_last = !after[strspn(after, "/")];
  const struct trax_name *known = trax_name_at(walk->calls, walk->here, place->name);
  const int here = trax_folder_descriptor(walk->calls, walk->here);
  char target[PATH_MAX];
  if (here < 0)
    return -here;
  if (known && !is_last)
    return known->file ? ENOTDIR : ENOENT;
  if (!known && (!is_last || follow == TRAX_FOLLOW_ALL || follow == (*after ? TRAX_FOLLOW_SLASH : TRAX_FOLLOW_NAMES))) {
    const ssize_t got = readlinkat(here, place->name, target, sizeof target - 1);
    if (got >= 0) {
      target[got] = '\0';
      return follow_link(walk, target, after);
    }
  }
  *ends = is_last;
  return is_last ? 0 : enter(walk, here, place->name);
}

/* Goes one part further. *ends: the place is found. */
static int advance(struct walk *walk, enum trax_follow follow, struct trax_place *place, bool *ends) {
  const char *part = walk->left + strspn(walk->left, "/"), *left = walk->left;
  const size_t length = strcspn(part, "/");
  const char *after = part + length, *rest = after + strspn(after, "/");
  snprintf(place->name, sizeof place->name, "%.*s", (int)length, part);
  place->slash = *after == '/';
  place->last = TRAX_LAST_NAME;
  if (length == 0 || strcmp(place->name, ".") == 0)
    place->last = TRAX_LAST_HERE;
  else if (strcmp(place->name, "..") == 0)
    place->last = TRAX_LAST_ABOVE;
  *ends = !*rest && place->last != TRAX_LAST_NAME;
  const int denied = length ? check_search(walk) : 0;
  if (denied)
    return denied;
  if (place->last == TRAX_LAST_NAME) {
    const int failure = advance_by_name(walk, follow, after, place, ends);
    if (failure || walk->left != left) /* a link was followed */
      return failure;
  } else {
    if (place->last == TRAX_LAST_ABOVE && !walk->here->parent)
      return EPERM;
    if (place->last == TRAX_LAST_ABOVE)
      go_to(walk, walk->here->parent);
    strcpy(place->name, ".");
  }
  memmove(walk->left, rest, strlen(rest) + 1);
  return 0;
}

int trax_place_find(struct trax_calls *calls, const char *path, enum trax_follow follow, struct trax_place *place) {
  const char *rest = NULL;
  place->folder = NULL;
  if (!*path)
    return ENOENT;
  struct trax_folder *folder = find_folder(calls, plain(path), &rest);
  if (!folder)
    return ENOENT;
  struct walk walk = {.calls = calls, .here = folder, .left = strdup(rest)};
  trax_folder_refer(folder);
  int failure = walk.left ? 0 : ENOMEM;
  for (bool ends = false; !failure && !ends;)
    failure = advance(&walk, follow, place, &ends);
  free(walk.left);
  if (failure)
    trax_folder_release(calls, walk.here);
  else
    place->folder = walk.here;
  return failure;
}

int trax_place_enter(struct trax_calls *calls, struct trax_place *place) {
  struct walk walk = {.calls = calls, .here = place->folder};
  const int here = trax_folder_descriptor(calls, place->folder);
  const int failure = place->last != TRAX_LAST_NAME ? 0 : here < 0 ? -here : enter(&walk, here, place->name);
  if (failure)
    return failure;
  place->folder = walk.here;
  place->last = TRAX_LAST_HERE;
  strcpy(place->name, ".");
  return 0;
}

void trax_place_release(struct trax_calls *calls, struct trax_place *place) {
  trax_folder_release(calls, place->folder);
  place->folder = NULL;
}

int trax_place_stat(struct trax_calls *calls, const struct trax_place *place, struct stat *status) {
  const int folder = trax_folder_descriptor(calls, place->folder);
  if (folder < 0)
    return -folder;
  return fstatat(folder, place->name, status, AT_SYMLINK_NOFOLLOW) == 0 ? 0 : errno;
}

static void put_folder(FILE *stream, const struct trax_folder *folder) {
  if (folder->parent) {
    put_folder(stream, folder->parent);
    if (ftello(stream) && strcmp(folder->parent->name, "/") != 0)
      fputc('/', stream);
  }
  fputs(folder->name, stream);
}

char *trax_place_path(const struct trax_place *place) {
  char *path = NULL;
  size_t size;
  FILE *stream = open_memstream(&path, &size);
  if (!stream)
    return NULL;
  put_folder(stream, place->folder);
  const off_t length = ftello(stream);
  if (!length || strcmp(place->name, ".") != 0) /* a folder has one path */
    fprintf(stream, "%s%s", length && strcmp(place->folder->name, "/") != 0 ? "/" : "", place->name);
  if (fclose(stream) == 0)
    return path;
  free(path);
  return NULL;
}
