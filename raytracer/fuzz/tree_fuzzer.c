/* Users' trees under libFuzzer: a case's files are the arrays nodes.npy, order.npy and boxes.npy, and the words
   of its first line say for which mesh. A refusal names its place; what is accepted makes a scene that passes every
   check. */
#include "files.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TRIANGLES = 9, VERTICES = 11, MOST_WORDS = 8 };

static bool has(char *const *words, size_t count, const char *word) {
  for (size_t i = 0; i < count; i++)
    if (strcmp(words[i], word) == 0)
      return true;
  return false;
}

/* A strip; `twins`: the last triangle is where the first one is, `lamps`: they emit light. */
static void make_mesh(struct trax_mesh *mesh, bool twins, bool lamps) {
  static float vertices[VERTICES][3];
  static struct trax_mesh_triangle triangles[TRIANGLES];
  static struct trax_mesh_material material;
  memset(mesh, 0, sizeof *mesh);
  material.surface = trax_default_material;
  for (int axis = 0; axis < 3; axis++)
    material.surface.emission[axis] = lamps;
  for (uint32_t i = 0; i < VERTICES; i++)
    for (uint32_t axis = 0; axis < 3; axis++)
      vertices[i][axis] = (float)(axis == 0 ? i : i * (axis + 6) % 5);
  for (uint32_t i = 0; i < TRIANGLES; i++) {
    const uint32_t first = twins && i == TRIANGLES - 1 ? 0 : i;
    triangles[i] = (struct trax_mesh_triangle){{first, first + 1, first + 2}, 0, i};
  }
  mesh->vertices = vertices;
  mesh->vertex_count = VERTICES;
  mesh->triangles = triangles;
  mesh->triangle_count = TRIANGLES;
  mesh->materials = &material;
  mesh->material_count = 1;
}

static bool names_its_place(const char *message) {
  static const char *const places[] = {"nodes.npy: ", "order.npy: ", "boxes.npy: "};
  for (size_t i = 0; i < sizeof places / sizeof *places; i++)
    if (strncmp(message, places[i], strlen(places[i])) == 0)
      return true;
  return false;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
  fuzz_case fuzz_case;
  fuzz_case_read(&fuzz_case, bytes, size);
  fuzz_files = &fuzz_case;
  char *words[MOST_WORDS];
  const size_t count = fuzz_case_words(fuzz_case.options, words, MOST_WORDS);
  struct trax_mesh mesh;
  struct trax_scene scene;
  trax_error error = {.message = ""};
  make_mesh(&mesh, has(words, count, "twins"), has(words, count, "lamps"));
  const struct trax_build_options options = {.tree_nodes = "nodes.npy",
                                             .tree_triangles = "order.npy",
                                             .tree_boxes = fuzz_case_find(&fuzz_case, "boxes.npy") ? "boxes.npy" : NULL,
                                             .max_depth = has(words, count, "deep") ? TRAX_SCENE_MAX_DEPTH : 0,
                                             .nodes = has(words, count, "quantised") ? TRAX_NODES_QUANTISED
                                                                                     : TRAX_NODES_BINARY,
                                             .smooth = has(words, count, "smooth")};
  if (trax_scene_build(&scene, &mesh, &options, &error) != TRAX_OK) {
    if (!names_its_place(error.message)) {
      fprintf(stderr, "a message without its place: %s\n", error.message);
      abort();
    }
  } else {
    if (scene.triangle_count < TRIANGLES)
      abort();
    fuzz_check_built(&scene);
  }
  fuzz_case_free(&fuzz_case);
  return 0;
}

/* --- mutation: within files --- */

/* A small number, or the limit of a type, in place of one behind the header. */
static void change_number(fuzz_file *file, fuzz_random *random) {
  const uint32_t infinite = 0x7F800000, nan = 0x7FC00000, two = 0x40000000; /* as floats */
  const uint32_t values[] = {0,         1,          2,          3,          7,        8,   TRIANGLES - 1,
                             TRIANGLES, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, infinite, nan, two};
  const size_t header = file->size >= 64 ? 64 : 0;
  const size_t words = (file->size - header) / 4;
  if (words == 0)
    return;
  const uint32_t value = fuzz_below(random, 2) ? fuzz_below(random, 24) : values[fuzz_below(random, 14)];
  memcpy(file->bytes + header + 4 * fuzz_below(random, (uint32_t)words), &value, 4);
}

size_t LLVMFuzzerCustomMutator(uint8_t *bytes, size_t size, size_t capacity, unsigned seed) {
  static const char words[] = "twins lamps deep quantised smooth";
  fuzz_random random = {seed};
  if (fuzz_below(&random, 3) == 0)
    return fuzz_case_mutate(bytes, size, capacity, seed, words);
  fuzz_case fuzz_case;
  fuzz_case_read(&fuzz_case, bytes, size);
  for (uint32_t i = fuzz_case.file_count ? 1 + fuzz_below(&random, 4) : 0; i > 0; i--)
    change_number(&fuzz_case.files[fuzz_below(&random, (uint32_t)fuzz_case.file_count)], &random);
  size = fuzz_case_write(&fuzz_case, bytes, capacity);
  fuzz_case_free(&fuzz_case);
  return size;
}
