/* Files by descriptor: what is done by several host calls, and what has no effect here. */
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

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

/* There is one process, so that all locks are free, and nothing is inherited. */
int fcntl(int descriptor, int command, ...) {
  struct stat status;
  if (fstat(descriptor, &status))
    return -1;
  switch (command) {
  case F_GETFD:
  case F_SETFD:
  case F_SETFL:
  case F_SETLK:
  case F_SETLKW:
    return 0;
  case F_GETFL:
    return O_RDWR;
  case F_GETLK: {
    __builtin_va_list arguments;
    __builtin_va_start(arguments, command);
    __builtin_va_arg(arguments, struct flock *)->l_type = F_UNLCK;
    __builtin_va_end(arguments);
    return 0;
  }
  default:
    errno = EINVAL;
    return -1;
  }
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
