/* What the two files that read meshes by assimp share. */
#ifndef TRAX_SCENE_ASSIMP_READER_H
#define TRAX_SCENE_ASSIMP_READER_H

#include "internal.h"

#include <assimp/scene.h>

/* The texture coordinates of a material: which of a mesh's, and what brings them to the texture, as rows over (u, v, 1)
   with v up. */
struct assimp_uvs {
  unsigned channel;
  float map[2][3];
};

struct assimp_import {
  const char *path;
  bool gltf;
  const struct aiScene *scene;
  struct trax_mesh *mesh;
  struct trax_import_report *report;
  trax_error *error;
  struct scene_textures textures;
  struct assimp_uvs *uvs; /* of each material */
};

trax_status assimp_copy_materials(struct assimp_import *import);
trax_status assimp_copy_cameras(struct assimp_import *import);

#endif
