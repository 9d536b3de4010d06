#include "trax/names.h"

#include <string.h>

enum { LONGEST_NAME = 63 }; /* longer ones get no suggestion */

/* The least number of insertions, deletions, substitutions and exchanges of neighbours that turn a into b (optimal
   string alignment). */
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
