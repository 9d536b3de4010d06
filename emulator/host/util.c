#include "util.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

enum { LONGEST_NAME = 63 }; /* longer ones get no suggestion */

/* Insertions, deletions, substitutions and exchanges of neighbours that turn a into b (optimal string alignment). */
static unsigned edit_distance(const char *a, const char *b) {
  size_t rows = strlen(a), columns = strlen(b);
  unsigned row[3][LONGEST_NAME + 1];
  for (size_t j = 0; j <= columns; ++j)
    row[0][j] = (unsigned)j;
  for (size_t i = 1; i <= rows; ++i) {
    unsigned *now = row[i % 3], *above = row[(i + 2) % 3], *two_above = row[(i + 1) % 3];
    now[0] = (unsigned)i;
    for (size_t j = 1; j <= columns; ++j) {
      unsigned best = above[j - 1] + (a[i - 1] != b[j - 1]);
      if (above[j] + 1 < best)
        best = above[j] + 1;
      if (now[j - 1] + 1 < best)
        best = now[j - 1] + 1;
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] && two_above[j - 2] + 1 < best)
        best = two_above[j - 2] + 1;
      now[j] = best;
    }
  }
  return row[rows % 3][columns];
}

const char *trax_nearest_name(const char *mistyped, size_t count, const char *(*name)(const void *context, size_t i),
                              const void *context) {
  size_t length = strlen(mistyped);
  if (length > LONGEST_NAME)
    return NULL;
  unsigned nearest = length / 3 < 2 ? (unsigned)(length / 3) + 1 : 3;
  const char *result = NULL;
  for (size_t i = 0; i < count; ++i) {
    const char *candidate = name(context, i);
    if (strlen(candidate) > LONGEST_NAME)
      continue;
    unsigned distance = edit_distance(mistyped, candidate);
    if (distance < nearest) {
      nearest = distance;
      result = candidate;
    }
  }
  return result;
}

trax_status trax_read_file(const char *path, size_t limit, uint8_t **bytes, size_t *size, trax_error *error) {
  FILE *file = fopen(path, "rb");
  if (!file)
    return trax_fail(error, "%s: cannot be read: %s", path, strerror(errno));
  uint8_t *data = NULL;
  size_t used = 0, capacity = 0;
  for (;;) {
    if (used == capacity) {
      capacity = capacity ? capacity * 2 : 1 << 16;
      if (capacity > limit)
        capacity = limit + 1; /* room for the byte that proves the file too large */
      uint8_t *grown = realloc(data, capacity + 1);
      if (!grown) {
        free(data);
        fclose(file);
        return trax_fail(error, "%s: out of memory after %zu bytes", path, used);
      }
      data = grown;
    }
    errno = 0;
    size_t got = fread(data + used, 1, capacity - used, file);
    used += got;
    if (used > limit || got == 0)
      break;
  }
  int failure = ferror(file) ? (errno ? errno : EIO) : 0;
  fclose(file);
  if (failure || used > limit) {
    free(data);
    return failure ? trax_fail(error, "%s: cannot be read: %s", path, strerror(failure))
                   : trax_fail(error, "%s: more than %zu bytes", path, limit);
  }
  data[used] = 0;
  *bytes = data;
  *size = used;
  return TRAX_OK;
}
