/* Files of rays under libFuzzer (trax-render --rays). A refusal names its place; what is accepted is brought into every
   order, each of which has every ray once, over a scene of two boxes. */
#include "fuzz_case.h"
#include "internal.h"
#include "rays.h"
#include "trax/input.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TREELET_BYTES = 256 };

static const uint8_t *file_bytes;
static size_t file_size;

trax_status __wrap_trax_read_file(const char *path, size_t limit, uint8_t **bytes, size_t *size, trax_error *error);

/* Allocates exactly the file's bytes, so that a sanitizer sees reads beyond them. */
trax_status __wrap_trax_read_file(const char *path, size_t limit, uint8_t **bytes, size_t *size, trax_error *error) {
  if (file_size > limit)
    return trax_fail(error, "%s: too large", path);
  if (!(*bytes = malloc(file_size ? file_size : 1)))
    abort();
  if (file_size)
    memcpy(*bytes, file_bytes, file_size);
  *size = file_size;
  return TRAX_OK;
}

/* The scene is made again for each case, since a frame scales it. */
static void make_scene(struct trax_scene *scene, enum trax_node_layout layout) {
  enum { TRIANGLES = 24 };
  static float vertices[TRIANGLES + 2][3];
  static struct trax_mesh_triangle triangles[TRIANGLES];
  static struct trax_mesh_material material;
  trax_error error;
  material.surface = trax_default_material;
  for (uint32_t i = 0; i < TRIANGLES + 2; i++)
    for (uint32_t axis = 0; axis < 3; axis++)
      vertices[i][axis] = (float)(i * (axis + 5) % 11) - 3;
  for (uint32_t i = 0; i < TRIANGLES; i++)
    triangles[i] = (struct trax_mesh_triangle){{i, i + 1, i + 2}, 0, i};
  const struct trax_mesh mesh = {.vertices = vertices,
                                 .vertex_count = TRIANGLES + 2,
                                 .triangles = triangles,
                                 .triangle_count = TRIANGLES,
                                 .materials = &material,
                                 .material_count = 1};
  if (trax_scene_build(scene, &mesh, &(struct trax_build_options){.nodes = layout, .max_leaf = 2}, &error) != TRAX_OK)
    abort();
}

static void check_orders(struct trax_rays *rays, const struct trax_scene *scene) {
  for (enum trax_ray_order order = TRAX_RAYS_FOUND; order <= TRAX_RAYS_RANDOM; order++) {
    trax_error error;
    if (trax_rays_order(rays, order, scene, TREELET_BYTES, &error) != TRAX_OK)
      abort();
    unsigned char *seen = calloc(rays->count, 1);
    if (!seen)
      abort();
    for (uint32_t i = 0; i < rays->count; i++)
      if (rays->order[i] >= rays->count || seen[rays->order[i]]++)
        abort(); /* a ray is lost */
    free(seen);
  }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
  struct trax_rays rays;
  trax_error error = {.message = ""};
  file_bytes = bytes, file_size = size;
  if (trax_rays_read(&rays, "file.rays", &error) != TRAX_OK) {
    if (strncmp(error.message, "file.rays: ", 11) != 0) {
      fprintf(stderr, "a message without its place: %s\n", error.message);
      abort();
    }
    return 0;
  }
  struct trax_scene scene;
  struct trax_frame frame = {0};
  make_scene(&scene, (enum trax_node_layout)(size / sizeof *rays.records % TRAX_NODE_LAYOUTS));
  if (trax_rays_frame(&frame, &scene, &rays, &error) == TRAX_OK)
    check_orders(&rays, &scene);
  else if (!error.message[0])
    abort(); /* an error without a reason */
  trax_frame_release(&frame);
  trax_scene_release(&scene);
  trax_rays_release(&rays);
  return 0;
}

/* --- mutation: words, of the header or of a ray --- */

size_t LLVMFuzzerCustomMutator(uint8_t *bytes, size_t size, size_t capacity, unsigned seed) {
  static const uint32_t words[] = {0,          1,          0x80000000, 0x7F800000, 0x7FC00000, 0xFF800000, 0x3F800000,
                                   0x3E800000, 0x3E7FFFFF, 0x44800000, 0x44800001, 0x7F000000, 0x7F7FFFFF, 0x00000001,
                                   0x00800000, 64,         127,        -150u,      0xBF800000, 0x01010000};
  fuzz_random random = {seed + 1u};
  const size_t record = sizeof(struct trax_ray_record), header = sizeof(struct trax_ray_file_header);
  if (size < header + record || fuzz_below(&random, 8) == 0)
    return LLVMFuzzerMutate(bytes, size, capacity);
  if (fuzz_below(&random, 4) == 0 && size + record <= capacity) { /* one ray more */
    const size_t from = header + record * fuzz_below(&random, (uint32_t)((size - header) / record));
    memcpy(bytes + size, bytes + from, record);
    return size + record;
  }
  for (uint32_t count = 1 + fuzz_below(&random, 3); count > 0; count--) {
    const size_t end = fuzz_below(&random, 8) ? size : header;
    uint32_t word = words[fuzz_below(&random, sizeof words / sizeof *words)];
    uint8_t *at = bytes + 4 * (size_t)fuzz_below(&random, (uint32_t)(end / 4));
    if (fuzz_below(&random, 3) == 0) { /* near what is there */
      memcpy(&word, at, 4);
      word += fuzz_below(&random, 3) - 1 + (fuzz_below(&random, 2) << fuzz_below(&random, 32));
    }
    memcpy(at, &word, 4);
  }
  return size;
}
