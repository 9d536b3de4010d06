/* Makes the bytes of a scene file from a mesh and its tree. */
#include "layout.h"
#include "crew.h"
#include "placing.h"
#include "trax/output.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { LEAST_FOR_TWO = 1 << 14 }; /* nodes of a tree that is worth a second thread */

void scene_plan_section(struct trax_scene_section *section, uint64_t *end, uint32_t count, size_t record_size) {
  if (count == 0)
    return;
  section->offset = (uint32_t)*end;
  section->size = (uint32_t)(count * record_size);
  section->count = count;
  section->record_size = (uint32_t)record_size;
  *end += ((uint64_t)count * record_size + TRAX_SCENE_ALIGNMENT - 1) / TRAX_SCENE_ALIGNMENT * TRAX_SCENE_ALIGNMENT;
}

void *scene_section_bytes(unsigned char *bytes, const struct trax_scene_section *section) {
  return section->count ? bytes + section->offset : NULL;
}

/* Halves the angle from 180 degrees down to 2^-40: cos(a / 2) = sqrt((1 + cos a) / 2). No two libraries differ. */
double scene_crease_cosine(const struct trax_build_options *options) {
  double degrees = options->crease_degrees > 0 ? (double)options->crease_degrees : TRAX_DEFAULT_CREASE;
  double cosine = 1, sine = 0, step_cosine = -1, step_sine = 0, step = 180; /* of the angle so far, and the next step */
  for (int i = 0; i < 40; i++) {
    if (degrees >= step) {
      const double turned = cosine * step_cosine - sine * step_sine;
      sine = sine * step_cosine + cosine * step_sine;
      cosine = turned;
      degrees -= step;
    }
    step_sine = __builtin_sqrt((1 - step_cosine) / 2);
    step_cosine = __builtin_sqrt((1 + step_cosine) / 2);
    step /= 2;
  }
  return cosine;
}

/* Each face around a corner counts once, even if it is in several leaves. */
static trax_status make_normals(const struct layout *layout, double cosine, trax_error *error) {
  trax_status (*const make)(struct trax_triangle_normals *, const struct trax_triangle *, uint32_t, double,
                            trax_error *) = layout->file_normals ? scene_complete_normals : scene_smooth_normals;
  if (!layout->numbers)
    return make(layout->normals, layout->triangles, layout->next_triangle, cosine, error);
  const uint32_t count = layout->mesh->triangle_count;
  struct trax_triangle_normals *normals = calloc(count, sizeof *normals);
  struct trax_triangle *triangles = calloc(count, sizeof *triangles);
  trax_status result = TRAX_OK;
  if (!normals || !triangles)
    result = scene_out_of_memory(error, "normals");
  for (uint32_t i = 0; i < layout->next_triangle && result == TRAX_OK; i++) {
    normals[layout->numbers[i]] = layout->normals[i];
    triangles[layout->numbers[i]] = layout->triangles[i];
  }
  if (result == TRAX_OK)
    result = make(normals, triangles, count, cosine, error);
  for (uint32_t i = 0; i < layout->next_triangle && result == TRAX_OK; i++)
    layout->normals[i] = normals[layout->numbers[i]];
  free(normals);
  free(triangles);
  return result;
}

/* The work of two threads at the same time: the triangles, and the positions of nodes. */
struct placing_work {
  struct layout *layout;
  size_t size; /* of the scene */
  struct scene_order *order;
  const struct trax_build_options *options;
  trax_status status;
  trax_error *error;
};

static void place_triangles(struct scene_worker *worker, void *pointer) {
  (void)worker;
  const struct placing_work *work = pointer;
  memset(work->layout->bytes, 0, work->size);
  if (!work->layout->wide)
    scene_place_triangles(work->layout);
}

static void order_nodes(struct scene_worker *worker, void *pointer) {
  (void)worker;
  struct placing_work *work = pointer;
  const struct trax_build_options *options = work->options;
  if (!work->order->position)
    work->status = scene_order_nodes(work->order, work->layout->tree, options->nodes,
                                     options->cache_lines ? options->cache_lines : SCENE_CACHE_LINES,
                                     options->interrupt, work->error);
}

static trax_status lay_out(struct trax_scene *scene, const struct trax_mesh *mesh, const struct scene_tree *tree,
                           const struct palette *palette, struct scene_order *order, struct scene_wide *wide,
                           struct scene_crew *crew, const struct trax_build_options *options, trax_error *error) {
  const uint32_t node_count = wide ? wide->count : tree->inner_count;
  struct trax_scene_header header = {.magic = TRAX_SCENE_MAGIC,
                                     .version = TRAX_SCENE_VERSION,
                                     .node_layout = options->nodes,
                                     .max_depth = wide ? wide->entries : tree->max_depth,
                                     .max_leaf = tree->max_leaf,
                                     .triangle_count = tree->ref_count};
  uint64_t end = sizeof header;
  struct trax_scene_section *sections = header.sections;
  scene_plan_section(&sections[TRAX_SCENE_NODES], &end, node_count, trax_node_formats[options->nodes].bytes);
  scene_plan_section(&sections[TRAX_SCENE_TRIANGLES], &end, tree->ref_count, sizeof(struct trax_triangle));
  if (options->smooth)
    scene_plan_section(&sections[TRAX_SCENE_NORMALS], &end, tree->ref_count, sizeof(struct trax_triangle_normals));
  if (palette->texture_count)
    scene_plan_section(&sections[TRAX_SCENE_UVS], &end, tree->ref_count, sizeof(struct trax_triangle_uvs));
  if (scene_plan_materials(sections, &end, palette, options->without_source_ids ? 0 : tree->ref_count, error) !=
      TRAX_OK)
    return TRAX_ERROR;
  if (end > UINT32_MAX)
    return trax_fail(error, "%u triangles make a scene of %.1f GB; 32-bit offsets end at 4.29", tree->ref_count,
                     (double)end * 1e-9);
  unsigned char *bytes = aligned_alloc(TRAX_SCENE_ALIGNMENT, end);
  if (!bytes)
    return scene_out_of_memory(error, "scene");
  header.file_size = (uint32_t)end;

  struct layout layout = {.mesh = mesh,
                          .tree = tree,
                          .materials = palette->of_mesh,
                          .wide = wide,
                          .node_layout = options->nodes,
                          .bytes = bytes,
                          .nodes = scene_section_bytes(bytes, &sections[TRAX_SCENE_NODES]),
                          .triangles = scene_section_bytes(bytes, &sections[TRAX_SCENE_TRIANGLES]),
                          .normals = scene_section_bytes(bytes, &sections[TRAX_SCENE_NORMALS]),
                          .uvs = scene_section_bytes(bytes, &sections[TRAX_SCENE_UVS]),
                          .source_ids = scene_section_bytes(bytes, &sections[TRAX_SCENE_SOURCE_IDS]),
                          .file_normals = mesh->normals && !options->compute_normals,
                          .nodes_offset = sections[TRAX_SCENE_NODES].offset,
                          .triangles_offset = sections[TRAX_SCENE_TRIANGLES].offset};
  if (layout.normals && tree->ref_count != mesh->triangle_count &&
      !(layout.numbers = malloc(tree->ref_count * sizeof *layout.numbers))) {
    free(bytes);
    return scene_out_of_memory(error, "normals");
  }
  struct placing_work work = {&layout, end, order, options, TRAX_OK, error};
  if (!scene_crew_add(crew, place_triangles, &work))
    place_triangles(NULL, &work);
  scene_crew_run(crew, order_nodes, &work);
  if (work.status != TRAX_OK) {
    free(layout.numbers);
    free(bytes);
    return work.status;
  }
  layout.positions = order->position;
  if (wide)
    scene_place_wide(wide, tree, order->position);
  scene_copy_materials(bytes, sections, palette, mesh);
  if (mesh->triangle_count) {
    memcpy(header.bounds_min, tree->bounds.min, sizeof tree->bounds.min);
    memcpy(header.bounds_max, tree->bounds.max, sizeof tree->bounds.max);
    layout.grid = trax_scene_grid_of(header.bounds_min, header.bounds_max);
    struct scene_box bounds;
    header.root =
        wide && wide->count ? scene_place_wide_node(&layout, 0, &bounds) : scene_place_subtree(&layout, 0, &bounds);
  }
  if (layout.normals) {
    const trax_status result = make_normals(&layout, scene_crease_cosine(options), error);
    free(layout.numbers);
    if (result != TRAX_OK) {
      free(bytes);
      return result;
    }
  }
  if (scene_is_interrupted(options->interrupt)) {
    free(bytes);
    return TRAX_INTERRUPTED;
  }
  memcpy(bytes, &header, sizeof header);
  header.checksum = (uint32_t)crc32_z(0, bytes, end);
  memcpy(bytes, &header, sizeof header);

  *scene = (struct trax_scene){.bytes = bytes,
                               .size = end,
                               .header = (const struct trax_scene_header *)bytes,
                               .nodes = layout.nodes,
                               .triangles = layout.triangles,
                               .normals = layout.normals,
                               .uvs = layout.uvs,
                               .materials = scene_section_bytes(bytes, &sections[TRAX_SCENE_MATERIALS]),
                               .textures = scene_section_bytes(bytes, &sections[TRAX_SCENE_TEXTURES]),
                               .texels = scene_section_bytes(bytes, &sections[TRAX_SCENE_TEXELS]),
                               .source_ids = layout.source_ids,
                               .node_count = node_count,
                               .triangle_count = tree->ref_count,
                               .material_count = palette->count,
                               .texture_count = palette->texture_count,
                               .texel_count = (uint32_t)palette->texel_count,
                               .grid = layout.grid};
  return TRAX_OK;
}

trax_status trax_scene_build(struct trax_scene *scene, const struct trax_mesh *mesh,
                             const struct trax_build_options *options, trax_error *error) {
  static const struct trax_build_options defaults;
  if (!options)
    options = &defaults;
  *scene = (struct trax_scene){0};
  if (mesh->triangle_count == 0 && !options->allow_empty)
    return trax_fail(error, "the mesh has no triangles");
  if (mesh->instance_count)
    return scene_build_two_levels(scene, mesh, options, error);
  struct scene_tree tree;
  struct scene_order order = {0};
  struct trax_build_options chosen = *options;
  trax_status result = options->refit ? scene_refit_tree(&tree, &order.position, mesh, options, error)
                                      : scene_build_tree(&tree, mesh, options, error);
  if (result != TRAX_OK)
    return result;
  if (options->refit)
    chosen.nodes = options->refit->header->node_layout;
  else if (chosen.choose_nodes && tree.inner_count)
    chosen.nodes = scene_grid_suits(&tree) ? TRAX_NODES_QUANTISED : TRAX_NODES_BINARY;
  chosen.splits = tree.split ? TRAX_DEFAULT_SPLITS : 0;
  options = &chosen;
  struct scene_crew *crew = scene_crew_new(tree.node_count < LEAST_FOR_TWO ? 1 : options->threads);
  if (!crew)
    result = scene_out_of_memory(error, "scene");
  scene_report(options, SCENE_LAY_OUT, 0);
  struct palette palette = {0};
  struct scene_wide wide = {0};
  const bool is_wide = trax_node_formats[options->nodes].children > 2 && tree.node_count;
  if (is_wide && result == TRAX_OK)
    result = scene_widen(&wide, &tree, options->nodes) ? TRAX_OK : scene_out_of_memory(error, "BVH");
  if (result == TRAX_OK && !tree.split && !tree.unique)
    result = scene_order_duplicates(&tree, wide.leaves, mesh, error);
  else if (result == TRAX_OK && wide.leaves)
    result = scene_order_split_duplicates(&tree, wide.leaves, mesh, error);
  if (result == TRAX_OK && scene_is_interrupted(options->interrupt))
    result = TRAX_INTERRUPTED;
  if (result == TRAX_OK) {
    result = scene_make_palette(&palette, mesh, mesh->uvs != NULL, error);
    if (result == TRAX_OK)
      result = lay_out(scene, mesh, &tree, &palette, &order, is_wide ? &wide : NULL, crew, options, error);
    scene_palette_release(&palette);
  }
  scene_crew_release(crew);
  scene_wide_release(&wide);
  scene_order_release(&order);
  scene_tree_release(&tree);
  if (result == TRAX_OK && options->tree_nodes) { /* checks that the leaves of a triangle cover it */
    result = trax_scene_check(NULL, scene->bytes, scene->size, options->tree_nodes, error);
    if (result != TRAX_OK)
      trax_scene_release(scene);
  }
  return result;
}

trax_status trax_scene_write(const struct trax_scene *scene, const char *path, trax_error *error) {
  return trax_write_file(path, scene->bytes, scene->size, error);
}

void trax_scene_release(struct trax_scene *scene) {
  free(scene->bytes);
  *scene = (struct trax_scene){0};
}
