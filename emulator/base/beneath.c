#define _GNU_SOURCE /* O_PATH, syscall */
#include "trax/beneath.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/openat2.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

enum { MOST_NAMES = 100 }; /* tries for a temporary name */

/* Opens the parts of the path one after the other. No part may be a link. */
static int walk(int folder, const char *path, int flags) {
  int at = fcntl(folder, F_DUPFD_CLOEXEC, 0);
  while (at >= 0) {
    path += strspn(path, "/");
    const size_t length = strcspn(path, "/");
    const bool last = path[length + strspn(path + length, "/")] == '\0';
    char *part = length == 2 && strncmp(path, "..", 2) == 0 ? NULL : strndup(length ? path : ".", length ? length : 1);
    const int next = part ? openat(at, part, (last ? flags : O_PATH | O_DIRECTORY) | O_NOFOLLOW | O_CLOEXEC) : -1;
    const int code = part ? errno : EXDEV;
    free(part);
    close(at);
    if (last || next < 0) {
      errno = code;
      return next;
    }
    at = next;
    path += length;
  }
  return -1;
}

int trax_beneath_open(int folder, const char *path, int flags) {
  const struct open_how how = {.flags = (unsigned)flags | O_CLOEXEC,
                               .resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS};
  if (*path == '/') {
    errno = EXDEV;
    return -1;
  }
  long descriptor;
  do
    descriptor = syscall(SYS_openat2, folder, path, &how, sizeof how);
  while (descriptor < 0 && errno == EAGAIN); /* a folder was renamed meanwhile */
  return descriptor < 0 && (errno == ENOSYS || errno == EPERM) ? walk(folder, path, flags) : (int)descriptor;
}

/* --- writing --- */

/* The place of a file: a folder, and the file's name in it. */
struct place {
  int folder;
  const char *name;
  mode_t mode; /* of the file that exists; 0: none does */
};

static trax_status fail(const char *shown, int code, trax_error *error) {
  return trax_fail(error, "%s: cannot be written: %s", shown, code == EXDEV ? "leaves its folder" : strerror(code));
}

/* Finds the place. After an error, too, place->folder must be closed. */
static trax_status find_place(struct place *place, int folder, const char *path, const char *shown, trax_error *error) {
  const char *slash = strrchr(path, '/');
  char *parent = slash ? strndup(path, (size_t)(slash - path + 1)) : strdup(".");
  *place = (struct place){.folder = parent ? trax_beneath_open(folder, parent, O_PATH | O_DIRECTORY) : -1,
                          .name = slash ? slash + 1 : path};
  const int code = parent ? errno : ENOMEM;
  free(parent);
  if (place->folder < 0)
    return fail(shown, code, error);
  struct stat status;
  if (!*place->name || strcmp(place->name, ".") == 0 || strcmp(place->name, "..") == 0)
    return fail(shown, EISDIR, error);
  if (fstatat(place->folder, place->name, &status, AT_SYMLINK_NOFOLLOW) != 0)
    return errno == ENOENT ? TRAX_OK : fail(shown, errno, error);
  if (!S_ISREG(status.st_mode))
    return trax_fail(error, "%s: cannot be written: it is %s", shown,
                     S_ISLNK(status.st_mode)   ? "a link"
                     : S_ISDIR(status.st_mode) ? "a folder"
                                               : "a device or a pipe");
  place->mode = status.st_mode;
  return faccessat(place->folder, place->name, W_OK, 0) == 0 ? TRAX_OK : fail(shown, errno, error);
}

/* Creates a file of a name that no other one has. */
static int create_temporary(const struct place *place, char name[32]) {
  int descriptor = -1;
  for (unsigned i = 0; i < MOST_NAMES; i++) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    snprintf(name, 32, ".%lx.%lx.%x", (unsigned long)now.tv_nsec, (unsigned long)getpid() & 0xFFFFFFFF, i);
    descriptor = openat(place->folder, name, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (descriptor >= 0 || errno != EEXIST)
      break;
  }
  if (descriptor >= 0 && place->mode)
    fchmod(descriptor, place->mode & 07777);
  return descriptor;
}

static bool write_all(int descriptor, const char *bytes, size_t size) {
  while (size) {
    const ssize_t written = write(descriptor, bytes, size);
    if (written < 0 && errno != EINTR)
      return false;
    bytes += written > 0 ? written : 0;
    size -= written > 0 ? (size_t)written : 0;
  }
  return true;
}

/* bytes: NULL: the temporary file is only created and removed. */
static trax_status put(int folder, const char *path, const char *shown, const void *bytes, size_t size,
                       trax_error *error) {
  struct place place;
  trax_status status = find_place(&place, folder, path, shown, error);
  char temporary[32];
  int descriptor = status == TRAX_OK ? create_temporary(&place, temporary) : -1;
  if (status == TRAX_OK && descriptor < 0)
    status = fail(shown, errno, error);
  if (descriptor >= 0) {
    if (bytes && !write_all(descriptor, bytes, size))
      status = fail(shown, errno, error);
    if (close(descriptor) != 0 && status == TRAX_OK)
      status = fail(shown, errno, error);
    if (bytes && status == TRAX_OK && renameat(place.folder, temporary, place.folder, place.name) != 0)
      status = fail(shown, errno, error);
    if (!bytes || status != TRAX_OK)
      unlinkat(place.folder, temporary, 0);
  }
  if (place.folder >= 0)
    close(place.folder);
  return status;
}

trax_status trax_beneath_write(int folder, const char *path, const char *shown, const void *bytes, size_t size,
                               trax_error *error) {
  return put(folder, path, shown, bytes ? bytes : "", size, error);
}

trax_status trax_beneath_check(int folder, const char *path, const char *shown, trax_error *error) {
  return put(folder, path, shown, NULL, 0, error);
}
