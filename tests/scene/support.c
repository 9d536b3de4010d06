#include "support.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

const char *test_file(const char *name, const void *bytes, size_t size) {
  const char *path = test_path(name);
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(bytes, 1, size, file), size);
  assert_int_equal(fclose(file), 0);
  return path;
}

const char *test_text(const char *name, const char *text) {
  return test_file(name, text, strlen(text));
}

void append(unsigned char *bytes, size_t *size, const void *more, size_t count) {
  memcpy(bytes + *size, more, count);
  *size += count;
}

float random_unit(uint32_t *state) {
  *state = *state * 1664525u + 1013904223u;
  return (float)(*state >> 8) * 0x1p-24f;
}

void mesh_triangle(struct trax_mesh *mesh, const float a[3], const float b[3], const float c[3], uint32_t material) {
  const float *corners[3] = {a, b, c};
  mesh->vertices = realloc(mesh->vertices, (mesh->vertex_count + 3u) * sizeof *mesh->vertices);
  mesh->triangles = realloc(mesh->triangles, (mesh->triangle_count + 1u) * sizeof *mesh->triangles);
  assert_non_null(mesh->vertices);
  assert_non_null(mesh->triangles);
  while (mesh->material_count <= material) {
    mesh->materials = realloc(mesh->materials, (mesh->material_count + 1u) * sizeof *mesh->materials);
    assert_non_null(mesh->materials);
    float grey = 1.0f / (float)(mesh->material_count + 2);
    mesh->materials[mesh->material_count++] = (struct trax_mesh_material){.surface = {.diffuse = {grey, grey, grey}}};
  }
  struct trax_mesh_triangle *triangle = &mesh->triangles[mesh->triangle_count];
  for (uint32_t i = 0; i < 3; i++) {
    memcpy(mesh->vertices[mesh->vertex_count], corners[i], 3 * sizeof(float));
    triangle->vertices[i] = mesh->vertex_count++;
  }
  triangle->material = material;
  triangle->source_id = mesh->triangle_count++;
}

void mesh_soup(struct trax_mesh *mesh, unsigned count, float size, uint32_t seed) {
  for (unsigned i = 0; i < count; i++) {
    float centre[3], corners[3][3];
    for (int axis = 0; axis < 3; axis++)
      centre[axis] = 2 * random_unit(&seed) - 1;
    for (int corner = 0; corner < 3; corner++)
      for (int axis = 0; axis < 3; axis++)
        corners[corner][axis] = centre[axis] + size * (random_unit(&seed) - 0.5f);
    mesh_triangle(mesh, corners[0], corners[1], corners[2], i % 3);
  }
}

void import_good(struct trax_mesh *mesh, const char *path, struct trax_import_report *report) {
  trax_error error = {{0}};
  if (trax_mesh_import(mesh, &path, 1, &(struct trax_import_options){0}, report, &error) != TRAX_OK)
    fail_msg("%s", error.message);
}

void import_bad(const char *path, const struct trax_import_options *options, const char *part) {
  struct trax_mesh mesh;
  trax_error error = {{0}};
  if (trax_mesh_import(&mesh, &path, 1, options, NULL, &error) != TRAX_ERROR)
    fail_msg("%s was imported", path);
  assert_contains(error.message, part);
  assert_null(mesh.vertices);
}

void build_good(struct trax_scene *scene, const struct trax_mesh *mesh, const struct trax_build_options *options) {
  trax_error error = {{0}};
  if (trax_scene_build(scene, mesh, options, &error) != TRAX_OK)
    fail_msg("%s", error.message);
}

void seal(void *bytes, size_t size) {
  struct trax_scene_header *header = bytes;
  header->checksum = 0;
  header->checksum = (uint32_t)crc32_z(0, bytes, size);
}

void assert_contains_at(const char *text, const char *part, const char *file, int line) {
  if (strstr(text, part))
    return;
  print_error("'%s' does not contain '%s'\n", text, part);
  _fail(file, line);
}
