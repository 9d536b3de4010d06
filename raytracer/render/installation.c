#include "installation.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

bool installation(char root[TRAX_PATH_SIZE]) {
  char self[TRAX_PATH_SIZE - 4];
  ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
  if (length <= 0)
    return false;
  self[length] = '\0';
  *strrchr(self, '/') = '\0';
  char resolved[TRAX_PATH_SIZE];
  snprintf(resolved, sizeof resolved, "%s/..", self);
  return realpath(resolved, root) != NULL;
}

bool installed_file(char path[TRAX_PATH_SIZE], const char *folder, const char *name, const char *suffix) {
  char root[TRAX_PATH_SIZE];
  if (!installation(root))
    return false;
  int written = snprintf(path, TRAX_PATH_SIZE, "%s/%s/%s%s", root, folder, name, suffix);
  return written > 0 && written < TRAX_PATH_SIZE && access(path, R_OK) == 0;
}
