/* Materials, textures and cameras of what assimp has read. */
#include "assimp_reader.h"

#include <assimp/GltfMaterial.h>
#include <assimp/camera.h>
#include <assimp/cimport.h>
#include <assimp/material.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* assimp makes a material up for what has none; ours takes its place. */
static bool is_placeholder(const struct aiScene *scene, unsigned number, const char *name, bool gltf) {
  if (gltf)
    return number + 1 == scene->mNumMaterials && name[0] == 0; /* appended by assimp for primitives without one */
  return !strcmp(name, AI_DEFAULT_MATERIAL_NAME);
}

/* --- textures --- */

/* "*3" is the fourth one within the file. */
static bool find_embedded(void *context, const char *name, struct scene_bytes *file, struct scene_image *image) {
  const struct aiScene *scene = context;
  char *end;
  unsigned long number = name[0] == '*' ? strtoul(name + 1, &end, 10) : 0;
  if (name[0] != '*' || end == name + 1 || *end)
    return false;
  *file = (struct scene_bytes){0};
  if (number >= scene->mNumTextures || !scene->mTextures[number]->pcData)
    return true;
  const struct aiTexture *texture = scene->mTextures[number];
  if (texture->mHeight == 0) {
    *file = (struct scene_bytes){(unsigned char *)texture->pcData, texture->mWidth};
    return true;
  }
  const uint64_t count = (uint64_t)texture->mWidth * texture->mHeight;
  if (count == 0 || count > 1u << 26 || !(image->rgba = malloc(4 * count)))
    return true;
  image->width = texture->mWidth;
  image->height = texture->mHeight;
  for (uint64_t i = 0; i < count; i++) {
    const struct aiTexel texel = texture->pcData[i];
    memcpy(image->rgba + 4 * i, (const unsigned char[4]){texel.r, texel.g, texel.b, texel.a}, 4);
  }
  return true;
}

/* The name with %XX as bytes: glTF's are URIs. */
static void decode_uri(char *name) {
  char *to = name;
  for (const char *from = name; *from; from++) {
    unsigned byte;
    if (from[0] == '%' && sscanf(from + 1, "%2x", &byte) == 1 && byte > 0 && from[1] && from[2]) {
      *to++ = (char)byte;
      from += 2;
    } else
      *to++ = *from;
  }
  *to = 0;
}

static const struct assimp_uvs ordinary_uvs = {0, {{1, 0, 0}, {0, 1, 0}}};

static float rounded(double value) {
  return (float)(rint(value * 0x1p20) * 0x1p-20);
}

/* glTF's extension KHR_texture_transform: coordinates are scaled, turned counterclockwise around (0, 0) as they are
   seen, with v down, and moved. assimp (5.2) has made of it a turn around the middle with v up, by changing what is
   added; that is taken back here, and rounded to what is left of its precision. */
static void set_gltf_map(struct assimp_uvs *uvs, const struct aiUVTransform *transform) {
  const double turn = -(double)transform->mRotation, c = cos(turn), s = sin(turn);
  const double scale_u = transform->mScaling.x, scale_v = transform->mScaling.y;
  const float move_u = rounded(transform->mTranslation.x - 0.5 * scale_u * (1 - c + s));
  const float move_v = rounded(0.5 * scale_v * (s + c - 1) + 1 - scale_v - transform->mTranslation.y);
  const double down[2][3] = {{c * scale_u, s * scale_v, move_u}, {-s * scale_u, c * scale_v, move_v}};
  const double up[2][3] = {{down[0][0], -down[0][1], down[0][2] + down[0][1]},
                           {-down[1][0], down[1][1], 1 - down[1][2] - down[1][1]}};
  for (int axis = 0; axis < 2; axis++)
    for (int i = 0; i < 3; i++)
      uvs->map[axis][i] = rounded(up[axis][i]);
}

static void find_uvs(const struct assimp_import *import, const struct aiMaterial *material, enum aiTextureType type,
                     unsigned index, struct assimp_uvs *uvs) {
  struct aiUVTransform transform;
  if (aiGetMaterialUVTransform(material, AI_MATKEY_UVTRANSFORM(type, index), &transform) != aiReturn_SUCCESS)
    return;
  if (import->gltf)
    set_gltf_map(uvs, &transform);
  else if (transform.mTranslation.x != 0 || transform.mTranslation.y != 0 || transform.mScaling.x != 1 ||
           transform.mScaling.y != 1 || transform.mRotation != 0)
    import->report->unread |= TRAX_UNREAD_UV_TRANSFORMS;
}

/* *uvs: what its coordinates are; NULL: no matter. */
static trax_status find_texture(struct assimp_import *import, const struct aiMaterial *material,
                                enum aiTextureType type, unsigned index, struct scene_texture wanted,
                                const struct scene_texture **found, struct assimp_uvs *uvs) {
  static const struct scene_texture none;
  struct aiString name;
  enum aiTextureMapMode modes[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
  unsigned coordinates = 0;
  *found = &none;
  if (aiGetMaterialTexture(material, type, index, &name, NULL, &coordinates, NULL, NULL, modes, NULL) !=
          aiReturn_SUCCESS ||
      name.length == 0)
    return TRAX_OK;
  if (import->gltf)
    decode_uri(name.data);
  wanted.base = name.data;
  wanted.flags = modes[0] == aiTextureMapMode_Clamp ? TRAX_TEXTURE_CLAMP : 0;
  if (uvs) {
    uvs->channel = coordinates;
    find_uvs(import, material, type, index, uvs);
  }
  return scene_find_texture(&import->textures, &wanted, import->path, found, import->error);
}

/* --- materials --- */

static float float_of(const struct aiMaterial *material, const char *key, unsigned type, unsigned index,
                      float otherwise) {
  float value;
  unsigned one = 1;
  return aiGetMaterialFloatArray(material, key, type, index, &value, &one) == aiReturn_SUCCESS && isfinite(value)
             ? value
             : otherwise;
}

/* How rough glTF's roughness must be for a surface to be Lambert's: without a texture or a factor it is 1. */
#define LAMBERT_ROUGHNESS 0.95f
#define MIRROR_ROUGHNESS 0.05f

/* glTF 2.0, appendix B (its BRDF), and the extensions transmission and ior. The texture of metal and roughness counts
   by its means, and so does that of the base colour where it is specular: our textures are of diffuse colours. */
static trax_status set_gltf(struct assimp_import *import, const struct aiMaterial *material,
                            struct trax_material *surface, const struct scene_texture *base) {
  const struct scene_texture *factors;
  trax_status result =
      find_texture(import, material, AI_MATKEY_GLTF_PBRMETALLICROUGHNESS_METALLICROUGHNESS_TEXTURE,
                   (struct scene_texture){.use = SCENE_TEXTURE_DATA, .mean_only = true}, &factors, NULL);
  if (result != TRAX_OK)
    return result;
  float roughness = float_of(material, AI_MATKEY_ROUGHNESS_FACTOR, 1),
        metal = float_of(material, AI_MATKEY_METALLIC_FACTOR, 1);
  if (factors->good)
    roughness *= factors->mean[1], metal *= factors->mean[2];
  roughness = scene_clamp_colour(roughness), metal = scene_clamp_colour(metal);
  float ior = float_of(material, AI_MATKEY_REFRACTI, 1.5f);
  ior = fminf(fmaxf(ior, 1), TRAX_SCENE_MAX_IOR);
  const float normal = (ior - 1) / (ior + 1) * ((ior - 1) / (ior + 1));
  float tint[3];
  for (int channel = 0; channel < 3; channel++)
    tint[channel] = surface->diffuse[channel] * (base->good ? base->mean[channel] : 1);

  if (float_of(material, AI_MATKEY_TRANSMISSION_FACTOR, 0) > 0.5f) {
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

static void set_alpha(const struct aiMaterial *material, struct trax_material *surface, float opacity,
                      const struct scene_texture *base) {
  struct aiString mode;
  if (aiGetMaterialString(material, AI_MATKEY_GLTF_ALPHAMODE, &mode) != aiReturn_SUCCESS ||
      !strcmp(mode.data, "OPAQUE"))
    return;
  surface->opacity = scene_clamp_colour(opacity);
  if (surface->opacity < 1 || base->number)
    surface->alpha_cutoff =
        !strcmp(mode.data, "MASK") ? scene_clamp_colour(float_of(material, AI_MATKEY_GLTF_ALPHACUTOFF, 0.5f)) : 0.5f;
}

static trax_status set_emission(struct assimp_import *import, const struct aiMaterial *material,
                                struct trax_material *surface) {
  struct aiColor4D colour;
  if (aiGetMaterialColor(material, AI_MATKEY_COLOR_EMISSIVE, &colour) != aiReturn_SUCCESS)
    return TRAX_OK;
  const struct scene_texture *map;
  trax_status result =
      find_texture(import, material, aiTextureType_EMISSIVE, 0, (struct scene_texture){.mean_only = true}, &map, NULL);
  const float strength = float_of(material, AI_MATKEY_EMISSIVE_INTENSITY, 1), rgb[3] = {colour.r, colour.g, colour.b};
  for (int channel = 0; channel < 3 && result == TRAX_OK; channel++) {
    const float value = rgb[channel] * strength * (map->good ? map->mean[channel] : 1);
    surface->emission[channel] = value > 0 ? fminf(value, TRAX_SCENE_MAX_EMISSION) : 0;
  }
  return result;
}

static trax_status copy_material(struct assimp_import *import, const struct aiMaterial *material,
                                 struct trax_material *surface, struct assimp_uvs *uvs) {
  const struct scene_texture *base;
  trax_status result = find_texture(import, material, aiTextureType_DIFFUSE, 0, (struct scene_texture){0}, &base, uvs);
  if (result == TRAX_OK && !base->good)
    result = find_texture(import, material, aiTextureType_BASE_COLOR, 0, (struct scene_texture){0}, &base, uvs);
  if (result != TRAX_OK)
    return result;
  if (!import->textures.options->no_textures && (aiGetMaterialTextureCount(material, aiTextureType_NORMALS) > 0 ||
                                                 aiGetMaterialTextureCount(material, aiTextureType_HEIGHT) > 0))
    import->report->unread |= TRAX_UNREAD_NORMAL_MAPS;
  struct aiColor4D colour = {1, 1, 1, 1};
  const bool coloured =
      aiGetMaterialColor(material, AI_MATKEY_COLOR_DIFFUSE, &colour) == aiReturn_SUCCESS || base->good;
  surface->texture = base->number;
  if (coloured) {
    surface->diffuse[0] = scene_clamp_colour(colour.r);
    surface->diffuse[1] = scene_clamp_colour(colour.g);
    surface->diffuse[2] = scene_clamp_colour(colour.b);
  }
  result = set_emission(import, material, surface);
  if (result == TRAX_OK && import->gltf) {
    set_alpha(material, surface, colour.a, base);
    result = set_gltf(import, material, surface, base);
  }
  return result;
}

trax_status assimp_copy_materials(struct assimp_import *import) {
  const struct aiScene *scene = import->scene;
  struct trax_mesh *mesh = import->mesh;
  const unsigned count = scene->mNumMaterials;
  mesh->materials = calloc(count ? count : 1, sizeof *mesh->materials);
  import->uvs = calloc(count ? count : 1, sizeof *import->uvs);
  if (!mesh->materials || !import->uvs)
    return scene_out_of_memory(import->error, import->path);
  mesh->material_count = count ? count : 1;
  mesh->materials[0].surface = trax_default_material;
  import->uvs[0] = ordinary_uvs;
  import->textures.embedded = find_embedded;
  import->textures.context = (void *)scene;
  trax_status result = TRAX_OK;
  for (unsigned i = 0; i < count && result == TRAX_OK; i++) {
    struct trax_mesh_material *material = &mesh->materials[i];
    material->surface = trax_default_material;
    import->uvs[i] = ordinary_uvs;
    struct aiString name;
    if (aiGetMaterialString(scene->mMaterials[i], AI_MATKEY_NAME, &name) == aiReturn_SUCCESS)
      trax_mesh_name(material->name, name.data);
    if (!is_placeholder(scene, i, material->name, import->gltf))
      result = copy_material(import, scene->mMaterials[i], &material->surface, &import->uvs[i]);
  }
  return result;
}

/* --- cameras --- */

static const struct aiNode *find_node(const struct aiNode *node, const struct aiString *name, struct aiMatrix4x4 *to) {
  const struct aiMatrix4x4 above = *to;
  aiMultiplyMatrix4(to, &node->mTransformation);
  if (node->mName.length == name->length && !memcmp(node->mName.data, name->data, name->length))
    return node;
  for (unsigned i = 0; i < node->mNumChildren; i++) {
    struct aiMatrix4x4 below = *to;
    const struct aiNode *found = find_node(node->mChildren[i], name, &below);
    if (found) {
      *to = below;
      return found;
    }
  }
  *to = above;
  return NULL;
}

static bool unit(float v[3]) {
  const float length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  for (int axis = 0; axis < 3; axis++)
    v[axis] /= length;
  return length > 0 && isfinite(length);
}

/* A camera that has no direction, or whose values are not finite, is left out. The place of glTF's is in its node
   alone; assimp (5.2) puts it into the camera as well. */
static bool copy_camera(struct trax_mesh_camera *out, const struct aiScene *scene, const struct aiCamera *camera,
                        bool gltf) {
  struct aiMatrix4x4 m;
  aiIdentityMatrix4(&m);
  find_node(scene->mRootNode, &camera->mName, &m);
  const struct aiVector3D p = gltf ? (struct aiVector3D){0, 0, 0} : camera->mPosition, d = camera->mLookAt,
                          u = camera->mUp;
  *out = (struct trax_mesh_camera){
      .eye = {m.a1 * p.x + m.a2 * p.y + m.a3 * p.z + m.a4, m.b1 * p.x + m.b2 * p.y + m.b3 * p.z + m.b4,
              m.c1 * p.x + m.c2 * p.y + m.c3 * p.z + m.c4},
      .direction = {m.a1 * d.x + m.a2 * d.y + m.a3 * d.z, m.b1 * d.x + m.b2 * d.y + m.b3 * d.z,
                    m.c1 * d.x + m.c2 * d.y + m.c3 * d.z},
      .up = {m.a1 * u.x + m.a2 * u.y + m.a3 * u.z, m.b1 * u.x + m.b2 * u.y + m.b3 * u.z,
             m.c1 * u.x + m.c2 * u.y + m.c3 * u.z}};
  trax_mesh_name(out->name, camera->mName.data);
  if (!unit(out->direction) || !unit(out->up))
    return false;
  const float along = out->up[0] * out->direction[0] + out->up[1] * out->direction[1] + out->up[2] * out->direction[2];
  for (int axis = 0; axis < 3; axis++)
    out->up[axis] -= along * out->direction[axis];
  const float aspect = camera->mAspect > 0 ? camera->mAspect : 1, pi = 3.14159265f;
  out->fov = 2 * atanf(tanf(camera->mHorizontalFOV / 2) / aspect) * (180 / pi);
  return unit(out->up) && isfinite(out->eye[0]) && isfinite(out->eye[1]) && isfinite(out->eye[2]) && out->fov > 0;
}

trax_status assimp_copy_cameras(struct assimp_import *import) {
  const struct aiScene *scene = import->scene;
  struct trax_mesh *mesh = import->mesh;
  if (scene->mNumCameras == 0)
    return TRAX_OK;
  mesh->cameras = calloc(scene->mNumCameras, sizeof *mesh->cameras);
  if (!mesh->cameras)
    return scene_out_of_memory(import->error, import->path);
  for (unsigned i = 0; i < scene->mNumCameras; i++)
    mesh->camera_count += copy_camera(&mesh->cameras[mesh->camera_count], scene, scene->mCameras[i], import->gltf);
  return TRAX_OK;
}
