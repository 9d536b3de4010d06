/* Files by descriptor and by name. */
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>
#include <utime.h>

#include "../internal/host.h"

int open(const char *path, int flags, ...) {
  return host_result(host_call(TRAX_HOST_OPEN, (uintptr_t)path, (unsigned)flags, 0));
}

int creat(const char *path, mode_t mode) {
  (void)mode;
  return open(path, O_WRONLY | O_CREAT | O_TRUNC);
}

int close(int descriptor) {
  return host_result(host_call(TRAX_HOST_CLOSE, (unsigned)descriptor, 0, 0));
}

ssize_t read(int descriptor, void *memory, size_t size) {
  return host_result(host_call(TRAX_HOST_READ, (unsigned)descriptor, (uintptr_t)memory, size));
}

ssize_t write(int descriptor, const void *memory, size_t size) {
  return host_result(host_call(TRAX_HOST_WRITE, (unsigned)descriptor, (uintptr_t)memory, size));
}

off_t lseek(int descriptor, off_t offset, int origin) {
  int result = host_call(TRAX_HOST_SEEK, (unsigned)descriptor, (uintptr_t)&offset, (unsigned)origin);
  return host_result(result) < 0 ? -1 : offset;
}

int ftruncate(int descriptor, off_t size) {
  return host_result(host_call(TRAX_HOST_TRUNCATE, (unsigned)descriptor, (uintptr_t)&size, 0));
}

int isatty(int descriptor) {
  int result = host_result(host_call(TRAX_HOST_TERMINAL, (unsigned)descriptor, 0, 0));
  if (result == 0)
    errno = ENOTTY;
  return result > 0;
}

int fsync(int descriptor) {
  return host_result(host_call(TRAX_HOST_TERMINAL, (unsigned)descriptor, 0, 0)) < 0 ? -1 : 0;
}

/* --- names --- */

int unlink(const char *path) {
  return host_result(host_call(TRAX_HOST_REMOVE, (uintptr_t)path, 0, 0));
}

int mkdir(const char *path, mode_t mode) {
  (void)mode;
  return host_result(host_call(TRAX_HOST_MAKE_FOLDER, (uintptr_t)path, 0, 0));
}

int rmdir(const char *path) {
  return host_result(host_call(TRAX_HOST_REMOVE_FOLDER, (uintptr_t)path, 0, 0));
}

char *getcwd(char *to, size_t size) {
  if (size < 2 && to) {
    errno = ERANGE;
    return NULL;
  }
  return to ? strcpy(to, "/") : strdup("/");
}

int chdir(const char *path) {
  (void)path;
  errno = ENOSYS;
  return -1;
}

char *realpath(const char *restrict path, char *restrict resolved) {
  struct stat status;
  if (stat(path, &status))
    return NULL;
  return resolved ? strcpy(resolved, path) : strdup(path);
}

/* The names are tried in their order, so that a run gives the same every time. */
int mkstemp(char *pattern) {
  size_t length = strlen(pattern);
  char *last = pattern + length - 6;
  if (length < 6 || strcmp(last, "XXXXXX") != 0) {
    errno = EINVAL;
    return -1;
  }
  for (unsigned number = 0; number < 1000000; number++) {
    for (unsigned i = 6, rest = number; i-- > 0; rest /= 10)
      last[i] = (char)('0' + rest % 10);
    int descriptor = open(pattern, O_RDWR | O_CREAT | O_EXCL);
    if (descriptor >= 0 || errno != EEXIST)
      return descriptor;
  }
  return -1;
}

/* --- their state --- */

static int take_stat(int result, const unsigned words[TRAX_STAT_WORDS], struct stat *status) {
  if (host_result(result) < 0)
    return -1;
  memset(status, 0, sizeof *status);
  status->st_mode = words[TRAX_STAT_MODE];
  status->st_nlink = 1;
  status->st_size = (off_t)((unsigned long long)words[TRAX_STAT_SIZE + 1] << 32 | words[TRAX_STAT_SIZE]);
  status->st_ino = (ino_t)((unsigned long long)words[TRAX_STAT_FILE + 1] << 32 | words[TRAX_STAT_FILE]);
  status->st_blksize = 4096;
  status->st_blocks = (status->st_size + 511) / 512;
  return 0;
}

int stat(const char *restrict path, struct stat *restrict status) {
  unsigned words[TRAX_STAT_WORDS];
  return take_stat(host_call(TRAX_HOST_STAT, (uintptr_t)path, (uintptr_t)words, 1), words, status);
}

int lstat(const char *restrict path, struct stat *restrict status) {
  unsigned words[TRAX_STAT_WORDS];
  return take_stat(host_call(TRAX_HOST_STAT, (uintptr_t)path, (uintptr_t)words, 0), words, status);
}

int fstat(int descriptor, struct stat *status) {
  unsigned words[TRAX_STAT_WORDS];
  return take_stat(host_call(TRAX_HOST_FSTAT, (unsigned)descriptor, (uintptr_t)words, 0), words, status);
}

int access(const char *path, int mode) {
  struct stat status;
  if (stat(path, &status))
    return -1;
  if (((unsigned)mode & 7) << 6 & ~status.st_mode) {
    errno = EACCES;
    return -1;
  }
  return 0;
}

/* --- owners and permissions, without effect --- */

/* 0 if the file exists. */
static int known(const char *path) {
  struct stat status;
  return stat(path, &status);
}

static int known_descriptor(int descriptor) {
  struct stat status;
  return fstat(descriptor, &status);
}

int chmod(const char *path, mode_t mode) {
  (void)mode;
  return known(path);
}

int fchmod(int descriptor, mode_t mode) {
  (void)mode;
  return known_descriptor(descriptor);
}

mode_t umask(mode_t mask) {
  (void)mask;
  return 022;
}

int chown(const char *path, uid_t owner, gid_t group) {
  (void)owner;
  (void)group;
  return known(path);
}

int fchown(int descriptor, uid_t owner, gid_t group) {
  (void)owner;
  (void)group;
  return known_descriptor(descriptor);
}

int utime(const char *path, const struct utimbuf *times) {
  (void)times;
  return known(path);
}

int utimes(const char *path, const struct timeval times[2]) {
  (void)times;
  return known(path);
}
