/* The conversion of assimp's scenes under libFuzzer: a case's bytes are read as decisions from which a scene is made as
   assimp might hand it over, with indices of any value, transforms of any floats, missing arrays, materials with any
   properties. assimp itself is not part of it: where it crashes, a child process does. What is accepted makes a scene
   that passes every check. */
#include "files.h"

#include <assimp/GltfMaterial.h>
#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const struct aiScene *__wrap_aiImportFileEx(const char *name, unsigned flags, struct aiFileIO *io);
const struct aiScene *__wrap_aiApplyPostProcessing(const struct aiScene *scene, unsigned flags);
void __wrap_aiReleaseImport(const struct aiScene *scene);

/* --- decisions --- */

static const uint8_t *input, *input_end;

static uint32_t below(uint32_t limit) {
  const uint8_t byte = input < input_end ? *input++ : 0;
  return byte % limit;
}

static float any_float(void) {
  static const float some[] = {0, 1, -1, 0.5f, 2, 1e-30f, 1e30f, __builtin_inff(), __builtin_nanf(""), -0.0f, 7, 100};
  if (below(2))
    return some[below(sizeof some / sizeof *some)];
  float value = 0;
  if (input_end - input >= 4) {
    memcpy(&value, input, sizeof value);
    input += sizeof value;
  }
  return value;
}

static void any_floats(void *to, size_t count) {
  float *values = to;
  for (size_t i = 0; i < count; i++)
    values[i] = any_float();
}

/* --- memory, all of it released with the scene --- */

enum { most_blocks = 4096 };
static void *blocks[most_blocks];
static unsigned block_count;

static void *make(size_t count, size_t size) {
  void *block = block_count < most_blocks ? calloc(count ? count : 1, size) : NULL;
  if (!block)
    abort();
  return blocks[block_count++] = block;
}

/* --- the scene --- */

static void set_name(struct aiString *name) {
  static const char *const names[] = {"",        "a",     "b", AI_DEFAULT_MATERIAL_NAME, "*0", "*1", "*99999999999",
                                      "a%2epng", "a.png", "%"};
  name->length = (ai_uint32)snprintf(name->data, sizeof name->data, "%s", names[below(sizeof names / sizeof *names)]);
}

static struct aiMaterialProperty *property(const char *key, unsigned semantic, unsigned index) {
  struct aiMaterialProperty *out = make(1, sizeof *out);
  out->mKey.length = (ai_uint32)snprintf(out->mKey.data, sizeof out->mKey.data, "%s", key);
  out->mSemantic = semantic;
  out->mIndex = index;
  /* Of another type than the key has it, assimp's own functions throw. */
  if (!strcmp(key, "?mat.name") || !strcmp(key, "$tex.file") || !strcmp(key, "$mat.gltf.alphaMode")) {
    struct aiString text;
    static const char *const modes[] = {"MASK", "BLEND", "OPAQUE"};
    if (below(2))
      text.length = (ai_uint32)snprintf(text.data, sizeof text.data, "%s", modes[below(3)]);
    else
      set_name(&text);
    out->mType = aiPTI_String;
    out->mDataLength = 4 + text.length + 1;
    out->mData = make(1, out->mDataLength);
    memcpy(out->mData, &text.length, 4);
    memcpy(out->mData + 4, text.data, text.length + 1);
  } else {
    const unsigned count = !strcmp(key, "$tex.uvtrafo") ? sizeof(struct aiUVTransform) / 4 : 1 + below(4);
    out->mType = aiPTI_Float;
    out->mDataLength = 4 * count;
    out->mData = make(count, 4);
    any_floats(out->mData, count);
  }
  return out;
}

static struct aiMaterial *material(void) {
  static const struct {
    const char *key;
    unsigned semantic;
  } keys[] = {{"?mat.name", 0},
              {"$clr.diffuse", 0},
              {"$clr.emissive", 0},
              {"$mat.metallicFactor", 0},
              {"$mat.roughnessFactor", 0},
              {"$mat.refracti", 0},
              {"$mat.gltf.alphaMode", 0},
              {"$mat.gltf.alphaCutoff", 0},
              {"$mat.transmission.factor", 0},
              {"$tex.file", aiTextureType_DIFFUSE},
              {"$tex.uvwsrc", aiTextureType_DIFFUSE},
              {"$tex.mapmodeu", aiTextureType_DIFFUSE},
              {"$tex.uvtrafo", aiTextureType_DIFFUSE},
              {"$tex.file", aiTextureType_UNKNOWN},
              {"$tex.file", aiTextureType_EMISSIVE},
              {"$tex.file", aiTextureType_BASE_COLOR}};
  struct aiMaterial *out = make(1, sizeof *out);
  out->mNumProperties = below(12);
  out->mProperties = make(out->mNumProperties, sizeof *out->mProperties);
  for (unsigned i = 0; i < out->mNumProperties; i++) {
    const unsigned key = below(sizeof keys / sizeof *keys);
    out->mProperties[i] = property(keys[key].key, keys[key].semantic, 0);
  }
  return out;
}

static struct aiMesh *mesh(void) {
  struct aiMesh *out = make(1, sizeof *out);
  out->mNumVertices = below(12);
  out->mNumFaces = below(12);
  out->mMaterialIndex = below(5);
  if (below(16))
    out->mVertices = make(out->mNumVertices, sizeof *out->mVertices);
  if (out->mVertices)
    any_floats(out->mVertices, 3 * (size_t)out->mNumVertices);
  if (below(2)) {
    out->mNormals = make(out->mNumVertices, sizeof *out->mNormals);
    any_floats(out->mNormals, 3 * (size_t)out->mNumVertices);
  }
  for (int channel = 0; channel < 2; channel++)
    if (below(2)) {
      out->mTextureCoords[channel] = make(out->mNumVertices, sizeof **out->mTextureCoords);
      any_floats(out->mTextureCoords[channel], 3 * (size_t)out->mNumVertices);
    }
  out->mFaces = make(out->mNumFaces, sizeof *out->mFaces);
  for (unsigned i = 0; i < out->mNumFaces; i++) {
    struct aiFace *face = &out->mFaces[i];
    face->mNumIndices = 1 + below(3);
    face->mIndices = make(face->mNumIndices, sizeof *face->mIndices);
    for (unsigned k = 0; k < face->mNumIndices; k++)
      face->mIndices[k] = below(32) ? below(out->mNumVertices ? out->mNumVertices : 1) : below(255) * 0x01010101u;
  }
  return out;
}

static struct aiNode *node(const struct aiScene *scene, unsigned depth) {
  struct aiNode *out = make(1, sizeof *out);
  set_name(&out->mName);
  aiIdentityMatrix4(&out->mTransformation);
  if (below(2))
    any_floats(&out->mTransformation, 12);
  out->mNumMeshes = scene->mNumMeshes ? below(4) : 0;
  out->mMeshes = make(out->mNumMeshes, sizeof *out->mMeshes);
  for (unsigned i = 0; i < out->mNumMeshes; i++)
    out->mMeshes[i] = below(32) ? below(scene->mNumMeshes) : below(255);
  out->mNumChildren = depth < 4 ? below(4) : 0;
  out->mChildren = make(out->mNumChildren, sizeof *out->mChildren);
  for (unsigned i = 0; i < out->mNumChildren; i++)
    out->mChildren[i] = node(scene, depth + 1);
  return out;
}

static struct aiTexture *texture(void) {
  struct aiTexture *out = make(1, sizeof *out);
  if (below(2)) { /* texels */
    out->mWidth = below(20);
    out->mHeight = 1 + below(20);
    out->pcData = make((size_t)out->mWidth * out->mHeight, sizeof *out->pcData);
  } else { /* a file: one of the case's */
    const fuzz_file *file = fuzz_case_find(fuzz_files, "a.png");
    out->mWidth = file ? (unsigned)file->size : 0;
    out->pcData = make(out->mWidth, 1);
    if (file && file->size)
      memcpy(out->pcData, file->bytes, file->size);
  }
  return out;
}

static struct aiCamera *camera(void) {
  struct aiCamera *out = make(1, sizeof *out);
  set_name(&out->mName);
  any_floats(&out->mPosition, 3);
  any_floats(&out->mUp, 3);
  any_floats(&out->mLookAt, 3);
  out->mHorizontalFOV = any_float();
  out->mAspect = any_float();
  return out;
}

const struct aiScene *__wrap_aiImportFileEx(const char *name, unsigned flags, struct aiFileIO *io) {
  (void)name, (void)flags, (void)io;
  struct aiScene *scene = make(1, sizeof *scene);
  scene->mNumMaterials = below(4);
  scene->mMaterials = make(scene->mNumMaterials, sizeof *scene->mMaterials);
  for (unsigned i = 0; i < scene->mNumMaterials; i++)
    scene->mMaterials[i] = material();
  scene->mNumTextures = below(3);
  scene->mTextures = make(scene->mNumTextures, sizeof *scene->mTextures);
  for (unsigned i = 0; i < scene->mNumTextures; i++)
    scene->mTextures[i] = texture();
  scene->mNumMeshes = below(4);
  scene->mMeshes = make(scene->mNumMeshes, sizeof *scene->mMeshes);
  for (unsigned i = 0; i < scene->mNumMeshes; i++)
    scene->mMeshes[i] = mesh();
  scene->mNumCameras = below(3);
  scene->mCameras = make(scene->mNumCameras, sizeof *scene->mCameras);
  for (unsigned i = 0; i < scene->mNumCameras; i++)
    scene->mCameras[i] = camera();
  if (below(32))
    scene->mRootNode = node(scene, 0);
  return scene;
}

const struct aiScene *__wrap_aiApplyPostProcessing(const struct aiScene *scene, unsigned flags) {
  (void)flags;
  return scene; /* its faces have three corners or fewer */
}

void __wrap_aiReleaseImport(const struct aiScene *scene) {
  (void)scene;
  while (block_count > 0)
    free(blocks[--block_count]);
}

/* The case is not a file's bytes, but what assimp has made of one. */
trax_status __wrap_scene_check_gltf(struct scene_bytes file, const char *path, trax_error *error);
trax_status __wrap_scene_check_gltf(struct scene_bytes file, const char *path, trax_error *error) {
  (void)file, (void)path, (void)error;
  return TRAX_OK;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
  fuzz_case fuzz_case;
  fuzz_case_read(&fuzz_case, bytes, size);
  fuzz_files = &fuzz_case;
  if (fuzz_case.file_count) {
    const struct trax_import_options options = {.in_process = true, .texture_size = 16, .drop_nonfinite = size % 2};
    const char *path = size % 4 < 2 ? "scene.glb" : "scene.dae";
    fuzz_file *file = &fuzz_case.files[0];
    struct trax_mesh mesh;
    trax_error error = {.message = ""};
    snprintf(file->name, sizeof file->name, "%s", path);
    input = file->bytes;
    input_end = input + file->size;
    if (trax_mesh_import(&mesh, &path, 1, &options, NULL, &error) == TRAX_OK) {
      fuzz_build(&mesh);
      trax_mesh_release(&mesh);
    } else if (!error.message[0])
      abort(); /* refused without a reason */
    while (block_count > 0)
      free(blocks[--block_count]);
  }
  fuzz_case_free(&fuzz_case);
  return 0;
}
