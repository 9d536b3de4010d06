/* The search's results, read back. */
#include "worst.h"

#include "../operands.h"

#include <stdio.h>
#include <string.h>

/* "function,seed,operands,share,error x y,error x y,..." */
static void parse(const char *operands, struct found *found) {
  memset(found, 0, sizeof *found);
  for (const char *p = operands; p && found->count < MOST_FOUND; p = strchr(p + 1, ',')) {
    unsigned long long x = 0, y = 0;
    if (sscanf(p, ",%lf %llx %llx", &found->error[found->count], &x, &y) < 2)
      return;
    found->operand[found->count++] = (struct operand){double_of(x), double_of(y)};
  }
}

bool read_found(const char *path, const char *function, struct found *found) {
  FILE *file = fopen(path, "r");
  if (!file)
    return false;
  char line[1024];
  bool any = false;
  size_t length = strlen(function);
  while (!any && fgets(line, sizeof line, file)) {
    any = !strncmp(line, function, length) && line[length] == ',';
    const char *p = line;
    for (int i = 0; any && i < 4 && p; i++)
      p = strchr(p + (i > 0), ',');
    if (any)
      parse(p, found);
  }
  fclose(file);
  return any;
}
