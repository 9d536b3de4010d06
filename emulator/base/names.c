#include "trax/names.h"
#include "trax/options.h"

#include <stdio.h>
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

static const char *option_name(const void *options, size_t i) {
  return ((const struct option *)options)[i].name;
}

/* A long option that is none, or is not said far enough. */
static trax_status wrong_name(const struct option *options, const char *text, trax_error *error) {
  char name[64], candidates[600] = "";
  const int length = (int)strcspn(text, "=");
  size_t count = 0, used = 0;
  unsigned matches = 0;
  snprintf(name, sizeof name, "%.*s", length, text);
  for (; options[count].name; count++)
    if (length > 0 && strncmp(options[count].name, text, (size_t)length) == 0 && used < sizeof candidates)
      used += (size_t)snprintf(candidates + used, sizeof candidates - used, "%s--%s", matches++ ? ", " : "",
                               options[count].name);
  if (matches)
    return trax_fail(error, "--%s is ambiguous: %s", name, candidates);
  const char *nearest = trax_nearest_name(name, count, option_name, options);
  return nearest ? trax_fail(error, "unknown option --%s; did you mean --%s?", name, nearest)
                 : trax_fail(error, "unknown option --%s", name);
}

trax_status trax_wrong_option(const struct option *options, char **argv, int which, trax_error *error) {
  const char *text = argv[optind - 1]; /* but for a letter among others, behind which it has not moved */
  if (which == ':')
    return strncmp(text, "--", 2) == 0 ? trax_fail(error, "%s needs a value", text)
                                       : trax_fail(error, "-%c needs a value", optopt);
  if (!optopt)
    return wrong_name(options, text + 2, error);
  for (; options->name; options++)
    if (options->val == optopt)
      return trax_fail(error, "--%s takes no value", options->name);
  return trax_fail(error, "unknown option -%c", optopt);
}
