#include "files.h"

#include <stdlib.h>
#include <string.h>

#define MOST_UNPACKED ((size_t)1 << 20)

const fuzz_case *fuzz_files;

trax_status __wrap_scene_load_file(struct scene_bytes *bytes, const char *path, struct scene_limits limits,
                                   trax_error *error);
trax_status __wrap_scene_load_text(struct scene_bytes *bytes, const char *path, struct scene_limits limits,
                                   trax_error *error);
trax_status __wrap_scene_load_referred(struct scene_bytes *bytes, const char *path, struct scene_limits limits);

/* Allocates exactly the file's bytes and, for texts, a NUL, so that a sanitizer sees reads beyond them. */
static trax_status load(struct scene_bytes *bytes, const char *path, size_t more, trax_error *error) {
  const char *slash = strrchr(path, '/');
  const fuzz_file *file = fuzz_case_find(fuzz_files, slash ? slash + 1 : path);
  *bytes = (struct scene_bytes){0};
  if (!file)
    return trax_fail(error, "%s: cannot open: it is not in the case", path);
  bytes->data = calloc(1, file->size + more ? file->size + more : 1);
  if (!bytes->data)
    abort();
  if (file->size)
    memcpy(bytes->data, file->bytes, file->size);
  bytes->size = file->size;
  const unsigned char *const packed = bytes->data;
  const trax_status result = scene_unpack(bytes, MOST_UNPACKED, path, error);
  if (result == TRAX_OK && bytes->data != packed && more && scene_terminate(bytes) != TRAX_OK)
    abort();
  return result;
}

trax_status __wrap_scene_load_file(struct scene_bytes *bytes, const char *path, struct scene_limits limits,
                                   trax_error *error) {
  (void)limits;
  return load(bytes, path, 0, error);
}

trax_status __wrap_scene_load_text(struct scene_bytes *bytes, const char *path, struct scene_limits limits,
                                   trax_error *error) {
  (void)limits;
  return load(bytes, path, 1, error);
}

trax_status __wrap_scene_load_referred(struct scene_bytes *bytes, const char *path, struct scene_limits limits) {
  (void)limits;
  return load(bytes, path, 0, NULL);
}
