/* Paths from an open folder: the folder's own path is put before them. */
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../internal/host.h"
#include "folders.h"

char *__trax_folder_path(int folder, const char *path) {
  for (size_t capacity = 128;;) {
    char *full = malloc(capacity + strlen(path) + 1);
    if (!full)
      return NULL;
    const int size = host_result(host_call(TRAX_HOST_FOLDER, (unsigned)folder, (uintptr_t)full, capacity));
    if (size > 0 && (size_t)size <= capacity) {
      if (*path)
        strcat(strcat(full, "/"), path);
      return full;
    }
    const int number = errno;
    free(full);
    errno = number;
    if (size < 0)
      return NULL;
    capacity = (size_t)size;
  }
}

/* An operation on a path. */
struct operation {
  int (*act)(const char *path, const struct operation *operation);
  int flags;
  mode_t mode;
  struct stat *status;
  const char *from, *to;
};

static int act_at(int folder, const char *path, const struct operation *operation) {
  if (folder == AT_FDCWD || *path == '/')
    return operation->act(path, operation);
  if (!*path) {
    errno = ENOENT;
    return -1;
  }
  char *full = __trax_folder_path(folder, path);
  const int result = full ? operation->act(full, operation) : -1, number = errno;
  free(full);
  errno = number;
  return result;
}

static int act_open(const char *path, const struct operation *operation) {
  return open(path, operation->flags);
}

static int act_unlink(const char *path, const struct operation *operation) {
  return operation->flags & AT_REMOVEDIR ? rmdir(path) : unlink(path);
}

static int act_access(const char *path, const struct operation *operation) {
  return access(path, operation->flags);
}

static int act_stat(const char *path, const struct operation *operation) {
  return operation->flags & AT_SYMLINK_NOFOLLOW ? lstat(path, operation->status) : stat(path, operation->status);
}

static int act_mkdir(const char *path, const struct operation *operation) {
  return mkdir(path, operation->mode);
}

int openat(int folder, const char *path, int flags, ...) {
  return act_at(folder, path, &(struct operation){.act = act_open, .flags = flags});
}

int unlinkat(int folder, const char *path, int flags) {
  return act_at(folder, path, &(struct operation){.act = act_unlink, .flags = flags});
}

int faccessat(int folder, const char *path, int mode, int flags) {
  (void)flags;
  return act_at(folder, path, &(struct operation){.act = act_access, .flags = mode});
}

int fstatat(int folder, const char *restrict path, struct stat *restrict status, int flags) {
  return act_at(folder, path, &(struct operation){.act = act_stat, .flags = flags, .status = status});
}

int mkdirat(int folder, const char *path, mode_t mode) {
  return act_at(folder, path, &(struct operation){.act = act_mkdir, .mode = mode});
}

static int act_rename_to(const char *path, const struct operation *operation) {
  return rename(operation->from, path);
}

static int act_rename_from(const char *path, const struct operation *operation) {
  return act_at(operation->flags, operation->to, &(struct operation){.act = act_rename_to, .from = path});
}

int renameat(int folder, const char *path, int to_folder, const char *to) {
  return act_at(folder, path, &(struct operation){.act = act_rename_from, .flags = to_folder, .to = to});
}
