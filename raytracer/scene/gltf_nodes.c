/* The nodes of glTF's scene: they form trees, and place meshes and cameras. */
#include "gltf.h"
#include "placing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_LEVELS = 1024 };

struct nodes {
  struct gltf *gltf;
  size_t count;
  uint32_t *parents;       /* of each node: its number and 1, 0: none */
  struct gltf_size *sizes; /* of each mesh */
  struct gltf_size whole;
  size_t cameras, instances;
  uint32_t *part_of;       /* with instances: of each mesh: its part and 1, 0: it is not copied yet */
  struct scene_box *boxes; /* of parts */
};

static const json_t *node_at(const struct gltf *gltf, size_t number) {
  return json_array_get(json_object_get(gltf->root, "nodes"), number);
}

/* --- trees --- */

/* Each node has at most one parent, so a way up that does not end is a cycle. */
static trax_status check_levels(const struct nodes *nodes) {
  for (size_t i = 0; i < nodes->count; i++) {
    unsigned levels = 0;
    for (uint32_t at = nodes->parents[i]; at && levels <= MOST_LEVELS; at = nodes->parents[at - 1])
      levels++;
    if (levels > MOST_LEVELS)
      return trax_fail(nodes->gltf->error, "%s: node %zu is below more than %d others, or below itself",
                       nodes->gltf->path, i, MOST_LEVELS);
  }
  return TRAX_OK;
}

static trax_status check_roots(const struct nodes *nodes, const json_t *roots) {
  struct gltf *gltf = nodes->gltf;
  bool *seen = calloc(nodes->count + 1, sizeof *seen);
  trax_status result = seen ? TRAX_OK : scene_out_of_memory(gltf->error, gltf->path);
  for (size_t i = 0; result == TRAX_OK && i < json_array_size(roots); i++) {
    const size_t root = gltf_index(gltf, "nodes", json_array_get(roots, i));
    if (root == SIZE_MAX)
      result = trax_fail(gltf->error, "%s: a scene has a node that is not there", gltf->path);
    else if (seen[root] || nodes->parents[root])
      result = trax_fail(gltf->error, "%s: a scene has node %zu %s", gltf->path, root,
                         seen[root] ? "twice" : "as its own and as a child of another");
    else
      seen[root] = true;
  }
  free(seen);
  return result;
}

/* A node with two parents would be in the scene twice, and a chain of n such nodes 2^n times. */
static trax_status check_trees(const struct nodes *nodes) {
  struct gltf *gltf = nodes->gltf;
  for (size_t i = 0; i < nodes->count; i++) {
    const json_t *children = json_object_get(node_at(gltf, i), "children");
    for (size_t k = 0; k < json_array_size(children); k++) {
      const size_t child = gltf_index(gltf, "nodes", json_array_get(children, k));
      if (child == SIZE_MAX)
        return trax_fail(gltf->error, "%s: node %zu has a child that is not there", gltf->path, i);
      if (nodes->parents[child])
        return trax_fail(gltf->error, "%s: node %zu is a child of node %u and again of node %zu: nodes must form trees",
                         gltf->path, child, nodes->parents[child] - 1, i);
      nodes->parents[child] = (uint32_t)i + 1;
    }
  }
  trax_status result = check_levels(nodes);
  for (size_t i = 0; result == TRAX_OK && i < gltf_count(gltf, "scenes"); i++)
    result = check_roots(nodes, json_object_get(json_array_get(json_object_get(gltf->root, "scenes"), i), "nodes"));
  return result;
}

/* --- transforms: the first three rows of a matrix --- */

void gltf_rest(struct gltf_pose *pose, const json_t *node) {
  double columns[16];
  *pose = (struct gltf_pose){.turn = {0, 0, 0, 1}, .scale = {1, 1, 1}};
  pose->is_matrix = gltf_numbers(columns, 16, node, "matrix");
  for (int i = 0; i < 12 && pose->is_matrix; i++)
    pose->matrix[i / 4][i % 4] = columns[4 * (i % 4) + i / 4];
  gltf_numbers(pose->move, 3, node, "translation");
  gltf_numbers(pose->turn, 4, node, "rotation");
  gltf_numbers(pose->scale, 3, node, "scale");
}

void gltf_transform(double m[3][4], const struct gltf_pose *pose) {
  const double *q = pose->turn, *scale = pose->scale;
  const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], s = square > 0 ? 2 / square : 0;
  if (pose->is_matrix) {
    memcpy(m, pose->matrix, sizeof pose->matrix);
    return;
  }
  for (int row = 0; row < 3; row++) {
    const int next = (row + 1) % 3, last = (row + 2) % 3;
    m[row][row] = (1 - s * (q[next] * q[next] + q[last] * q[last])) * scale[row];
    m[row][next] = s * (q[row] * q[next] - q[3] * q[last]) * scale[next];
    m[row][last] = s * (q[row] * q[last] + q[3] * q[next]) * scale[last];
    m[row][3] = pose->move[row];
  }
}

/* --- meshes and cameras of nodes --- */

/* Leaves out cameras without a direction or perspective, or with values that are not finite. */
static void copy_camera(struct gltf *gltf, const json_t *node, const json_t *camera, const double m[3][4]) {
  struct trax_mesh_camera *out = &gltf->mesh->cameras[gltf->mesh->camera_count];
  const double fov = gltf_number(json_object_get(camera, "perspective"), "yfov", 0);
  const char *name = gltf_text(node, "name");
  trax_mesh_name(out->name, *name ? name : gltf_text(camera, "name"));
  out->fov = (float)(fov * (180 / 3.14159265358979323846));
  for (int axis = 0; axis < 3; axis++) {
    out->eye[axis] = (float)m[axis][3];
    out->direction[axis] = (float)-m[axis][2];
    out->up[axis] = (float)m[axis][1];
  }
  if (out->fov > 0 && out->fov < 180 && isfinite(scene_dot(out->eye, out->eye)) && scene_normalise(out->direction) &&
      scene_normalise(out->up) && scene_make_perpendicular(out->up, out->direction))
    gltf->mesh->camera_count++;
}

static trax_status measure_below(struct nodes *nodes, const json_t *node);

/* Adds up the node and those below it. */
static trax_status measure_node(struct nodes *nodes, const json_t *node) {
  struct gltf *gltf = nodes->gltf;
  const json_t *mesh = json_object_get(node, "mesh");
  if (mesh) {
    const size_t number = gltf_index(gltf, "meshes", mesh);
    if (number == SIZE_MAX)
      return trax_fail(gltf->error, "%s: a node has a mesh that is not there", gltf->path);
    struct gltf_size *size = &nodes->sizes[number];
    const bool again = size->known && gltf->options->instances;
    if (!size->known && gltf_measure_mesh(size, gltf, number) != TRAX_OK)
      return TRAX_ERROR;
    nodes->instances++;
    if (again)
      return measure_below(nodes, node);
    nodes->whole.vertices += size->vertices;
    nodes->whole.triangles += size->triangles;
    nodes->whole.primitives += size->primitives;
    nodes->whole.normals = nodes->whole.normals || size->normals;
  }
  return measure_below(nodes, node);
}

static trax_status measure_below(struct nodes *nodes, const json_t *node) {
  const json_t *children = json_object_get(node, "children");
  nodes->cameras += json_object_get(node, "camera") != NULL;
  for (size_t i = 0; i < json_array_size(children); i++)
    if (measure_node(nodes, gltf_item(nodes->gltf, "nodes", json_array_get(children, i))) != TRAX_OK)
      return TRAX_ERROR;
  return TRAX_OK;
}

static trax_status copy_mesh(struct gltf *gltf, size_t node_number, size_t mesh, const double matrix[3][4]) {
  struct gltf_deform deform;
  trax_status result = gltf_find_deform(&deform, gltf, node_number);
  if (result == TRAX_OK)
    result = gltf_copy_mesh(gltf, mesh, matrix, &deform);
  gltf_release_deform(&deform);
  return result;
}

/* Copies a mesh where a node has it first, and places it at each. */
static trax_status place_mesh(struct nodes *nodes, size_t node_number, size_t number, const double matrix[3][4]) {
  struct gltf *gltf = nodes->gltf;
  struct trax_mesh *mesh = gltf->mesh;
  struct gltf_deform deform;
  trax_status result = gltf_find_deform(&deform, gltf, node_number);
  if (result == TRAX_OK && (deform.joints || deform.weight_count))
    result = trax_fail(gltf->error, "%s: mesh %zu bends by a skin or by morph targets, so --instances is not for it",
                       gltf->path, number);
  if (result == TRAX_OK && !nodes->part_of[number]) {
    const uint32_t first = mesh->triangle_count;
    result = gltf_copy_mesh(gltf, number, scene_identity, &deform);
    const uint32_t count = mesh->triangle_count - first;
    for (uint32_t i = first; i < mesh->triangle_count; i++)
      mesh->triangles[i].source_id -= first;
    mesh->parts[mesh->part_count] = (struct trax_mesh_part){first, count, count};
    if (result == TRAX_OK)
      nodes->boxes[mesh->part_count] = scene_part_box(mesh, first, count);
    nodes->part_of[number] = ++mesh->part_count;
  }
  gltf_release_deform(&deform);
  if (result != TRAX_OK)
    return result;
  struct trax_mesh_instance *out = &mesh->instances[mesh->instance_count++];
  *out = (struct trax_mesh_instance){.part = nodes->part_of[number] - 1, .material = TRAX_NO_MATERIAL};
  memcpy(out->transform, matrix, sizeof out->transform);
  const char *wrong = gltf->options->flatten || !mesh->parts[out->part].triangle_count
                          ? NULL
                          : scene_misplaced(&nodes->boxes[out->part], matrix);
  return wrong ? trax_fail(gltf->error, "%s: node %zu, which is instance %u (from 0): %s", gltf->path, node_number,
                           mesh->instance_count - 1, wrong)
               : TRAX_OK;
}

static trax_status copy_node(struct nodes *nodes, size_t number, const double above[3][4]) {
  struct gltf *gltf = nodes->gltf;
  const json_t *node = node_at(gltf, number);
  const json_t *children = json_object_get(node, "children"), *mesh = json_object_get(node, "mesh");
  const json_t *camera = gltf_item(gltf, "cameras", json_object_get(node, "camera"));
  struct gltf_pose rest;
  double own[3][4], matrix[3][4];
  gltf_rest(&rest, node);
  gltf_transform(own, gltf->poses ? &gltf->poses[number] : &rest);
  scene_multiply(matrix, above, own);
  trax_status result = TRAX_OK;
  if (mesh)
    result = gltf->options->instances ? place_mesh(nodes, number, gltf_index(gltf, "meshes", mesh), matrix)
                                      : copy_mesh(gltf, number, gltf_index(gltf, "meshes", mesh), matrix);
  if (camera)
    copy_camera(gltf, node, camera, matrix);
  for (size_t i = 0; result == TRAX_OK && i < json_array_size(children); i++)
    result = copy_node(nodes, gltf_index(gltf, "nodes", json_array_get(children, i)), matrix);
  return result;
}

/* Calls one of the two for each root: the nodes of the file's scene, or, without scenes, those that have no parent. */
static trax_status for_roots(struct nodes *nodes, bool copy) {
  struct gltf *gltf = nodes->gltf;
  const json_t *number = json_object_get(gltf->root, "scene"), *scenes = json_object_get(gltf->root, "scenes");
  const json_t *scene = number ? gltf_item(gltf, "scenes", number) : json_array_get(scenes, 0);
  if (number && !scene)
    return trax_fail(gltf->error, "%s: its scene is not there", gltf->path);
  const json_t *roots = json_object_get(scene, "nodes");
  const size_t count = scene ? json_array_size(roots) : nodes->count;
  trax_status result = TRAX_OK;
  for (size_t i = 0; result == TRAX_OK && i < count; i++) {
    const size_t node = scene ? gltf_index(gltf, "nodes", json_array_get(roots, i)) : i;
    if (scene || !nodes->parents[i])
      result = copy ? copy_node(nodes, node, scene_identity) : measure_node(nodes, node_at(gltf, node));
  }
  return result;
}

/* Limits the memory in proportion to the size of the files: nodes may instance a mesh any number of times. */
static trax_status allocate(const struct nodes *nodes) {
  enum { BYTES_PER_PRIMITIVE = 1024 };
  struct gltf *gltf = nodes->gltf;
  struct trax_mesh *mesh = gltf->mesh;
  const struct gltf_size *size = &nodes->whole;
  const bool uvs = mesh->texture_count > 0;
  const uint64_t bytes = size->vertices * sizeof *mesh->vertices +
                         size->triangles * (sizeof *mesh->triangles + sizeof *mesh->normals + sizeof *mesh->uvs) +
                         size->primitives * BYTES_PER_PRIMITIVE;
  if (size->vertices > UINT32_MAX || size->triangles > UINT32_MAX || bytes > scene_memory_for(gltf->bytes_read))
    return trax_fail(gltf->error, "%s: too large: %llu vertices and %llu triangles by %llu bytes", gltf->path,
                     (unsigned long long)size->vertices, (unsigned long long)size->triangles,
                     (unsigned long long)gltf->bytes_read);
  mesh->vertices = malloc((size->vertices + 1) * sizeof *mesh->vertices);
  mesh->triangles = malloc((size->triangles + 1) * sizeof *mesh->triangles);
  mesh->cameras = calloc(nodes->cameras + 1, sizeof *mesh->cameras);
  if (gltf->options->instances) { /* at most one for each node of the file */
    mesh->parts = calloc(gltf_count(gltf, "meshes") + 1, sizeof *mesh->parts);
    mesh->instances = calloc(nodes->instances + 1, sizeof *mesh->instances);
    if (!mesh->parts || !mesh->instances)
      return scene_out_of_memory(gltf->error, gltf->path);
  }
  if (size->normals)
    mesh->normals = calloc(size->triangles + 1, sizeof *mesh->normals);
  if (uvs)
    mesh->uvs = calloc(size->triangles + 1, sizeof *mesh->uvs);
  return !mesh->vertices || !mesh->triangles || !mesh->cameras || (size->normals && !mesh->normals) ||
                 (uvs && !mesh->uvs)
             ? scene_out_of_memory(gltf->error, gltf->path)
             : TRAX_OK;
}

trax_status gltf_copy_nodes(struct gltf *gltf) {
  struct nodes nodes = {.gltf = gltf, .count = gltf_count(gltf, "nodes")};
  nodes.parents = calloc(nodes.count + 1, sizeof *nodes.parents);
  nodes.sizes = calloc(gltf_count(gltf, "meshes") + 1, sizeof *nodes.sizes);
  nodes.part_of = calloc(gltf_count(gltf, "meshes") + 1, sizeof *nodes.part_of);
  nodes.boxes = calloc(gltf_count(gltf, "meshes") + 1, sizeof *nodes.boxes);
  const bool room = nodes.parents && nodes.sizes && nodes.part_of && nodes.boxes;
  trax_status result = room ? check_trees(&nodes) : scene_out_of_memory(gltf->error, gltf->path);
  if (result == TRAX_OK)
    result = gltf_find_poses(gltf, nodes.parents);
  if (result == TRAX_OK)
    result = for_roots(&nodes, false);
  if (result == TRAX_OK)
    result = allocate(&nodes);
  if (result == TRAX_OK)
    result = for_roots(&nodes, true);
  gltf->report->source_triangles += gltf->mesh->triangle_count;
  gltf_release_poses(gltf);
  free(nodes.parents);
  free(nodes.sizes);
  free(nodes.part_of);
  free(nodes.boxes);
  return result;
}
