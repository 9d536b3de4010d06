/* Sequences: a file a frame, whose number stands in the name. */
#include "internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const char *scene_find_number(const char *path, int *digits, size_t *length) {
  for (const char *at = strchr(path, '%'); at; at = strchr(at + 1, '%')) {
    *digits = at[1] == '0' && at[2] >= '1' && at[2] <= '9' ? at[2] - '0' : 0;
    *length = *digits ? 4 : 2;
    if (at[*length - 1] == 'd')
      return at;
  }
  return NULL;
}

trax_status scene_name_at(char **name, const char *path, const struct trax_import_options *options,
                          struct trax_import_report *report, trax_error *error) {
  enum { MOST = 1000000000 };
  int digits;
  size_t length;
  const char *place = scene_find_number(path, &digits, &length);
  if (place && !options->moves && access(path, F_OK) != 0)
    return trax_fail(error, "%s: there is no such file; --at 12 takes that of frame 12", path);
  if (!options->moves)
    place = NULL;
  if (place && !(options->at >= 0 && options->at < MOST && options->at == floor(options->at)))
    return trax_fail(error, "%s: there is no frame %g; a frame is a whole number", path, options->at);
  report->moved = place != NULL;
  *name = malloc(strlen(path) + 16);
  if (!*name)
    return scene_out_of_memory(error, path);
  if (place)
    sprintf(*name, "%.*s%0*u%s", (int)(place - path), path, digits, (unsigned)options->at, place + length);
  else
    strcpy(*name, path);
  return place ? trax_files_check_input(options->files, *name, error) : TRAX_OK;
}
