/* A scene with instances: a tree for each part of the mesh, and one over the instances' boxes. Nodes of the latter come
   first in the file, then those of the parts. */
#include "built_tree.h"
#include "layout.h"
#include "placing.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

struct two_levels {
  const struct trax_mesh *mesh;
  struct trax_build_options parts, upper; /* options of the trees */
  trax_error *error;
  struct scene_tree *trees; /* of the parts */
  struct scene_order *orders;
  uint32_t inner_nodes, triangles, depth, max_leaf; /* of all parts; the greatest depth */
  struct palette palette;
  struct trax_scene scene;
  struct trax_scene_header *header;
  struct layout layout;
};

static trax_status check_options(const struct trax_build_options *options, trax_error *error) {
  if (options->refit)
    return trax_fail(error, "--refit: instances move without it; it is for meshes (--flatten)");
  if (options->tree_nodes)
    return trax_fail(error, "--tree is the tree of a mesh without instances (--flatten)");
  if (options->splits > 1 && !options->choose_splits)
    return trax_fail(error, "--splits: triangles of instances are not split (--flatten)");
  if (options->nodes != TRAX_NODES_BINARY && !options->choose_nodes)
    return trax_fail(error, "--nodes %s: a scene of instances has binary nodes; one without has any (--flatten)",
                     trax_node_formats[options->nodes].name);
  return TRAX_OK;
}

/* The part as a mesh of its own. Vertices, materials and textures are those of the whole. */
static struct trax_mesh part_of(const struct trax_mesh *mesh, uint32_t number) {
  const struct trax_mesh_part *part = &mesh->parts[number];
  struct trax_mesh out = *mesh;
  out.triangles += part->first_triangle;
  out.triangle_count = part->triangle_count;
  out.normals = mesh->normals ? mesh->normals + part->first_triangle : NULL;
  out.uvs = mesh->uvs ? mesh->uvs + part->first_triangle : NULL;
  out.instance_count = out.part_count = 0;
  return out;
}

static trax_status order_nodes(struct scene_order *order, const struct scene_tree *tree,
                               const struct trax_build_options *options, trax_error *error) {
  return scene_order_nodes(order, tree, TRAX_NODES_BINARY,
                           options->cache_lines ? options->cache_lines : SCENE_CACHE_LINES, options->interrupt, error);
}

static trax_status build_parts(struct two_levels *two) {
  const uint32_t count = two->mesh->part_count;
  two->trees = calloc(count, sizeof *two->trees);
  two->orders = calloc(count, sizeof *two->orders);
  if (!two->trees || !two->orders)
    return scene_out_of_memory(two->error, "BVH");
  uint64_t triangles = 0;
  trax_status result = TRAX_OK;
  for (uint32_t i = 0; i < count && result == TRAX_OK; i++) {
    const struct trax_mesh part = part_of(two->mesh, i);
    struct scene_tree *tree = &two->trees[i];
    result = scene_build_tree(tree, &part, &two->parts, two->error);
    if (result == TRAX_OK)
      result = scene_order_duplicates(tree, NULL, &part, two->error);
    if (result == TRAX_OK)
      result = order_nodes(&two->orders[i], tree, &two->parts, two->error);
    two->inner_nodes += tree->inner_count;
    two->depth = tree->max_depth > two->depth ? tree->max_depth : two->depth;
    two->max_leaf = tree->max_leaf > two->max_leaf ? tree->max_leaf : two->max_leaf;
    triangles += tree->ref_count;
  }
  two->triangles = (uint32_t)triangles;
  return result == TRAX_OK && triangles > UINT32_MAX ? trax_fail(two->error, "too many triangles") : result;
}

/* --- the file --- */

static trax_status plan(struct two_levels *two) {
  const struct trax_mesh *mesh = two->mesh;
  struct trax_scene_header header = {.magic = TRAX_SCENE_MAGIC,
                                     .version = TRAX_SCENE_VERSION_INSTANCES,
                                     .node_layout = TRAX_NODES_BINARY,
                                     .max_leaf = two->max_leaf,
                                     .triangle_count = two->triangles};
  struct trax_scene_more more = {0};
  struct trax_scene_section *sections = header.sections;
  uint64_t end = sizeof header + sizeof more;
  scene_plan_section(&sections[TRAX_SCENE_NODES], &end, mesh->instance_count - 1 + two->inner_nodes,
                     sizeof(struct trax_bvh_node));
  scene_plan_section(&more.sections[TRAX_SCENE_INSTANCES], &end, mesh->instance_count, sizeof(struct trax_instance));
  scene_plan_section(&sections[TRAX_SCENE_TRIANGLES], &end, two->triangles, sizeof(struct trax_triangle));
  if (two->parts.smooth)
    scene_plan_section(&sections[TRAX_SCENE_NORMALS], &end, two->triangles, sizeof(struct trax_triangle_normals));
  if (two->palette.texture_count)
    scene_plan_section(&sections[TRAX_SCENE_UVS], &end, two->triangles, sizeof(struct trax_triangle_uvs));
  if (scene_plan_materials(sections, &end, &two->palette, two->triangles, two->error) != TRAX_OK)
    return TRAX_ERROR;
  scene_plan_section(&more.sections[TRAX_SCENE_MESHES], &end, mesh->part_count, sizeof(struct trax_scene_mesh));
  if (end > UINT32_MAX)
    return trax_fail(two->error, "%u triangles and %u instances make a scene of %.1f GB; 32-bit offsets end at 4.29",
                     two->triangles, mesh->instance_count, (double)end * 1e-9);
  unsigned char *bytes = aligned_alloc(TRAX_SCENE_ALIGNMENT, end);
  if (!bytes)
    return scene_out_of_memory(two->error, "scene");
  memset(bytes, 0, end);
  header.file_size = (uint32_t)end;
  memcpy(bytes, &header, sizeof header);
  memcpy(bytes + sizeof header, &more, sizeof more);
  two->header = (struct trax_scene_header *)(void *)bytes;
  two->scene = (struct trax_scene){.bytes = bytes, .size = end};
  return TRAX_OK;
}

/* Makes *scene a view of the bytes as they are so far. */
static void view_file(struct two_levels *two) {
  struct trax_scene_section *sections = two->header->sections,
                            *more = ((struct trax_scene_more *)(two->header + 1))->sections;
  unsigned char *bytes = two->scene.bytes;
  two->scene = (struct trax_scene){.bytes = bytes,
                                   .size = two->scene.size,
                                   .header = two->header,
                                   .nodes = scene_section_bytes(bytes, &sections[TRAX_SCENE_NODES]),
                                   .triangles = scene_section_bytes(bytes, &sections[TRAX_SCENE_TRIANGLES]),
                                   .normals = scene_section_bytes(bytes, &sections[TRAX_SCENE_NORMALS]),
                                   .uvs = scene_section_bytes(bytes, &sections[TRAX_SCENE_UVS]),
                                   .materials = scene_section_bytes(bytes, &sections[TRAX_SCENE_MATERIALS]),
                                   .textures = scene_section_bytes(bytes, &sections[TRAX_SCENE_TEXTURES]),
                                   .texels = scene_section_bytes(bytes, &sections[TRAX_SCENE_TEXELS]),
                                   .source_ids = scene_section_bytes(bytes, &sections[TRAX_SCENE_SOURCE_IDS]),
                                   .node_count = sections[TRAX_SCENE_NODES].count,
                                   .triangle_count = two->triangles,
                                   .material_count = two->palette.count,
                                   .texture_count = two->palette.texture_count,
                                   .texel_count = (uint32_t)two->palette.texel_count,
                                   .instances = scene_section_bytes(bytes, &more[TRAX_SCENE_INSTANCES]),
                                   .meshes = scene_section_bytes(bytes, &more[TRAX_SCENE_MESHES]),
                                   .instance_count = more[TRAX_SCENE_INSTANCES].count,
                                   .mesh_count = more[TRAX_SCENE_MESHES].count};
}

static trax_status place_part(struct two_levels *two, uint32_t number, uint32_t first_node) {
  const struct trax_mesh part = part_of(two->mesh, number);
  const struct scene_tree *tree = &two->trees[number];
  struct trax_scene_mesh *out = &((struct trax_scene_mesh *)two->scene.meshes)[number];
  struct layout *layout = &two->layout;
  struct scene_box box;
  const uint32_t first = layout->next_triangle;
  layout->mesh = &part;
  layout->tree = tree;
  layout->positions = two->orders[number].position;
  layout->nodes_offset =
      two->header->sections[TRAX_SCENE_NODES].offset + first_node * (uint32_t)sizeof(struct trax_bvh_node);
  layout->nodes = layout->bytes + layout->nodes_offset;
  *out = (struct trax_scene_mesh){.root = scene_place_subtree(layout, 0, &box),
                                  .first_triangle = first,
                                  .triangle_count = tree->ref_count,
                                  .source_count = two->mesh->parts[number].source_count,
                                  .depth = tree->max_depth};
  memcpy(out->bounds_min, tree->bounds.min, sizeof out->bounds_min);
  memcpy(out->bounds_max, tree->bounds.max, sizeof out->bounds_max);
  if (!layout->normals)
    return TRAX_OK;
  return (layout->file_normals ? scene_complete_normals
                               : scene_smooth_normals)(layout->normals + first, layout->triangles + first,
                                                       tree->ref_count, scene_crease_cosine(&two->parts), two->error);
}

static trax_status place_parts(struct two_levels *two) {
  trax_status result = TRAX_OK;
  uint32_t first_node = two->mesh->instance_count - 1;
  two->layout = (struct layout){.materials = two->palette.of_mesh,
                                .node_layout = TRAX_NODES_BINARY,
                                .bytes = two->scene.bytes,
                                .triangles = (struct trax_triangle *)two->scene.triangles,
                                .normals = (struct trax_triangle_normals *)two->scene.normals,
                                .uvs = (struct trax_triangle_uvs *)two->scene.uvs,
                                .source_ids = (uint32_t *)two->scene.source_ids,
                                .file_normals = two->mesh->normals && !two->parts.compute_normals,
                                .triangles_offset = two->header->sections[TRAX_SCENE_TRIANGLES].offset};
  for (uint32_t i = 0; i < two->mesh->part_count && result == TRAX_OK; i++) {
    result = place_part(two, i, first_node);
    first_node += two->trees[i].inner_count;
  }
  return result;
}

/* --- the tree over instances --- */

/* The instance as the file has it, but for its numbers and stretch. */
static trax_status make_instance(struct trax_instance *out, const struct two_levels *two, uint32_t number) {
  const struct trax_mesh_instance *source = &two->mesh->instances[number];
  *out = (struct trax_instance){
      .root = two->scene.meshes[source->part].root,
      .material = source->material == TRAX_NO_MATERIAL ? TRAX_NO_MATERIAL : two->palette.of_mesh[source->material],
      .mesh = source->part};
  const char *wrong = scene_place_instance(out, source->transform);
  return wrong ? trax_fail(two->error, "instance %u (from 0): %s", number, wrong) : TRAX_OK;
}

/* A mesh of triangles whose boxes are the instances': the builder looks at nothing else of them. */
static trax_status box_instances(struct trax_mesh *boxes, struct trax_instance *instances,
                                 const struct two_levels *two) {
  const uint32_t count = two->mesh->instance_count;
  boxes->vertices = malloc(2 * (size_t)count * sizeof *boxes->vertices);
  boxes->triangles = calloc(count, sizeof *boxes->triangles);
  if (!boxes->vertices || !boxes->triangles)
    return scene_out_of_memory(two->error, "instances");
  uint64_t sources = 0;
  for (uint32_t i = 0; i < count; i++) {
    struct trax_instance *instance = &instances[i];
    if (make_instance(instance, two, i) != TRAX_OK)
      return TRAX_ERROR;
    instance->first_source = (uint32_t)sources;
    sources += two->scene.meshes[instance->mesh].source_count;
    if (sources > UINT32_MAX)
      return trax_fail(two->error, "instances of more than 4,294,967,295 triangles");
    const struct scene_box box = scene_instance_box(&two->scene, instance);
    for (int axis = 0; axis < 3; axis++)
      if (!(box.min[axis] >= -SCENE_MAX_COORDINATE && box.max[axis] <= SCENE_MAX_COORDINATE))
        return trax_fail(two->error, "instance %u (from 0) reaches beyond %g", i, (double)SCENE_MAX_COORDINATE);
    memcpy(boxes->vertices[2 * i], box.min, sizeof box.min);
    memcpy(boxes->vertices[2 * i + 1], box.max, sizeof box.max);
    boxes->triangles[i] = (struct trax_mesh_triangle){.vertices = {2 * i, 2 * i + 1, 2 * i + 1}, .source_id = i};
  }
  boxes->vertex_count = 2 * count, boxes->triangle_count = count;
  return TRAX_OK;
}

struct upper {
  struct two_levels *two;
  const struct scene_tree *tree;
  const uint32_t *positions;
  const struct trax_instance *instances; /* in the order of the mesh */
  uint32_t placed, numbers;              /* instances and their triangles so far */
  uint32_t max_depth;
};

static trax_scene_ref place_upper(struct upper *upper, uint32_t index, uint32_t depth, struct scene_box *box) {
  const struct scene_tree_node *node = &upper->tree->nodes[index];
  const struct trax_scene *scene = &upper->two->scene;
  if (node->triangle_count) {
    struct trax_instance *out = &((struct trax_instance *)scene->instances)[upper->placed];
    *box = node->box;
    *out = upper->instances[node->triangles[0]];
    out->first_number = upper->numbers;
    upper->numbers += scene->meshes[out->mesh].triangle_count;
    depth += 1 + scene->meshes[out->mesh].depth;
    upper->max_depth = depth > upper->max_depth ? depth : upper->max_depth;
    return (uint32_t)((const char *)&scene->instances[upper->placed++] - (const char *)scene->bytes) | 1;
  }
  struct scene_node out = {.count = 2};
  for (int i = 0; i < 2; i++)
    out.child[i] = place_upper(upper, node->child[i], depth + 1, &out.box[i]);
  *box = scene_box_around(&out);
  struct trax_bvh_node *to = (struct trax_bvh_node *)scene->nodes + upper->positions[index];
  trax_node_formats[TRAX_NODES_BINARY].code->write(to, &trax_node_formats[TRAX_NODES_BINARY], &out);
  return (uint32_t)((const char *)to - (const char *)scene->bytes);
}

static trax_status build_upper(struct two_levels *two, const struct trax_mesh *boxes,
                               const struct trax_instance *instances) {
  struct scene_tree tree = {0};
  struct scene_order order = {0};
  struct scene_box box;
  trax_status result = scene_build_tree(&tree, boxes, &two->upper, two->error);
  if (result == TRAX_OK)
    result = scene_order_duplicates(&tree, NULL, boxes, two->error);
  if (result == TRAX_OK)
    result = order_nodes(&order, &tree, &two->upper, two->error);
  if (result == TRAX_OK) {
    struct trax_scene_header *header = two->header;
    struct upper upper = {two, &tree, order.position, instances, 0, 0, 0};
    header->root = place_upper(&upper, 0, 0, &box);
    header->max_depth = upper.max_depth;
    memcpy(header->bounds_min, tree.bounds.min, sizeof header->bounds_min);
    memcpy(header->bounds_max, tree.bounds.max, sizeof header->bounds_max);
    for (uint32_t i = 0; i < two->scene.instance_count; i++) {
      struct trax_instance *instance = &((struct trax_instance *)two->scene.instances)[i];
      instance->stretch = scene_stretch_of(instance, &tree.bounds);
    }
  }
  scene_order_release(&order);
  scene_tree_release(&tree);
  return result;
}

static trax_status make_file(struct two_levels *two) {
  struct trax_mesh boxes = {0};
  struct trax_instance *instances = NULL;
  trax_status result = scene_make_palette(&two->palette, two->mesh, two->mesh->uvs != NULL, two->error);
  if (result == TRAX_OK)
    result = plan(two);
  if (result == TRAX_OK) {
    view_file(two);
    scene_copy_materials(two->scene.bytes, two->header->sections, &two->palette, two->mesh);
    result = place_parts(two);
  }
  if (result == TRAX_OK && !(instances = malloc(two->mesh->instance_count * sizeof *instances)))
    result = scene_out_of_memory(two->error, "instances");
  if (result == TRAX_OK)
    result = box_instances(&boxes, instances, two);
  if (result == TRAX_OK)
    result = build_upper(two, &boxes, instances);
  if (result == TRAX_OK)
    result = scene_check_lamps(&two->scene, "the meshes", two->error);
  free(instances);
  free(boxes.vertices);
  free(boxes.triangles);
  return result;
}

/* The program of the paper's workload is several times as fast if its stack, for LOCAL_DEPTH nodes, is in local memory.
   So the upper tree gets the levels that are left, if one more than the least suffices for it. */
static unsigned upper_depth(const struct two_levels *two) {
  enum { LOCAL_DEPTH = 36 };
  const unsigned room = TRAX_SCENE_MAX_DEPTH - 1 - two->depth, least = scene_least_height(two->mesh->instance_count, 1);
  unsigned most = two->parts.max_depth;
  if (most == 0)
    most = two->depth + 1 + least + 1 <= LOCAL_DEPTH ? LOCAL_DEPTH - 1 - two->depth : TRAX_SCENE_DEFAULT_DEPTH;
  return most < room ? most : room;
}

trax_status scene_build_two_levels(struct trax_scene *scene, const struct trax_mesh *mesh,
                                   const struct trax_build_options *options, trax_error *error) {
  if (check_options(options, error) != TRAX_OK)
    return TRAX_ERROR;
  struct two_levels two = {.mesh = mesh, .parts = *options, .error = error};
  two.parts.nodes = TRAX_NODES_BINARY;
  two.parts.choose_nodes = two.parts.choose_splits = false;
  two.parts.splits = 0;
  trax_status result = build_parts(&two);
  if (result == TRAX_OK) {
    two.upper = two.parts;
    two.upper.max_leaf = 1;
    two.upper.max_depth = upper_depth(&two);
    result = two.depth + 1 >= TRAX_SCENE_MAX_DEPTH
                 ? trax_fail(error, "--depth: no room is left for a tree over instances")
                 : make_file(&two);
  }
  if (result == TRAX_OK && scene_is_interrupted(options->interrupt))
    result = TRAX_INTERRUPTED;
  if (result == TRAX_OK) {
    two.header->checksum = (uint32_t)crc32_z(0, two.scene.bytes, two.scene.size);
    two.scene.grid = trax_scene_grid_of(two.header->bounds_min, two.header->bounds_max);
    *scene = two.scene;
  } else {
    free(two.scene.bytes);
  }
  for (uint32_t i = 0; i < mesh->part_count; i++) {
    if (two.trees)
      scene_tree_release(&two.trees[i]);
    if (two.orders)
      scene_order_release(&two.orders[i]);
  }
  free(two.trees);
  free(two.orders);
  scene_palette_release(&two.palette);
  return result;
}
