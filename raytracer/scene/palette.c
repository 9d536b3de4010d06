/* The materials and textures of a scene file. */
#include "layout.h"

#include <stdlib.h>
#include <string.h>

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
