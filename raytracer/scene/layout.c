/* From a mesh and its tree to the bytes of a scene file. */
#include "layout.h"
#include "placing.h"
#include "trax/output.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* --- materials --- */

/* Members that a kind does not read get the values of trax_default_material, so that equal materials compare equal. */
static struct trax_material canonical(const struct trax_material *material) {
  struct trax_material out = *material;
  if (out.kind != TRAX_MATERIAL_LAMBERT && out.kind != TRAX_MATERIAL_GGX)
    memcpy(out.diffuse, trax_default_material.diffuse, sizeof out.diffuse);
  if (out.kind == TRAX_MATERIAL_LAMBERT)
    memcpy(out.specular, trax_default_material.specular, sizeof out.specular);
  if (out.kind != TRAX_MATERIAL_GGX)
    out.roughness = trax_default_material.roughness;
  if (out.kind != TRAX_MATERIAL_GLASS)
    out.ior = trax_default_material.ior;
  if (!(out.alpha_cutoff > 0))
    out.opacity = trax_default_material.opacity;
  /* -0 is 0: materials are compared by their bytes. */
  float *const colours[] = {out.diffuse, out.specular, out.emission};
  for (int i = 0; i < 9; i++)
    colours[i / 3][i % 3] += 0.0f;
  out.reserved = 0;
  return out;
}

struct numbered_material {
  struct trax_material material;
  uint32_t number;
};

static int compare_materials(const void *a, const void *b) {
  const struct numbered_material *left = a, *right = b;
  int order = memcmp(&left->material, &right->material, sizeof left->material);
  return order ? order : left->number < right->number ? -1 : 1;
}

void scene_palette_release(struct palette *palette) {
  free(palette->of_mesh);
  free(palette->materials);
  free(palette->textures);
}

/* Numbers the textures in the order in which materials use them. */
static void number_textures(struct palette *palette, uint32_t *numbers, const struct trax_mesh *mesh) {
  for (uint32_t i = 0; i < palette->count; i++) {
    uint32_t *texture = &palette->materials[i].texture;
    if (*texture == 0)
      continue;
    const struct trax_mesh_texture *source = &mesh->textures[*texture - 1];
    uint32_t *number = &numbers[*texture - 1];
    if (*number == 0) {
      palette->textures[palette->texture_count] = *texture - 1;
      palette->texel_count += (uint64_t)1 << (source->log2_width + source->log2_height);
      *number = ++palette->texture_count;
    }
    *texture = *number;
  }
}

/* Numbered in the order of the mesh's materials. */
trax_status scene_make_palette(struct palette *palette, const struct trax_mesh *mesh, bool textures,
                               trax_error *error) {
  enum { unused = UINT32_MAX };
  size_t count = mesh->material_count;
  *palette = (struct palette){.of_mesh = malloc((count + 1) * sizeof(uint32_t)),
                              .materials = calloc(count + 1, sizeof(struct trax_material)),
                              .textures = malloc((mesh->texture_count + (size_t)1) * sizeof(uint32_t))};
  struct numbered_material *sorted = malloc((count + 1) * sizeof *sorted);
  uint32_t *first = malloc((count + 1) * sizeof *first); /* the first material in use that is the same */
  uint32_t *numbers = calloc(mesh->texture_count + (size_t)1, sizeof *numbers);
  if (!palette->of_mesh || !palette->materials || !palette->textures || !sorted || !first || !numbers) {
    free(sorted);
    free(first);
    free(numbers);
    return scene_out_of_memory(error, "materials");
  }
  for (size_t i = 0; i < count; i++)
    palette->of_mesh[i] = unused;
  for (uint32_t i = 0; i < mesh->triangle_count; i++)
    palette->of_mesh[mesh->triangles[i].material] = 0;
  for (uint32_t i = 0; i < mesh->instance_count; i++)
    if (mesh->instances[i].material != TRAX_NO_MATERIAL)
      palette->of_mesh[mesh->instances[i].material] = 0;
  size_t used = 0;
  for (uint32_t i = 0; i < count; i++)
    if (palette->of_mesh[i] != (uint32_t)unused) {
      sorted[used] = (struct numbered_material){canonical(&mesh->materials[i].surface), i};
      if (!textures)
        sorted[used].material.texture = 0;
      used++;
    }
  qsort(sorted, used, sizeof *sorted, compare_materials);
  for (size_t i = 0; i < used; i++) {
    bool same = i > 0 && !memcmp(&sorted[i].material, &sorted[i - 1].material, sizeof sorted[i].material);
    first[sorted[i].number] = same ? first[sorted[i - 1].number] : sorted[i].number;
  }
  for (uint32_t i = 0; i < count; i++) {
    if (palette->of_mesh[i] == (uint32_t)unused)
      continue;
    if (first[i] == i) {
      struct trax_material *material = &palette->materials[palette->count];
      *material = canonical(&mesh->materials[i].surface);
      if (!textures)
        material->texture = 0;
      palette->of_mesh[i] = palette->count++;
    } else
      palette->of_mesh[i] = palette->of_mesh[first[i]];
  }
  number_textures(palette, numbers, mesh);
  free(sorted);
  free(first);
  free(numbers);
  return TRAX_OK;
}

/* --- the tree --- */

static trax_scene_ref place_leaf(struct layout *layout, const struct scene_tree_node *node) {
  uint32_t offset = layout->triangles_offset + layout->next_triangle * (uint32_t)sizeof(struct trax_triangle);
  for (uint32_t i = 0; i < node->triangle_count; i++) {
    const struct trax_mesh_triangle *source = &layout->mesh->triangles[node->triangles[i]];
    struct trax_triangle *triangle = &layout->triangles[layout->next_triangle];
    float *corners[3] = {triangle->v0, triangle->v1, triangle->v2};
    for (int corner = 0; corner < 3; corner++)
      memcpy(corners[corner], layout->mesh->vertices[source->vertices[corner]], 3 * sizeof(float));
    triangle->material = layout->materials[source->material];
    if (layout->normals && layout->file_normals)
      memcpy(layout->normals[layout->next_triangle].corner, layout->mesh->normals[node->triangles[i]],
             sizeof layout->normals->corner);
    /* Without a texture they stay zeros: nothing reads them, and their range was not checked. */
    if (layout->uvs && layout->mesh->uvs && layout->mesh->materials[source->material].surface.texture)
      memcpy(layout->uvs[layout->next_triangle].corner, layout->mesh->uvs[node->triangles[i]],
             sizeof layout->uvs->corner);
    if (layout->numbers)
      layout->numbers[layout->next_triangle] = node->triangles[i];
    if (layout->source_ids)
      layout->source_ids[layout->next_triangle] = source->source_id;
    layout->next_triangle++;
  }
  return offset | node->triangle_count;
}

/* Recursion is bounded by the depth of the tree, at most TRAX_SCENE_MAX_DEPTH. */
trax_scene_ref scene_place_subtree(struct layout *layout, uint32_t index, struct scene_box *box) {
  const struct scene_tree_node *node = &layout->tree->nodes[index];
  if (node->triangle_count) {
    *box = scene_box_as_stored(layout->node_layout, &layout->grid, &node->box);
    return place_leaf(layout, node);
  }
  struct scene_node out = {.count = 2};
  for (int i = 0; i < 2; i++)
    out.child[i] = scene_place_subtree(layout, node->child[i], &out.box[i]);
  *box = scene_box_around(&out);
  const uint32_t offset = layout->positions[index] * trax_node_formats[layout->node_layout].bytes;
  scene_node_write(layout->nodes + offset, layout->node_layout, &out);
  return layout->nodes_offset + offset;
}

static trax_scene_ref place_wide(struct layout *layout, uint32_t number, struct scene_box *box);

static void place_child(struct layout *layout, struct scene_node *out, uint32_t i, uint32_t index) {
  const struct scene_tree_node *node = &layout->tree->nodes[index];
  out->child[i] = node->triangle_count ? scene_place_subtree(layout, index, &out->box[i])
                                       : place_wide(layout, layout->wide->number[index], &out->box[i]);
}

/* A leaf's box in a frame may be larger than the part that it is for: what counts above is the box that is stored, as
   far as there are triangles in it. That is also all that the checker knows. */
static void read_back(struct scene_node *out, const struct layout *layout, const struct scene_wide_node *wide,
                      const void *bytes) {
  struct scene_node stored;
  scene_node_read(&stored, layout->node_layout, bytes);
  for (uint32_t i = 0; i < out->count; i++) {
    const struct scene_tree_node *leaf = &layout->tree->nodes[wide->child[i]];
    struct scene_box whole = scene_empty_box();
    for (uint32_t k = 0; k < leaf->triangle_count; k++) {
      const struct scene_box one = scene_triangle_box(layout->mesh, leaf->triangles[k]);
      scene_box_add_box(&whole, &one);
    }
    if (leaf->triangle_count)
      out->box[i] = scene_box_within(&stored.box[i], &whole);
  }
}

static trax_scene_ref place_wide(struct layout *layout, uint32_t number, struct scene_box *box) {
  const struct scene_wide_node *wide = &layout->wide->nodes[number];
  const bool leaves_first = layout->wide->leaves != NULL;
  struct scene_node out = {.count = wide->count};
  memcpy(out.slot, wide->slot, sizeof out.slot);
  for (uint32_t i = 0; i < wide->count; i++)
    if (!leaves_first || layout->tree->nodes[wide->child[i]].triangle_count)
      place_child(layout, &out, i, wide->child[i]);
  for (uint32_t i = 0; i < wide->count; i++)
    if (leaves_first && !layout->tree->nodes[wide->child[i]].triangle_count)
      place_child(layout, &out, i, wide->child[i]);
  const uint32_t offset = layout->wide->position[number] * trax_node_formats[layout->node_layout].bytes;
  scene_node_write(layout->nodes + offset, layout->node_layout, &out);
  if (layout->node_layout == TRAX_NODES_WIDE8)
    read_back(&out, layout, wide, layout->nodes + offset);
  *box = scene_box_around(&out);
  return layout->nodes_offset + offset;
}

/* --- the file --- */

void scene_plan_section(struct trax_scene_section *section, uint64_t *end, uint32_t count, size_t record_size) {
  if (count == 0)
    return;
  section->offset = (uint32_t)*end;
  section->size = (uint32_t)(count * record_size);
  section->count = count;
  section->record_size = (uint32_t)record_size;
  *end += ((uint64_t)count * record_size + TRAX_SCENE_ALIGNMENT - 1) / TRAX_SCENE_ALIGNMENT * TRAX_SCENE_ALIGNMENT;
}

trax_status scene_plan_materials(struct trax_scene_section *sections, uint64_t *end, const struct palette *palette,
                                 uint32_t source_ids, trax_error *error) {
  scene_plan_section(&sections[TRAX_SCENE_MATERIALS], end, palette->count, sizeof(struct trax_material));
  scene_plan_section(&sections[TRAX_SCENE_TEXTURES], end, palette->texture_count, sizeof(struct trax_texture));
  if (palette->texel_count > UINT32_MAX / sizeof(uint32_t))
    return trax_fail(error, "the textures take %.1f GB; --texture-size makes them smaller",
                     (double)palette->texel_count * sizeof(uint32_t) * 1e-9);
  scene_plan_section(&sections[TRAX_SCENE_TEXELS], end, (uint32_t)palette->texel_count, sizeof(uint32_t));
  /* Last: nothing on the device reads it. */
  scene_plan_section(&sections[TRAX_SCENE_SOURCE_IDS], end, source_ids, sizeof(uint32_t));
  return TRAX_OK;
}

void *scene_section_bytes(unsigned char *bytes, const struct trax_scene_section *section) {
  return section->count ? bytes + section->offset : NULL;
}

/* To 2^-40, by halving the angle from 180 degrees: cos(a / 2) = sqrt((1 + cos a) / 2), and no two libraries differ. */
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

void scene_copy_materials(unsigned char *bytes, const struct trax_scene_section *sections,
                          const struct palette *palette, const struct trax_mesh *mesh) {
  if (palette->count)
    memcpy(bytes + sections[TRAX_SCENE_MATERIALS].offset, palette->materials,
           palette->count * sizeof *palette->materials);
  struct trax_texture *out = scene_section_bytes(bytes, &sections[TRAX_SCENE_TEXTURES]);
  uint32_t at = sections[TRAX_SCENE_TEXELS].offset;
  for (uint32_t i = 0; i < palette->texture_count; i++) {
    const struct trax_mesh_texture *source = &mesh->textures[palette->textures[i]];
    const uint32_t size = (uint32_t)sizeof(uint32_t) << (source->log2_width + source->log2_height);
    out[i] = (struct trax_texture){at, source->log2_width, source->log2_height, source->flags};
    memcpy(bytes + at, mesh->texels + source->first_texel, size);
    at += size;
  }
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

static trax_status lay_out(struct trax_scene *scene, const struct trax_mesh *mesh, const struct scene_tree *tree,
                           const struct palette *palette, const uint32_t *positions, const struct scene_wide *wide,
                           const struct trax_build_options *options, trax_error *error) {
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
  memset(bytes, 0, end);
  header.file_size = (uint32_t)end;

  struct layout layout = {.mesh = mesh,
                          .tree = tree,
                          .materials = palette->of_mesh,
                          .positions = positions,
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
  scene_copy_materials(bytes, sections, palette, mesh);
  if (mesh->triangle_count) {
    memcpy(header.bounds_min, tree->bounds.min, sizeof tree->bounds.min);
    memcpy(header.bounds_max, tree->bounds.max, sizeof tree->bounds.max);
    layout.grid = trax_scene_grid_of(header.bounds_min, header.bounds_max);
    struct scene_box bounds;
    header.root = wide && wide->count ? place_wide(&layout, 0, &bounds) : scene_place_subtree(&layout, 0, &bounds);
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
  scene_report(options, SCENE_LAY_OUT, 0);
  struct palette palette = {0};
  struct scene_wide wide = {0};
  const bool is_wide = trax_node_formats[options->nodes].children > 2 && tree.node_count;
  if (is_wide)
    result = scene_widen(&wide, &tree, options->nodes, error);
  if (result == TRAX_OK && !tree.split && !tree.unique)
    result = scene_order_duplicates(&tree, wide.leaves, mesh, error);
  else if (result == TRAX_OK && wide.leaves)
    result = scene_order_split_duplicates(&tree, wide.leaves, mesh, error);
  if (result == TRAX_OK && scene_is_interrupted(options->interrupt))
    result = TRAX_INTERRUPTED;
  if (result == TRAX_OK && !order.position)
    result =
        scene_order_nodes(&order, &tree, options->nodes,
                          options->cache_lines ? options->cache_lines : SCENE_CACHE_LINES, options->interrupt, error);
  if (result == TRAX_OK && is_wide)
    scene_place_wide(&wide, &tree, order.position);
  if (result == TRAX_OK) {
    result = scene_make_palette(&palette, mesh, mesh->uvs != NULL, error);
    if (result == TRAX_OK)
      result = lay_out(scene, mesh, &tree, &palette, order.position, is_wide ? &wide : NULL, options, error);
    scene_palette_release(&palette);
  }
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
