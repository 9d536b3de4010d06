#define _GNU_SOURCE /* sched_getaffinity, getline */
#include "trax/processors.h"

#include <limits.h>
#include <sched.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PATH = 4096, MOST_PROCESSORS = 1 << 16 };

/* --- control groups, as Linux mounts their second version at /sys/fs/cgroup --- */

/* Returns the whole processors of a group's quota, "QUOTA PERIOD"; UINT_MAX if there is none, as for "max PERIOD". */
static unsigned quota_of(const char *directory) {
  char path[PATH];
  long long quota = 0, period = 0;
  FILE *file = snprintf(path, sizeof path, "%s/cpu.max", directory) < PATH ? fopen(path, "re") : NULL;
  const bool limited = file && fscanf(file, "%lld %lld", &quota, &period) == 2 && quota > 0 && period > 0;
  if (file)
    fclose(file);
  if (!limited)
    return UINT_MAX;
  const long long processors = quota / period;
  return processors < 1 ? 1 : processors < UINT_MAX ? (unsigned)processors : UINT_MAX;
}

/* Appends the path of the process's group, which the line "0::PATH" has. */
static void append_group(char directory[PATH], const char *root) {
  char path[PATH], *line = NULL;
  size_t size = 0;
  const size_t length = strlen(directory);
  FILE *file = snprintf(path, sizeof path, "%s/proc/self/cgroup", root) < PATH ? fopen(path, "re") : NULL;
  while (file && getline(&line, &size, file) > 0) {
    line[strcspn(line, "\n")] = '\0';
    if (strncmp(line, "0::/", 4) == 0 &&
        snprintf(directory + length, PATH - length, "%s", line + 3) >= (int)(PATH - length))
      directory[length] = '\0';
  }
  free(line);
  if (file)
    fclose(file);
}

unsigned trax_quota_processors(const char *root) {
  char directory[PATH];
  const int begin = snprintf(directory, sizeof directory, "%s/sys/fs/cgroup", root);
  unsigned least = UINT_MAX;
  if (begin >= PATH)
    return least;
  append_group(directory, root);
  for (char *end = directory; end; end = strrchr(directory + begin, '/')) { /* the group, and those that contain it */
    if (end != directory)
      *end = '\0';
    const unsigned quota = quota_of(directory);
    least = quota < least ? quota : least;
  }
  return least;
}

/* --- affinity --- */

static unsigned affine_processors(void) {
  for (int processors = CPU_SETSIZE; processors <= MOST_PROCESSORS; processors *= 2) { /* until the mask fits */
    cpu_set_t *set = CPU_ALLOC((size_t)processors);
    const size_t bytes = CPU_ALLOC_SIZE((size_t)processors);
    const int count = set && sched_getaffinity(0, bytes, set) == 0 ? CPU_COUNT_S(bytes, set) : 0;
    CPU_FREE(set);
    if (count > 0)
      return (unsigned)count;
  }
  return 1;
}

unsigned trax_host_processors(void) {
  const unsigned affine = affine_processors(), quota = trax_quota_processors("");
  return quota < affine ? quota : affine;
}
