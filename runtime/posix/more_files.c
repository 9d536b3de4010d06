/* Files by descriptor: functions that take several host calls, and those without effect here. */
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../internal/host.h"

static ssize_t at_place(int descriptor, off_t place, ssize_t (*access)(int, void *, size_t), void *memory,
                        size_t size) {
  const off_t before = lseek(descriptor, 0, SEEK_CUR);
  if (before < 0 || lseek(descriptor, place, SEEK_SET) < 0)
    return -1;
  const ssize_t done = access(descriptor, memory, size);
  const int number = errno;
  lseek(descriptor, before, SEEK_SET);
  errno = number;
  return done;
}

static ssize_t write_from(int descriptor, void *memory, size_t size) {
  return write(descriptor, memory, size);
}

ssize_t pread(int descriptor, void *memory, size_t size, off_t place) {
  return at_place(descriptor, place, read, memory, size);
}

ssize_t pwrite(int descriptor, const void *memory, size_t size, off_t place) {
  return at_place(descriptor, place, write_from, (void *)(uintptr_t)memory, size);
}

int dup(int descriptor) {
  return host_result(host_call(TRAX_HOST_DUPLICATE, (unsigned)descriptor, 0, 0));
}

int dup2(int descriptor, int other) {
  return host_result(host_call(TRAX_HOST_DUPLICATE, (unsigned)descriptor, (unsigned)other, 1));
}

/* There is one process, so that all locks are free, and nothing is inherited. */
int fcntl(int descriptor, int command, ...) {
  struct stat status;
  va_list arguments;
  if (fstat(descriptor, &status))
    return -1;
  va_start(arguments, command);
  int result = 0;
  switch (command) {
  case F_DUPFD:
  case F_DUPFD_CLOEXEC:
    result = host_result(host_call(TRAX_HOST_DUPLICATE, (unsigned)descriptor, va_arg(arguments, unsigned), 0));
    break;
  case F_GETFD:
  case F_SETFD:
  case F_SETFL:
  case F_SETLK:
  case F_SETLKW:
    break;
  case F_GETFL:
    result = O_RDWR;
    break;
  case F_GETLK:
    va_arg(arguments, struct flock *)->l_type = F_UNLCK;
    break;
  default:
    errno = EINVAL;
    result = -1;
  }
  va_end(arguments);
  return result;
}

int truncate(const char *path, off_t size) {
  const int descriptor = open(path, O_RDWR);
  if (descriptor < 0)
    return -1;
  const int result = ftruncate(descriptor, size), number = errno;
  close(descriptor);
  errno = number;
  return result;
}

int fdatasync(int descriptor) {
  return fsync(descriptor);
}

int getpagesize(void) {
  return 4096;
}

int getdtablesize(void) {
  return 256; /* the host's */
}

int pipe(int descriptors[2]) {
  (void)descriptors;
  errno = ENOSYS;
  return -1;
}

int futimens(int descriptor, const struct timespec times[2]) {
  struct stat status;
  (void)times;
  return fstat(descriptor, &status);
}

ssize_t readlink(const char *restrict path, char *restrict to, size_t size) {
  struct stat status;
  (void)to;
  (void)size;
  if (lstat(path, &status))
    return -1;
  errno = S_ISLNK(status.st_mode) ? ENOSYS : EINVAL;
  return -1;
}

/* The names are tried in their order, as in mkstemp. */
char *mkdtemp(char *pattern) {
  const size_t length = strlen(pattern);
  char *last = pattern + length - 6;
  if (length < 6 || strcmp(last, "XXXXXX") != 0) {
    errno = EINVAL;
    return NULL;
  }
  for (unsigned number = 0; number < 1000000; number++) {
    for (unsigned i = 6, rest = number; i-- > 0; rest /= 10)
      last[i] = (char)('0' + rest % 10);
    if (mkdir(pattern, 0700) == 0)
      return pattern;
    if (errno != EEXIST)
      break;
  }
  return NULL;
}
