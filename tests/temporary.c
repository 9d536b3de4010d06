#include "temporary.h"

#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char directory[] = "/tmp/trax-test.XXXXXX";

static void give_up(const char *path) {
  perror(path);
  exit(EXIT_FAILURE);
}

static unsigned for_each_file(void (*visit)(const char *)) {
  DIR *stream = opendir(directory);
  if (!stream)
    give_up(directory);
  unsigned count = 0;
  for (struct dirent *entry; (entry = readdir(stream));) {
    if (!strcmp(entry->d_name, ".") || !strcmp(entry->d_name, ".."))
      continue;
    count++;
    if (visit)
      visit(entry->d_name);
  }
  closedir(stream);
  return count;
}

static void remove_file(const char *name) {
  remove(test_path(name));
}

static void remove_directory(void) {
  for_each_file(remove_file);
  rmdir(directory);
}

const char *test_directory(void) {
  static bool made;
  if (!made) {
    if (!mkdtemp(directory))
      give_up(directory);
    made = true;
    atexit(remove_directory);
  }
  return directory;
}

const char *test_path(const char *name) {
  static char paths[64][512];
  static unsigned next;
  char *path = paths[next++ % 64];
  snprintf(path, sizeof paths[0], "%s/%s", test_directory(), name);
  return path;
}

unsigned count_files(void) {
  test_directory();
  return for_each_file(NULL);
}
