/* View files under libFuzzer: a refusal names its place; what is accepted is written and reads back as it was. */
#include "files.h"

#include "trax/view.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* libconfig's own leak: the text of a string that never ends. */
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

static bool same(const float *a, const float *b, size_t count) {
  return memcmp(a, b, count * sizeof *a) == 0;
}

/* Directions are made to be of unit length each time that they are read. */
static bool nearly(const float a[3], const float b[3]) {
  return fabsf(a[0] - b[0]) < 1e-6f && fabsf(a[1] - b[1]) < 1e-6f && fabsf(a[2] - b[2]) < 1e-6f;
}

static bool same_light(const struct trax_light *a, const struct trax_light *b) {
  return a->kind == b->kind && same(a->position, b->position, 3) && same(a->edges[0], b->edges[0], 6) &&
         same(a->colour, b->colour, 3) && a->strength == b->strength && a->falloff == b->falloff &&
         nearly(a->direction, b->direction);
}

static bool same_view(const struct trax_view *a, const struct trax_view *b) {
  bool equal = same(a->eye, b->eye, 3) && same(a->light, b->light, 3) && a->fov == b->fov &&
               a->light_count == b->light_count && a->has_look_at == b->has_look_at &&
               (!a->has_look_at || same(a->look_at, b->look_at, 3)) && nearly(a->direction, b->direction) &&
               nearly(a->up, b->up);
  for (uint32_t i = 0; equal && i < a->light_count; i++)
    equal = same_light(&a->lights[i], &b->lights[i]);
  return equal;
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
  if (!same_view(&view, &again)) {
    fputs("read back as another view\n", stderr);
    abort();
  }
  return 0;
}
