/* The only process: number 1, without an environment. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../internal/host.h"

__attribute__((weak)) char *__trax_find_variable(const char *name); /* in programs that set variables */

char *getenv(const char *name) {
  return __trax_find_variable ? __trax_find_variable(name) : NULL;
}

int system(const char *command) {
  if (!command)
    return 0;
  errno = ENOSYS;
  return -1;
}

void __trax_not_here(void) {
  errno = ENOSYS;
}

void _exit(int status) {
  _Exit(status);
}

pid_t getpid(void) {
  return 1;
}

uid_t getuid(void) {
  return 0;
}

uid_t geteuid(void) {
  return 0;
}

gid_t getgid(void) {
  return 0;
}

gid_t getegid(void) {
  return 0;
}

int gethostname(char *name, size_t size) {
  return strlcpy(name, "trax", size) < size ? 0 : host_result(-ENAMETOOLONG);
}

long sysconf(int name) {
  switch (name) {
  case _SC_PAGESIZE:
    return 4096;
  case _SC_NPROCESSORS_ONLN:
    return 1;
  case _SC_OPEN_MAX:
    return 256;
  case _SC_CLK_TCK:
    return 1000000000;
  default:
    errno = EINVAL;
    return -1;
  }
}
