/* What a glTF file must keep before assimp reads it. Its nodes form trees: assimp follows children without asking
   whether it has been there, and a node with two parents stands in the scene twice, a chain of them 2^n times. And what
   it requires is known. */
#include "internal.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_LEVELS = 1024, MOST_SHOWN = 60 };

struct gltf {
  const char *path;
  trax_error *error;
  json_t *nodes; /* an array of version 2, an object of version 1 */
  size_t count;
  const char **names; /* version 1: of each node */
  uint32_t *parents;  /* of each node: its number and 1, 0: none */
  json_t *numbers;    /* version 1: of names */
};

static json_t *node_at(const struct gltf *gltf, size_t number) {
  return gltf->names ? json_object_get(gltf->nodes, gltf->names[number]) : json_array_get(gltf->nodes, number);
}

/* Number of the node that a child or root refers to, or the count: there is none. */
static size_t referred(const struct gltf *gltf, const json_t *reference) {
  if (gltf->names && json_is_string(reference))
    reference = json_object_get(gltf->numbers, json_string_value(reference));
  const json_int_t number = json_is_integer(reference) ? json_integer_value(reference) : -1;
  return number >= 0 && (uint64_t)number < gltf->count ? (size_t)number : gltf->count;
}

static trax_status adopt(struct gltf *gltf, size_t parent, const json_t *reference) {
  const size_t child = referred(gltf, reference);
  if (child == gltf->count)
    return trax_fail(gltf->error, "%s: node %zu has a child that is not there", gltf->path, parent);
  if (gltf->parents[child])
    return trax_fail(gltf->error, "%s: node %zu is a child of node %u and again of node %zu: nodes must form trees",
                     gltf->path, child, gltf->parents[child] - 1, parent);
  gltf->parents[child] = (uint32_t)parent + 1;
  return TRAX_OK;
}

/* Each node has one parent at most: a way up that does not end is a circle. */
static trax_status check_levels(const struct gltf *gltf) {
  for (size_t i = 0; i < gltf->count; i++) {
    unsigned levels = 0;
    for (uint32_t at = gltf->parents[i]; at && levels <= MOST_LEVELS; at = gltf->parents[at - 1])
      levels++;
    if (levels > MOST_LEVELS)
      return trax_fail(gltf->error, "%s: node %zu is below more than %d others, or below itself", gltf->path, i,
                       MOST_LEVELS);
  }
  return TRAX_OK;
}

static trax_status check_roots(const struct gltf *gltf, const json_t *scene) {
  const json_t *roots = json_object_get(scene, "nodes");
  bool *seen = calloc(gltf->count + 1, sizeof *seen);
  trax_status result = seen ? TRAX_OK : scene_out_of_memory(gltf->error, gltf->path);
  for (size_t i = 0; result == TRAX_OK && i < json_array_size(roots); i++) {
    const size_t root = referred(gltf, json_array_get(roots, i));
    if (root == gltf->count)
      result = trax_fail(gltf->error, "%s: a scene has a node that is not there", gltf->path);
    else if (seen[root] || gltf->parents[root])
      result = trax_fail(gltf->error, "%s: a scene has node %zu %s", gltf->path, root,
                         seen[root] ? "twice" : "as its own and as a child of another");
    seen[root < gltf->count ? root : 0] = true;
  }
  free(seen);
  return result;
}

static trax_status check_trees(struct gltf *gltf, const json_t *root) {
  const char *name;
  json_t *value;
  size_t i = 0;
  if (json_is_object(gltf->nodes) && gltf->count) {
    gltf->names = calloc(gltf->count, sizeof *gltf->names);
    gltf->numbers = json_object();
    if (!gltf->names || !gltf->numbers)
      return scene_out_of_memory(gltf->error, gltf->path);
    json_object_foreach(gltf->nodes, name, value) {
      gltf->names[i] = name;
      json_object_set_new(gltf->numbers, name, json_integer((json_int_t)i++));
    }
  }
  trax_status result = TRAX_OK;
  for (i = 0; i < gltf->count; i++) {
    const json_t *children = json_object_get(node_at(gltf, i), "children");
    for (size_t k = 0; result == TRAX_OK && k < json_array_size(children); k++)
      result = adopt(gltf, i, json_array_get(children, k));
  }
  if (result == TRAX_OK)
    result = check_levels(gltf);
  json_t *scenes = json_object_get(root, "scenes");
  for (i = 0; result == TRAX_OK && i < json_array_size(scenes); i++)
    result = check_roots(gltf, json_array_get(scenes, i));
  if (json_is_object(scenes))
    json_object_foreach(scenes, name, value) if (result == TRAX_OK) result = check_roots(gltf, value);
  return result;
}

/* Extensions that only add what may be left out, or that are read. */
static bool is_known(const char *extension) {
  static const char *const known[] = {"KHR_texture_transform", "KHR_lights_punctual", "KHR_binary_glTF"};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (!strcmp(extension, known[i]))
      return true;
  return !strncmp(extension, "KHR_materials_", 14);
}

static trax_status check_extensions(const struct gltf *gltf, const json_t *root) {
  const json_t *required = json_object_get(root, "extensionsRequired");
  for (size_t i = 0; i < json_array_size(required); i++) {
    const char *name = json_string_value(json_array_get(required, i));
    if (!name || !is_known(name))
      return trax_fail(gltf->error, "%s: it requires the extension %.*s, which is not read", gltf->path, MOST_SHOWN,
                       name ? name : "(no name)");
  }
  return TRAX_OK;
}

static uint32_t word_at(const unsigned char *bytes) {
  return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

/* The JSON of a GLB: the first chunk of version 2 has its length and a kind, version 1's its length and a format. */
static struct scene_bytes json_of(struct scene_bytes file) {
  if (file.size < 20 || memcmp(file.data, "glTF", 4) != 0)
    return file;
  const uint32_t length = word_at(file.data + 12);
  return (struct scene_bytes){file.data + 20, length < file.size - 20 ? length : file.size - 20};
}

trax_status scene_check_gltf(struct scene_bytes file, const char *path, trax_error *error) {
  json_error_t reason;
  struct scene_bytes text = json_of(file);
  while (text.size > 0 && text.data[text.size - 1] == 0)
    text.size--; /* of padding */
  json_t *root = json_loadb((const char *)text.data, text.size, JSON_ALLOW_NUL, &reason);
  if (!root)
    return trax_fail(error, "%s: not a mesh that can be read: line %d: %s", path, reason.line, reason.text);
  struct gltf gltf = {.path = path, .error = error, .nodes = json_object_get(root, "nodes")};
  gltf.count = json_is_object(gltf.nodes) ? json_object_size(gltf.nodes) : json_array_size(gltf.nodes);
  gltf.parents = calloc(gltf.count + 1, sizeof *gltf.parents);
  trax_status result = gltf.parents ? check_extensions(&gltf, root) : scene_out_of_memory(error, path);
  if (result == TRAX_OK)
    result = check_trees(&gltf, root);
  json_decref(gltf.numbers);
  json_decref(root);
  free(gltf.names);
  free(gltf.parents);
  return result;
}
