/* The primitives of glTF's meshes. */
#include "gltf.h"

#include <math.h>
#include <string.h>

enum { POINTS, LINES, LINE_LOOP, LINE_STRIP, TRIANGLES, TRIANGLE_STRIP, TRIANGLE_FAN };

struct primitive {
  struct gltf_accessor positions, normals, uvs, indices;
  bool has_normals, has_uvs, has_indices;
  int mode;
  uint32_t corners; /* of all triangles or lines, as the file lists them */
  uint32_t material;
};

static trax_status find_attribute(struct gltf_accessor *accessor, bool *found, struct gltf *gltf,
                                  const json_t *attributes, const char *name, unsigned components, uint32_t count) {
  const json_t *reference = json_object_get(attributes, name);
  *found = reference != NULL;
  if (!reference)
    return TRAX_OK;
  if (gltf_find_accessor(accessor, gltf, reference) != TRAX_OK)
    return TRAX_ERROR;
  if (accessor->components != components || accessor->count < count)
    return trax_fail(gltf->error, "%s: an accessor of %s has %u elements of %u numbers instead of %u of %u", gltf->path,
                     name, accessor->count, accessor->components, count, components);
  return TRAX_OK;
}

static trax_status find_primitive(struct primitive *primitive, struct gltf *gltf, const json_t *item, size_t mesh) {
  const json_t *attributes = json_object_get(item, "attributes"), *material = json_object_get(item, "material");
  const size_t number = gltf_index(gltf, "materials", material);
  bool found;
  char set[32];
  *primitive = (struct primitive){.mode = (int)gltf_number(item, "mode", TRIANGLES),
                                  .material = material ? (uint32_t)number : gltf->mesh->material_count - 1};
  if (material && number == SIZE_MAX)
    return trax_fail(gltf->error, "%s: mesh %zu: its material is not there", gltf->path, mesh);
  if (primitive->mode < POINTS || primitive->mode > TRIANGLE_FAN)
    return trax_fail(gltf->error, "%s: mesh %zu: mode %d is unknown", gltf->path, mesh, primitive->mode);
  if (find_attribute(&primitive->positions, &found, gltf, attributes, "POSITION", 3, 0) != TRAX_OK)
    return TRAX_ERROR;
  if (!found)
    return trax_fail(gltf->error, "%s: mesh %zu: its vertices have no positions", gltf->path, mesh);
  const uint32_t count = primitive->positions.count;
  snprintf(set, sizeof set, "TEXCOORD_%u", gltf->uvs[primitive->material].set);
  if (find_attribute(&primitive->normals, &primitive->has_normals, gltf, attributes, "NORMAL", 3, count) != TRAX_OK ||
      find_attribute(&primitive->uvs, &primitive->has_uvs, gltf, attributes, set, 2, count) != TRAX_OK)
    return TRAX_ERROR;
  const json_t *indices = json_object_get(item, "indices");
  primitive->has_indices = indices != NULL;
  primitive->corners = count;
  if (indices && gltf_find_accessor(&primitive->indices, gltf, indices) != TRAX_OK)
    return TRAX_ERROR;
  if (indices)
    primitive->corners = primitive->indices.count;
  if (json_object_get(attributes, "COLOR_0"))
    gltf->report->unread |= TRAX_UNREAD_COLOURS;
  return TRAX_OK;
}

static uint32_t triangles_of(const struct primitive *primitive) {
  return primitive->mode == TRIANGLES                            ? primitive->corners / 3
         : primitive->mode < TRIANGLES || primitive->corners < 3 ? 0
                                                                 : primitive->corners - 2;
}

static uint32_t points_and_lines_of(const struct primitive *primitive) {
  const uint32_t corners = primitive->corners;
  return primitive->mode == LINES        ? corners / 2
         : primitive->mode == LINE_STRIP ? corners - (corners > 0)
         : primitive->mode < TRIANGLES   ? corners
                                         : 0;
}

/* Vertices are shared as in the file, unless most of them belong to other primitives: then each corner has its own. */
static bool shares_vertices(const struct primitive *primitive) {
  return primitive->positions.count <= 3 * (uint64_t)triangles_of(primitive);
}

static const json_t *primitives_of(const struct gltf *gltf, size_t mesh) {
  return json_object_get(json_array_get(json_object_get(gltf->root, "meshes"), mesh), "primitives");
}

trax_status gltf_measure_mesh(struct gltf_size *size, struct gltf *gltf, size_t number) {
  const json_t *primitives = primitives_of(gltf, number);
  *size = (struct gltf_size){.known = true, .primitives = json_array_size(primitives)};
  for (size_t i = 0; i < json_array_size(primitives); i++) {
    struct primitive primitive;
    if (find_primitive(&primitive, gltf, json_array_get(primitives, i), number) != TRAX_OK)
      return TRAX_ERROR;
    size->triangles += triangles_of(&primitive);
    size->vertices += shares_vertices(&primitive) ? primitive.positions.count : 3 * (uint64_t)triangles_of(&primitive);
    size->normals = size->normals || primitive.has_normals;
  }
  return TRAX_OK;
}

/* The corners of a triangle among those that the file lists. */
static void find_corners(uint32_t corners[3], const struct primitive *primitive, uint32_t triangle) {
  const uint32_t odd = triangle % 2;
  if (primitive->mode == TRIANGLES)
    corners[0] = 3 * triangle, corners[1] = corners[0] + 1, corners[2] = corners[0] + 2;
  else if (primitive->mode == TRIANGLE_STRIP)
    corners[0] = triangle, corners[1] = triangle + 1 + odd, corners[2] = triangle + 2 - odd;
  else
    corners[0] = triangle + 1, corners[1] = triangle + 2, corners[2] = 0;
}

static void copy_vertex(float out[3], const struct primitive *primitive, uint32_t index, const double m[3][4],
                        bool keep) {
  float v[3];
  gltf_read(v, 3, &primitive->positions, index);
  for (int axis = 0; axis < 3; axis++)
    out[axis] =
        keep ? v[axis]
             : (float)(m[axis][0] * (double)v[0] + m[axis][1] * (double)v[1] + m[axis][2] * (double)v[2] + m[axis][3]);
}

/* By the cofactors of the matrix, which is the inverse's transpose but for its length. */
static void copy_normal(float out[3], const struct primitive *primitive, uint32_t index, const double m[3][4],
                        bool mirror) {
  float n[3];
  gltf_read(n, 3, &primitive->normals, index);
  for (int row = 0; row < 3; row++) {
    const double *y = m[(row + 1) % 3], *z = m[(row + 2) % 3];
    double sum = 0;
    for (int column = 0; column < 3; column++)
      sum +=
          (y[(column + 1) % 3] * z[(column + 2) % 3] - y[(column + 2) % 3] * z[(column + 1) % 3]) * (double)n[column];
    out[row] = (float)(mirror ? -sum : sum);
  }
}

static bool mirrors(const double m[3][4]) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]) <
         0;
}

static void copy_uv(float out[2], const struct gltf *gltf, const struct primitive *primitive, uint32_t index) {
  const struct gltf_uvs *map = &gltf->uvs[primitive->material];
  float uv[2];
  gltf_read(uv, 2, &primitive->uvs, index);
  for (int axis = 0; axis < 2; axis++) /* glTF has v down */
    out[axis] = map->map[axis][0] * uv[0] + map->map[axis][1] * (1 - uv[1]) + map->map[axis][2];
}

static trax_status copy_primitive(struct gltf *gltf, const struct primitive *primitive, size_t number,
                                  const double matrix[3][4]) {
  static const double identity[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  struct trax_mesh *mesh = gltf->mesh;
  const bool keep = !memcmp(matrix, identity, sizeof identity), mirror = mirrors(matrix);
  const bool shared = shares_vertices(primitive);
  const uint32_t first = mesh->vertex_count;
  for (uint32_t i = 0; shared && i < primitive->positions.count; i++)
    copy_vertex(mesh->vertices[mesh->vertex_count++], primitive, i, matrix, keep);
  for (uint32_t i = 0; i < triangles_of(primitive); i++) {
    uint32_t corners[3];
    find_corners(corners, primitive, i);
    const uint32_t triangle_number = mesh->triangle_count++;
    struct trax_mesh_triangle *triangle = &mesh->triangles[triangle_number];
    *triangle = (struct trax_mesh_triangle){.material = primitive->material, .source_id = triangle_number};
    for (unsigned corner = 0; corner < 3; corner++) {
      const uint32_t listed = corners[mirror && corner ? 3 - corner : corner];
      const uint32_t index = primitive->has_indices ? gltf_read_index(&primitive->indices, listed) : listed;
      if (index >= primitive->positions.count)
        return trax_fail(gltf->error, "%s: mesh %zu: vertex index %u is out of range (%u vertices)", gltf->path, number,
                         index, primitive->positions.count);
      if (!shared)
        copy_vertex(mesh->vertices[mesh->vertex_count++], primitive, index, matrix, keep);
      triangle->vertices[corner] = shared ? first + index : mesh->vertex_count - 1;
      if (mesh->uvs && primitive->has_uvs)
        copy_uv(mesh->uvs[triangle_number][corner], gltf, primitive, index);
      if (mesh->normals && primitive->has_normals)
        copy_normal(mesh->normals[triangle_number][corner], primitive, index, matrix, mirror);
    }
  }
  gltf->report->other_primitives += points_and_lines_of(primitive);
  return scene_is_interrupted(gltf->options->interrupt) ? TRAX_INTERRUPTED : TRAX_OK;
}

trax_status gltf_copy_mesh(struct gltf *gltf, size_t number, const double matrix[3][4]) {
  const json_t *primitives = primitives_of(gltf, number);
  trax_status result = TRAX_OK;
  for (size_t i = 0; i < json_array_size(primitives) && result == TRAX_OK; i++) {
    struct primitive primitive;
    result = find_primitive(&primitive, gltf, json_array_get(primitives, i), number);
    if (result == TRAX_OK)
      result = copy_primitive(gltf, &primitive, number, matrix);
  }
  return result;
}
