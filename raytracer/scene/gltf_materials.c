/* Materials and textures of glTF. */
#include "gltf.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- textures --- */

/* An image within the file is known by its number: "*3". */
static bool find_embedded(void *context, const char *name, struct scene_bytes *bytes) {
  struct gltf *gltf = context;
  char *end;
  const unsigned long number = name[0] == '*' ? strtoul(name + 1, &end, 10) : 0;
  if (name[0] != '*' || end == name + 1 || *end || number >= gltf_count(gltf, "images"))
    return false;
  *bytes = gltf->images[number].bytes;
  return true;
}

/* Sets `name`, which is to be freed, to that of an image. Loads an image within the file. */
static trax_status name_image(char **name, struct gltf *gltf, size_t number) {
  const json_t *image = json_array_get(json_object_get(gltf->root, "images"), number);
  const char *uri = json_string_value(json_object_get(image, "uri"));
  struct gltf_bytes *bytes = &gltf->images[number];
  const bool in_file = !uri || !strncmp(uri, "data:", 5);
  char text[32];
  snprintf(text, sizeof text, "*%zu", number);
  *name = strdup(in_file ? text : uri);
  if (!*name)
    return scene_out_of_memory(gltf->error, gltf->path);
  if (!in_file) {
    gltf_decode_name(*name);
    return TRAX_OK;
  }
  if (bytes->bytes.data)
    return TRAX_OK;
  if (!uri)
    return gltf_find_view(&bytes->bytes, gltf, json_object_get(image, "bufferView"));
  bytes->owned = true;
  return gltf_decode_data(&bytes->bytes, gltf, uri);
}

/* KHR_texture_transform: coordinates are scaled, turned counterclockwise around (0, 0) as they are seen, with v down,
   and moved. */
static void set_map(struct gltf_uvs *uvs, const json_t *transform) {
  double scale[2] = {1, 1}, offset[2] = {0, 0};
  const double angle = gltf_number(transform, "rotation", 0), c = cos(angle), s = sin(angle);
  gltf_numbers(scale, 2, transform, "scale");
  gltf_numbers(offset, 2, transform, "offset");
  const double down[2][3] = {{c * scale[0], s * scale[1], offset[0]}, {-s * scale[0], c * scale[1], offset[1]}};
  const double up[2][3] = {{down[0][0], -down[0][1], down[0][2] + down[0][1]},
                           {-down[1][0], down[1][1], 1 - down[1][2] - down[1][1]}};
  for (int axis = 0; axis < 2; axis++)
    for (int i = 0; i < 3; i++)
      uvs->map[axis][i] = (float)up[axis][i];
}

/* The texture that `slot` of a material names. Sets *uvs unless it is NULL. */
static trax_status find_texture(struct gltf *gltf, const json_t *slot, struct scene_texture wanted,
                                const struct scene_texture **found, struct gltf_uvs *uvs) {
  enum { CLAMP_TO_EDGE = 33071 };
  static const struct scene_texture none;
  *found = &none;
  if (!slot || gltf->options->no_textures)
    return TRAX_OK;
  const json_t *texture = gltf_item(gltf, "textures", json_object_get(slot, "index"));
  const size_t image = gltf_index(gltf, "images", json_object_get(texture, "source"));
  if (image == SIZE_MAX) {
    if (gltf->report->bad_images++ == 0)
      snprintf(gltf->report->first_bad_image, sizeof gltf->report->first_bad_image,
               "%.180s: a texture has no image that can be read", gltf->path);
    return TRAX_OK;
  }
  const json_t *transform = gltf_extension(slot, "KHR_texture_transform");
  if (uvs) {
    const double set = gltf_number(transform, "texCoord", gltf_number(slot, "texCoord", 0));
    uvs->set = set >= 0 && set < 1000 ? (uint32_t)set : 0;
    set_map(uvs, transform);
  }
  char *name;
  trax_status result = name_image(&name, gltf, image);
  wanted.base = name;
  wanted.flags =
      gltf_number(gltf_item(gltf, "samplers", json_object_get(texture, "sampler")), "wrapS", 0) == CLAMP_TO_EDGE
          ? TRAX_TEXTURE_CLAMP
          : 0;
  if (result == TRAX_OK)
    result = scene_find_texture(&gltf->textures, &wanted, gltf->path, found, gltf->error);
  free(name);
  return result;
}

/* --- materials --- */

/* A surface of at least this roughness is Lambert's: glTF's roughness is 1 without a texture or a factor. */
#define LAMBERT_ROUGHNESS 0.95f
#define MIRROR_ROUGHNESS 0.05f

/* glTF 2.0, appendix B (its BRDF), and the extensions transmission and ior. The texture of metal and roughness counts
   by its means, and so does that of a specular base colour, because our textures are of diffuse colours. */
static trax_status set_kind(struct gltf *gltf, const json_t *material, struct trax_material *surface,
                            const struct scene_texture *base) {
  const json_t *pbr = json_object_get(material, "pbrMetallicRoughness");
  const struct scene_texture *factors;
  trax_status result =
      find_texture(gltf, json_object_get(pbr, "metallicRoughnessTexture"),
                   (struct scene_texture){.use = SCENE_TEXTURE_DATA, .mean_only = true}, &factors, NULL);
  if (result != TRAX_OK)
    return result;
  float roughness = (float)gltf_number(pbr, "roughnessFactor", 1), metal = (float)gltf_number(pbr, "metallicFactor", 1);
  if (factors->good)
    roughness *= factors->mean[1], metal *= factors->mean[2];
  roughness = scene_clamp_colour(roughness), metal = scene_clamp_colour(metal);
  float ior = (float)gltf_number(gltf_extension(material, "KHR_materials_ior"), "ior", 1.5);
  ior = fminf(fmaxf(ior, 1), TRAX_SCENE_MAX_IOR);
  const float normal = (ior - 1) / (ior + 1) * ((ior - 1) / (ior + 1));
  float tint[3];
  for (int channel = 0; channel < 3; channel++)
    tint[channel] = surface->diffuse[channel] * (base->good ? base->mean[channel] : 1);

  if (gltf_number(gltf_extension(material, "KHR_materials_transmission"), "transmissionFactor", 0) > 0.5) {
    surface->kind = TRAX_MATERIAL_GLASS;
    surface->ior = ior;
    memcpy(surface->specular, tint, sizeof tint);
  } else if (metal > 0.5f && roughness < MIRROR_ROUGHNESS) {
    surface->kind = TRAX_MATERIAL_MIRROR;
    memcpy(surface->specular, tint, sizeof tint);
  } else if (roughness < LAMBERT_ROUGHNESS) {
    surface->kind = TRAX_MATERIAL_GGX;
    surface->roughness = roughness * roughness;
    for (int channel = 0; channel < 3; channel++) {
      surface->diffuse[channel] *= 1 - metal;
      surface->specular[channel] = scene_clamp_colour(normal + metal * (tint[channel] - normal));
    }
  }
  return TRAX_OK;
}

static void set_alpha(const json_t *material, struct trax_material *surface, double opacity,
                      const struct scene_texture *base) {
  const char *mode = gltf_text(material, "alphaMode");
  const bool mask = !strcmp(mode, "MASK");
  if (!mask && strcmp(mode, "BLEND") != 0)
    return;
  surface->opacity = scene_clamp_colour((float)opacity);
  if (surface->opacity < 1 || base->number)
    surface->alpha_cutoff = mask ? scene_clamp_colour((float)gltf_number(material, "alphaCutoff", 0.5)) : 0.5f;
}

static trax_status set_emission(struct gltf *gltf, const json_t *material, struct trax_material *surface) {
  double factor[3] = {0, 0, 0};
  const double strength =
      gltf_number(gltf_extension(material, "KHR_materials_emissive_strength"), "emissiveStrength", 1);
  const struct scene_texture *map;
  gltf_numbers(factor, 3, material, "emissiveFactor");
  trax_status result = find_texture(gltf, json_object_get(material, "emissiveTexture"),
                                    (struct scene_texture){.mean_only = true}, &map, NULL);
  for (int channel = 0; channel < 3 && result == TRAX_OK; channel++) {
    const float value = (float)(factor[channel] * strength) * (map->good ? map->mean[channel] : 1);
    surface->emission[channel] = value > 0 ? fminf(value, TRAX_SCENE_MAX_EMISSION) : 0;
  }
  return result;
}

static trax_status copy_material(struct gltf *gltf, const json_t *material, struct trax_material *surface,
                                 struct gltf_uvs *uvs) {
  /* The older model of specular and glossy surfaces: only its diffuse part is read. */
  const json_t *glossy = gltf_extension(material, "KHR_materials_pbrSpecularGlossiness");
  const json_t *model = glossy ? glossy : json_object_get(material, "pbrMetallicRoughness");
  double colour[4] = {1, 1, 1, 1};
  gltf_numbers(colour, 4, model, glossy ? "diffuseFactor" : "baseColorFactor");
  const struct scene_texture *base;
  trax_status result = find_texture(gltf, json_object_get(model, glossy ? "diffuseTexture" : "baseColorTexture"),
                                    (struct scene_texture){0}, &base, uvs);
  if (!gltf->options->no_textures && json_object_get(material, "normalTexture"))
    gltf->report->unread |= TRAX_UNREAD_NORMAL_MAPS;
  if (result != TRAX_OK)
    return result;
  surface->texture = base->number;
  for (int channel = 0; channel < 3; channel++)
    surface->diffuse[channel] = scene_clamp_colour((float)colour[channel]);
  result = set_emission(gltf, material, surface);
  set_alpha(material, surface, colour[3], base);
  return result == TRAX_OK ? set_kind(gltf, material, surface, base) : result;
}

/* The last material is that of primitives without one. */
trax_status gltf_copy_materials(struct gltf *gltf) {
  struct trax_mesh *mesh = gltf->mesh;
  const size_t count = gltf_count(gltf, "materials");
  gltf->textures.embedded = find_embedded;
  gltf->textures.context = gltf;
  mesh->materials = calloc(count + 1, sizeof *mesh->materials);
  gltf->uvs = calloc(count + 1, sizeof *gltf->uvs);
  if (!mesh->materials || !gltf->uvs || count > UINT32_MAX - 1)
    return scene_out_of_memory(gltf->error, gltf->path);
  mesh->material_count = (uint32_t)count + 1;
  trax_status result = TRAX_OK;
  for (size_t i = 0; i <= count && result == TRAX_OK; i++) {
    const json_t *material = json_array_get(json_object_get(gltf->root, "materials"), i);
    mesh->materials[i].surface = trax_default_material;
    set_map(&gltf->uvs[i], NULL);
    trax_mesh_name(mesh->materials[i].name, gltf_text(material, "name"));
    if (material)
      result = copy_material(gltf, material, &mesh->materials[i].surface, &gltf->uvs[i]);
  }
  return result;
}
