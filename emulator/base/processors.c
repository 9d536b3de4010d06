#define _GNU_SOURCE /* sched_getaffinity, getline */
#include "trax/processors.h"

#include <limits.h>
#include <sched.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PATH = 4096, MOST_PROCESSORS = 1 << 16 };

/* --- files --- */

/* Joins root, directory and name to one path. False: the path is too long. */
static bool join(char path[PATH], const char *root, const char *directory, const char *name) {
  const int length = snprintf(path, PATH, "%s%s%s%s", root, directory, *name ? "/" : "", name);
  return length > 0 && length < PATH;
}

/* Reads up to two numbers at the beginning of a file and returns how many it has read. */
static int read_numbers(const char *root, const char *directory, const char *name, long long number[2]) {
  char path[PATH];
  FILE *file = join(path, root, directory, name) ? fopen(path, "re") : NULL;
  if (!file)
    return 0;
  const int count = fscanf(file, "%lld %lld", &number[0], &number[1]);
  fclose(file);
  return count > 0 ? count : 0;
}

/* Whether `list`, words separated by commas, contains the word. */
static bool has_word(const char *list, const char *word) {
  const size_t length = strlen(word);
  for (const char *at = list; (at = strstr(at, word)); at += length)
    if ((at == list || at[-1] == ',') && (at[length] == ',' || !at[length]))
      return true;
  return false;
}

/* --- control groups --- */

static unsigned whole_processors(long long quota, long long period) {
  if (quota <= 0 || period <= 0)
    return UINT_MAX; /* no quota */
  const long long processors = quota / period;
  return processors < 1 ? 1 : processors < UINT_MAX ? (unsigned)processors : UINT_MAX;
}

static unsigned quota_of_directory(const char *root, const char *directory, bool second_version) {
  long long number[2], period[2];
  if (second_version) /* "QUOTA PERIOD", or "max PERIOD" for no quota */
    return read_numbers(root, directory, "cpu.max", number) == 2 ? whole_processors(number[0], number[1]) : UINT_MAX;
  return read_numbers(root, directory, "cpu.cfs_quota_us", number) >= 1 &&
                 read_numbers(root, directory, "cpu.cfs_period_us", period) >= 1
             ? whole_processors(number[0], period[0])
             : UINT_MAX;
}

/* Returns the path of the process's group, from malloc, or NULL if there is none. The line is "0::PATH" for version 2
   and "N:...,cpu,...:PATH" for version 1. */
static char *group_path(const char *root, bool second_version) {
  char path[PATH], *line = NULL, *found = NULL;
  size_t size = 0;
  FILE *file = join(path, root, "/proc/self/cgroup", "") ? fopen(path, "re") : NULL;
  while (file && !found && getline(&line, &size, file) > 0) {
    line[strcspn(line, "\n")] = '\0';
    char *controllers = strchr(line, ':'), *group = controllers ? strchr(++controllers, ':') : NULL;
    if (!group)
      continue;
    *group++ = '\0';
    if (second_version ? strncmp(line, "0:", 2) == 0 && !*controllers : has_word(controllers, "cpu"))
      found = strdup(group);
  }
  free(line);
  if (file)
    fclose(file);
  return found;
}

/* Decodes \ooo, by which mountinfo writes blanks and backslashes. */
static void unescape(char *text) {
  char *to = text;
  for (; *text; to++)
    if (text[0] == '\\' && text[1] && text[2] && text[3]) {
      *to = (char)((text[1] - '0') << 6 | (text[2] - '0') << 3 | (text[3] - '0'));
      text += 4;
    } else {
      *to = *text++;
    }
  *to = '\0';
}

/* Returns the least quota of the group and of those groups that contain it and are in the mount. */
static unsigned quota_of_mount(const char *root, char *mounted, char *mount_point, bool second_version) {
  char *group = group_path(root, second_version), directory[PATH];
  unsigned least = UINT_MAX;
  if (!group)
    return least;
  unescape(mounted);
  unescape(mount_point);
  const size_t length = strcmp(mounted, "/") == 0 ? 0 : strlen(mounted);
  const bool below = strncmp(group, mounted, length) == 0 && (group[length] == '/' || !group[length]);
  const size_t begin = strlen(mount_point);
  if (snprintf(directory, PATH, "%s%s", mount_point, below ? group + length : "") >= PATH)
    directory[begin] = '\0';
  while (true) {
    const unsigned quota = quota_of_directory(root, directory, second_version);
    least = quota < least ? quota : least;
    char *last = strrchr(directory, '/');
    if (!last || last < directory + begin)
      break;
    *last = '\0';
  }
  free(group);
  return least;
}

unsigned trax_quota_processors(const char *root) {
  char path[PATH], *line = NULL;
  size_t size = 0;
  unsigned least = UINT_MAX;
  FILE *file = join(path, root, "/proc/self/mountinfo", "") ? fopen(path, "re") : NULL;
  while (file && getline(&line, &size, file) > 0) {
    char mounted[PATH], mount_point[PATH], type[64], options[PATH] = "";
    const char *separator = strstr(line, " - "); /* a variable number of optional fields precedes it */
    if (!separator || sscanf(line, "%*s %*s %*s %4095s %4095s", mounted, mount_point) != 2 ||
        sscanf(separator, " - %63s %*s %4095s", type, options) < 1)
      continue;
    const bool second_version = strcmp(type, "cgroup2") == 0;
    if (!second_version && (strcmp(type, "cgroup") != 0 || !has_word(options, "cpu")))
      continue;
    const unsigned quota = quota_of_mount(root, mounted, mount_point, second_version);
    least = quota < least ? quota : least;
  }
  free(line);
  if (file)
    fclose(file);
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
