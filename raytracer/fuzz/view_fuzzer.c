/* View files under libFuzzer: a refusal names its place; what is accepted is written and reads back as it was. */
#include "files.h"

#include "trax/view.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Of libconfig's own: the text of a string that never ends. */
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) {
  return "leak:libconfig";
}

trax_status __wrap_trax_write_file(const char *path, const void *bytes, size_t size, trax_error *error);

static fuzz_case current;

static void put(const void *bytes, size_t size) {
  fuzz_case_free(&current);
  current = (fuzz_case){.file_count = 1, .files = {{.name = "v.view", .size = size}}};
  current.files[0].bytes = malloc(size ? size : 1);
  if (!current.files[0].bytes)
    abort();
  if (size)
    memcpy(current.files[0].bytes, bytes, size);
  fuzz_files = &current;
}

trax_status __wrap_trax_write_file(const char *path, const void *bytes, size_t size, trax_error *error) {
  (void)path, (void)error;
  put(bytes, size);
  return TRAX_OK;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
  struct trax_view view, again;
  trax_error error = {.message = ""};
  put(bytes, size);
  if (trax_view_read(&view, "v.view", &error) != TRAX_OK) {
    if (strncmp(error.message, "v.view:", 7) != 0) {
      fprintf(stderr, "a message without its place: %s\n", error.message);
      abort();
    }
    return 0;
  }
  if (trax_view_write(&view, "v.view", &error) != TRAX_OK || trax_view_read(&again, "v.view", &error) != TRAX_OK) {
    fprintf(stderr, "what was written is refused: %s\n", error.message);
    abort();
  }
  if (memcmp(view.eye, again.eye, sizeof view.eye) != 0 || memcmp(view.light, again.light, sizeof view.light) != 0 ||
      view.fov != again.fov || view.light_count != again.light_count || view.has_look_at != again.has_look_at) {
    fputs("read back as another view\n", stderr);
    abort();
  }
  return 0;
}
