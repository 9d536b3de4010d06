/* What the two files that read meshes by assimp share. */
#ifndef TRAX_SCENE_ASSIMP_READER_H
#define TRAX_SCENE_ASSIMP_READER_H

#include "internal.h"

#include <assimp/scene.h>

struct assimp_import {
  const char *path;
  bool gltf;
  const struct aiScene *scene;
  struct trax_mesh *mesh;
  struct trax_import_report *report;
  trax_error *error;
  struct scene_textures textures;
  unsigned *uv_channels; /* of each material's texture */
};

trax_status assimp_copy_materials(struct assimp_import *import);
trax_status assimp_copy_cameras(struct assimp_import *import);

#endif
