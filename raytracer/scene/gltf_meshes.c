/* The primitives of glTF's meshes. */
#include "gltf.h"
#include "placing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS, LINES, LINE_LOOP, LINE_STRIP, TRIANGLES, TRIANGLE_STRIP, TRIANGLE_FAN };

struct primitive {
  struct gltf_accessor positions, normals, uvs, indices;
  struct gltf_accessor joints, weights; /* of a vertex four each */
  bool has_normals, has_uvs, has_indices, has_joints;
  const json_t *targets; /* that morph it */
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

/* Finds the joints, weights and targets by which an animation moves vertices. Normals are computed then: the file's
   would have to be moved, too. */
static trax_status find_deformed(struct primitive *primitive, struct gltf *gltf, const json_t *attributes,
                                 const json_t *item) {
  const uint32_t count = primitive->positions.count;
  bool has_weights;
  if (find_attribute(&primitive->joints, &primitive->has_joints, gltf, attributes, "JOINTS_0", 4, count) != TRAX_OK ||
      find_attribute(&primitive->weights, &has_weights, gltf, attributes, "WEIGHTS_0", 4, count) != TRAX_OK)
    return TRAX_ERROR;
  if (has_weights != primitive->has_joints || json_object_get(attributes, "JOINTS_1"))
    return trax_fail(gltf->error, "%s: a mesh has joints without weights, or more than four joints for a vertex",
                     gltf->path);
  primitive->targets = json_object_get(item, "targets");
  if (primitive->has_joints || json_array_size(primitive->targets))
    primitive->has_normals = false;
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
  if (gltf->poses && find_deformed(primitive, gltf, attributes, item) != TRAX_OK)
    return TRAX_ERROR;
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

static void transform(double out[3], const double m[3][4], const double v[3]) {
  for (int axis = 0; axis < 3; axis++)
    out[axis] = m[axis][0] * v[0] + m[axis][1] * v[1] + m[axis][2] * v[2] + m[axis][3];
}

/* The mean of where its joints put the vertex, by their weights. False: it has a joint that is not there. */
static bool follow_joints(double v[3], const struct primitive *primitive, uint32_t index,
                          const struct gltf_deform *deform) {
  float joints[4], weights[4];
  double sum = 0, moved[3] = {0, 0, 0};
  gltf_read(joints, 4, &primitive->joints, index);
  gltf_read(weights, 4, &primitive->weights, index);
  for (int i = 0; i < 4; i++) {
    double place[3];
    if (!(weights[i] > 0))
      continue;
    if (!(joints[i] >= 0 && joints[i] < (float)deform->joint_count))
      return false;
    transform(place, deform->joints[(uint32_t)joints[i]], v);
    sum += (double)weights[i];
    for (int axis = 0; axis < 3; axis++)
      moved[axis] += (double)weights[i] * place[axis];
  }
  for (int axis = 0; axis < 3 && sum > 0; axis++)
    v[axis] = moved[axis] / sum;
  return true;
}

/* A primitive's morph targets, and where its vertices go. */
struct placing {
  const struct primitive *primitive;
  const double (*matrix)[4];
  const struct gltf_deform *deform;
  struct gltf_accessor *targets; /* of as many as have weights and positions */
  double *weights;
  uint32_t target_count;
  bool keep; /* vertices stay as they are in the file */
};

static trax_status place_vertex(float out[3], const struct placing *placing, uint32_t index, struct gltf *gltf) {
  const struct primitive *primitive = placing->primitive;
  float at[3];
  gltf_read(at, 3, &primitive->positions, index);
  if (placing->keep) {
    memcpy(out, at, sizeof at);
    return TRAX_OK;
  }
  double v[3] = {(double)at[0], (double)at[1], (double)at[2]}, placed[3];
  for (uint32_t i = 0; i < placing->target_count; i++) {
    gltf_read(at, 3, &placing->targets[i], index);
    for (int axis = 0; axis < 3; axis++)
      v[axis] += placing->weights[i] * (double)at[axis];
  }
  if (placing->deform->joints && primitive->has_joints) {
    if (!follow_joints(v, primitive, index, placing->deform))
      return trax_fail(gltf->error, "%s: vertex %u has a joint that its skin has not", gltf->path, index);
    memcpy(placed, v, sizeof v);
  } else
    transform(placed, placing->matrix, v);
  for (int axis = 0; axis < 3; axis++)
    out[axis] = (float)placed[axis];
  return TRAX_OK;
}

static trax_status find_targets(struct placing *placing, struct gltf *gltf) {
  const json_t *targets = placing->primitive->targets;
  const size_t most = placing->deform->weight_count < json_array_size(targets) ? placing->deform->weight_count
                                                                               : json_array_size(targets);
  placing->targets = calloc(most + 1, sizeof *placing->targets);
  placing->weights = calloc(most + 1, sizeof *placing->weights);
  if (!placing->targets || !placing->weights)
    return scene_out_of_memory(gltf->error, gltf->path);
  for (size_t i = 0; i < most; i++) {
    bool found;
    const uint32_t number = placing->target_count;
    if (find_attribute(&placing->targets[number], &found, gltf, json_array_get(targets, i), "POSITION", 3,
                       placing->primitive->positions.count) != TRAX_OK)
      return TRAX_ERROR;
    placing->weights[number] = placing->deform->weights[i];
    placing->target_count += found && placing->weights[number] != 0;
  }
  return TRAX_OK;
}

static void copy_uv(float out[2], const struct gltf *gltf, const struct primitive *primitive, uint32_t index) {
  const struct gltf_uvs *map = &gltf->uvs[primitive->material];
  float uv[2];
  gltf_read(uv, 2, &primitive->uvs, index);
  for (int axis = 0; axis < 2; axis++) /* glTF has v down */
    out[axis] = map->map[axis][0] * uv[0] + map->map[axis][1] * (1 - uv[1]) + map->map[axis][2];
}

static trax_status copy_triangles(struct gltf *gltf, const struct placing *placing, size_t number) {
  const struct primitive *primitive = placing->primitive;
  struct trax_mesh *mesh = gltf->mesh;
  const bool mirror = scene_determinant(placing->matrix) < 0, shared = shares_vertices(primitive);
  const uint32_t first = mesh->vertex_count;
  for (uint32_t i = 0; shared && i < primitive->positions.count; i++)
    if (place_vertex(mesh->vertices[mesh->vertex_count++], placing, i, gltf) != TRAX_OK)
      return TRAX_ERROR;
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
      if (!shared && place_vertex(mesh->vertices[mesh->vertex_count++], placing, index, gltf) != TRAX_OK)
        return TRAX_ERROR;
      triangle->vertices[corner] = shared ? first + index : mesh->vertex_count - 1;
      if (mesh->uvs && primitive->has_uvs)
        copy_uv(mesh->uvs[triangle_number][corner], gltf, primitive, index);
      if (mesh->normals && primitive->has_normals) {
        float normal[3];
        gltf_read(normal, 3, &primitive->normals, index);
        scene_place_normal(mesh->normals[triangle_number][corner], normal, placing->matrix);
      }
    }
  }
  gltf->report->other_primitives += points_and_lines_of(primitive);
  return scene_is_interrupted(gltf->options->interrupt) ? TRAX_INTERRUPTED : TRAX_OK;
}

static trax_status copy_primitive(struct gltf *gltf, const struct primitive *primitive, size_t number,
                                  const double matrix[3][4], const struct gltf_deform *deform) {
  struct placing placing = {.primitive = primitive, .matrix = matrix, .deform = deform};
  trax_status result = find_targets(&placing, gltf);
  placing.keep = !memcmp(matrix, scene_identity, sizeof scene_identity) && placing.target_count == 0 &&
                 !(deform->joints && primitive->has_joints);
  if (result == TRAX_OK)
    result = copy_triangles(gltf, &placing, number);
  free(placing.targets);
  free(placing.weights);
  return result;
}

trax_status gltf_copy_mesh(struct gltf *gltf, size_t number, const double matrix[3][4],
                           const struct gltf_deform *deform) {
  const json_t *primitives = primitives_of(gltf, number);
  trax_status result = TRAX_OK;
  for (size_t i = 0; i < json_array_size(primitives) && result == TRAX_OK; i++) {
    struct primitive primitive;
    result = find_primitive(&primitive, gltf, json_array_get(primitives, i), number);
    if (result == TRAX_OK)
      result = copy_primitive(gltf, &primitive, number, matrix, deform);
  }
  return result;
}
