#include "util.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

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
