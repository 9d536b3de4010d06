/* One mesh file through assimp, flattened: node transforms applied, polygons cut, indices checked before assimp's own
   steps rely on them. Files are handed to assimp from memory, so that compressed ones work everywhere. */
#include "assimp_reader.h"

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- the file system that assimp sees --- */

struct file_system {
  struct aiFileIO io;
  const char *main_name; /* as given to assimp: without .xz or .gz */
  struct scene_bytes main_file;
  struct scene_limits limits;
  const trax_files *files; /* of the command */
  trax_error *error;       /* why a file that was opened must not be read */
  bool refused;
  uint32_t missing;
  char first_missing[256];
};

struct open_file {
  struct aiFile file;
  const unsigned char *data;
  size_t size, position;
  unsigned char *owned;
};

static struct open_file *opened(struct aiFile *file) {
  return (struct open_file *)file;
}

static size_t read_file(struct aiFile *file, char *buffer, size_t record_size, size_t count) {
  struct open_file *open = opened(file);
  if (record_size == 0)
    return 0;
  size_t records = (open->size - open->position) / record_size;
  if (records > count)
    records = count;
  memcpy(buffer, open->data + open->position, records * record_size);
  open->position += records * record_size;
  return records;
}

static size_t refuse_write(struct aiFile *file, const char *buffer, size_t record_size, size_t count) {
  (void)file, (void)buffer, (void)record_size, (void)count;
  return 0;
}

static size_t tell_file(struct aiFile *file) {
  return opened(file)->position;
}

static size_t file_size(struct aiFile *file) {
  return opened(file)->size;
}

static aiReturn seek_file(struct aiFile *file, size_t offset, enum aiOrigin origin) {
  struct open_file *open = opened(file);
  size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? open->position : open->size;
  /* assimp passes negative offsets as large size_t values: modular arithmetic is meant */
  size_t position = base + offset;
  if (position > open->size)
    return aiReturn_FAILURE;
  open->position = position;
  return aiReturn_SUCCESS;
}

static void flush_file(struct aiFile *file) {
  (void)file;
}

static struct aiFile *open_file(struct aiFileIO *io, const char *name, const char *mode) {
  struct file_system *system = (struct file_system *)io->UserData;
  if (mode[0] != 'r')
    return NULL;
  struct open_file *open = calloc(1, sizeof *open);
  if (!open)
    return NULL;
  if (!strcmp(name, system->main_name)) {
    open->data = system->main_file.data;
    open->size = system->main_file.size;
  } else {
    struct scene_bytes bytes;
    if (scene_load_referred(&bytes, name, system->limits) != TRAX_OK) {
      if (system->missing++ == 0)
        snprintf(system->first_missing, sizeof system->first_missing, "%s", name);
      free(open);
      return NULL;
    }
    open->data = open->owned = bytes.data;
    open->size = bytes.size;
    system->refused = system->refused || trax_files_check_input(system->files, name, system->error) != TRAX_OK;
  }
  open->file = (struct aiFile){.ReadProc = read_file,
                               .WriteProc = refuse_write,
                               .TellProc = tell_file,
                               .FileSizeProc = file_size,
                               .SeekProc = seek_file,
                               .FlushProc = flush_file};
  return &open->file;
}

static void close_file(struct aiFileIO *io, struct aiFile *file) {
  (void)io;
  if (file)
    free(opened(file)->owned);
  free(file);
}

/* --- geometry --- */

static trax_status check_nodes(const struct aiScene *scene, const struct aiNode *node, const char *path,
                               trax_error *error) {
  for (unsigned i = 0; i < node->mNumMeshes; i++)
    if (node->mMeshes[i] >= scene->mNumMeshes)
      return trax_fail(error, "%s: a node's mesh %u is out of range (%u meshes)", path, node->mMeshes[i],
                       scene->mNumMeshes);
  for (unsigned i = 0; i < node->mNumChildren; i++)
    if (check_nodes(scene, node->mChildren[i], path, error) != TRAX_OK)
      return TRAX_ERROR;
  return TRAX_OK;
}

static trax_status check_indices(const struct aiScene *scene, const char *path, trax_error *error) {
  for (unsigned m = 0; m < scene->mNumMeshes; m++) {
    const struct aiMesh *part = scene->mMeshes[m];
    if (part->mMaterialIndex >= (scene->mNumMaterials ? scene->mNumMaterials : 1))
      return trax_fail(error, "%s: mesh %u: material %u is out of range (%u materials)", path, m, part->mMaterialIndex,
                       scene->mNumMaterials);
    if (part->mNumVertices && !part->mVertices)
      return trax_fail(error, "%s: mesh %u: its vertices have no positions", path, m);
    for (unsigned f = 0; f < part->mNumFaces; f++) {
      const struct aiFace *face = &part->mFaces[f];
      if (face->mNumIndices == 0)
        return trax_fail(error, "%s: mesh %u: face %u has no vertices", path, m, f);
      if (face->mNumIndices > SCENE_ASSIMP_POLYGON)
        return trax_fail(error, "%s: mesh %u: face %u has %u vertices; in files of this kind polygons have at most %d",
                         path, m, f, face->mNumIndices, SCENE_ASSIMP_POLYGON);
      for (unsigned i = 0; i < face->mNumIndices; i++)
        if (face->mIndices[i] >= part->mNumVertices)
          return trax_fail(error, "%s: mesh %u: face %u: vertex index %u is out of range (%u vertices)", path, m, f,
                           face->mIndices[i], part->mNumVertices);
    }
  }
  return check_nodes(scene, scene->mRootNode, path, error);
}

/* What the nodes below one refer to, instances counted each time. */
static void count_geometry(const struct aiScene *scene, const struct aiNode *node, uint64_t *vertices,
                           uint64_t *triangles) {
  for (unsigned i = 0; i < node->mNumMeshes; i++) {
    *vertices += scene->mMeshes[node->mMeshes[i]]->mNumVertices;
    *triangles += scene->mMeshes[node->mMeshes[i]]->mNumFaces;
  }
  for (unsigned i = 0; i < node->mNumChildren; i++)
    count_geometry(scene, node->mChildren[i], vertices, triangles);
}

static bool is_identity(const struct aiMatrix4x4 *m) {
  static const struct aiMatrix4x4 identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  return !memcmp(m, &identity, sizeof identity);
}

static bool mirrors(const struct aiMatrix4x4 *m) {
  return m->a1 * (m->b2 * m->c3 - m->b3 * m->c2) - m->a2 * (m->b1 * m->c3 - m->b3 * m->c1) +
             m->a3 * (m->b1 * m->c2 - m->b2 * m->c1) <
         0;
}

/* Normals by the cofactors of the matrix, which is the inverse's transpose but for its length. */
static void copy_normals(float (*normals)[3][3], const struct aiMesh *part, const struct aiFace *face,
                         const struct aiMatrix4x4 *m, bool mirror) {
  const float side = mirror ? -1 : 1;
  for (unsigned corner = 0; corner < 3; corner++) {
    const struct aiVector3D n = part->mNormals[face->mIndices[mirror && corner ? 3 - corner : corner]];
    float *out = (*normals)[corner];
    out[0] = side * ((m->b2 * m->c3 - m->b3 * m->c2) * n.x + (m->b3 * m->c1 - m->b1 * m->c3) * n.y +
                     (m->b1 * m->c2 - m->b2 * m->c1) * n.z);
    out[1] = side * ((m->a3 * m->c2 - m->a2 * m->c3) * n.x + (m->a1 * m->c3 - m->a3 * m->c1) * n.y +
                     (m->a2 * m->c1 - m->a1 * m->c2) * n.z);
    out[2] = side * ((m->a2 * m->b3 - m->a3 * m->b2) * n.x + (m->a3 * m->b1 - m->a1 * m->b3) * n.y +
                     (m->a1 * m->b2 - m->a2 * m->b1) * n.z);
  }
}

static void copy_part(struct assimp_import *import, const struct aiMesh *part, const struct aiMatrix4x4 *m) {
  struct trax_mesh *mesh = import->mesh;
  uint32_t first = mesh->vertex_count;
  bool keep = is_identity(m), mirror = !keep && mirrors(m);
  for (unsigned i = 0; i < part->mNumVertices; i++) {
    struct aiVector3D v = part->mVertices[i];
    float *out = mesh->vertices[mesh->vertex_count++];
    out[0] = keep ? v.x : m->a1 * v.x + m->a2 * v.y + m->a3 * v.z + m->a4;
    out[1] = keep ? v.y : m->b1 * v.x + m->b2 * v.y + m->b3 * v.z + m->b4;
    out[2] = keep ? v.z : m->c1 * v.x + m->c2 * v.y + m->c3 * v.z + m->c4;
  }
  const struct assimp_uvs *from = &import->uvs[part->mMaterialIndex];
  const struct aiVector3D *uvs =
      from->channel < AI_MAX_NUMBER_OF_TEXTURECOORDS ? part->mTextureCoords[from->channel] : NULL;
  if (part->mColors[0])
    import->report->unread |= TRAX_UNREAD_COLOURS;
  for (unsigned i = 0; i < part->mNumFaces; i++) {
    const struct aiFace *face = &part->mFaces[i];
    if (face->mNumIndices != 3) { /* polygons have been cut: a point or a line */
      import->report->other_primitives++;
      continue;
    }
    const uint32_t number = mesh->triangle_count++;
    struct trax_mesh_triangle *triangle = &mesh->triangles[number];
    for (unsigned corner = 0; corner < 3; corner++) {
      const unsigned index = face->mIndices[mirror && corner ? 3 - corner : corner];
      triangle->vertices[corner] = first + index;
      if (mesh->uvs && uvs) {
        for (int axis = 0; axis < 2; axis++)
          mesh->uvs[number][corner][axis] =
              from->map[axis][0] * uvs[index].x + from->map[axis][1] * uvs[index].y + from->map[axis][2];
      }
    }
    if (mesh->normals && part->mNormals)
      copy_normals(&mesh->normals[number], part, face, m, mirror);
    triangle->material = part->mMaterialIndex;
    triangle->source_id = number;
  }
}

static void copy_node(struct assimp_import *import, const struct aiNode *node, const struct aiMatrix4x4 *parent) {
  struct aiMatrix4x4 transform = *parent;
  aiMultiplyMatrix4(&transform, &node->mTransformation);
  for (unsigned i = 0; i < node->mNumMeshes; i++)
    copy_part(import, import->scene->mMeshes[node->mMeshes[i]], &transform);
  for (unsigned i = 0; i < node->mNumChildren; i++)
    copy_node(import, node->mChildren[i], &transform);
}

static trax_status copy_geometry(struct assimp_import *import) {
  const struct aiScene *scene = import->scene;
  struct trax_mesh *mesh = import->mesh;
  uint64_t vertices = 0, triangles = 0;
  count_geometry(scene, scene->mRootNode, &vertices, &triangles);
  if (vertices > UINT32_MAX || triangles > UINT32_MAX)
    return trax_fail(import->error, "%s: too large: %llu vertices, %llu triangles", import->path,
                     (unsigned long long)vertices, (unsigned long long)triangles);
  bool normals = false, uvs = mesh->texture_count > 0;
  for (unsigned i = 0; i < scene->mNumMeshes; i++)
    normals = normals || scene->mMeshes[i]->mNormals;
  mesh->vertices = malloc((vertices ? vertices : 1) * sizeof *mesh->vertices);
  mesh->triangles = malloc((triangles ? triangles : 1) * sizeof *mesh->triangles);
  if (normals)
    mesh->normals = calloc(triangles ? triangles : 1, sizeof *mesh->normals);
  if (uvs)
    mesh->uvs = calloc(triangles ? triangles : 1, sizeof *mesh->uvs);
  if (!mesh->vertices || !mesh->triangles || (normals && !mesh->normals) || (uvs && !mesh->uvs))
    return scene_out_of_memory(import->error, import->path);
  struct aiMatrix4x4 identity;
  aiIdentityMatrix4(&identity);
  copy_node(import, scene->mRootNode, &identity);
  import->report->source_triangles += mesh->triangle_count;
  return TRAX_OK;
}

trax_status scene_read_with_assimp(struct trax_mesh *mesh, const char *path, const struct trax_import_options *options,
                                   struct trax_import_report *report, trax_error *error) {
  *mesh = (struct trax_mesh){0};
  struct file_system system = {.io = {.OpenProc = open_file, .CloseProc = close_file},
                               .limits = scene_limits_of(options->unpack_limit),
                               .files = options->files,
                               .error = error};
  system.io.UserData = (aiUserData)&system;
  char *name = scene_unpacked_name(path);
  if (!name)
    return scene_out_of_memory(error, path);
  system.main_name = name;
  const struct aiScene *scene = NULL;
  trax_status result = scene_load_file(&system.main_file, path, system.limits, error);
  if (result == TRAX_OK && system.main_file.size == 0)
    result = trax_fail(error, "%s: the file is empty", path);
  const bool gltf = scene_has_extension(name, ".gltf") || scene_has_extension(name, ".glb");
  if (result == TRAX_OK && gltf)
    result = scene_check_gltf(system.main_file, path, error);
  if (result == TRAX_OK) {
    /* No steps yet: they trust the indices. */
    scene = aiImportFileEx(name, 0, &system.io);
    if (system.refused) {
      result = TRAX_ERROR;
    } else if (!scene || !scene->mRootNode) {
      const char *reason = aiGetErrorString();
      result = reason && strstr(reason, "bad_alloc")
                   ? scene_out_of_memory(error, path)
                   : trax_fail(error, "%s: not a mesh that can be read: %s", path,
                               reason && reason[0] ? reason : "the importer gives no reason");
    }
  }
  if (result == TRAX_OK)
    result = check_indices(scene, path, error);
  if (result == TRAX_OK && !(scene = aiApplyPostProcessing(scene, aiProcess_Triangulate)))
    result = trax_fail(error, "%s: polygons cannot be cut into triangles: %s", path, aiGetErrorString());
  struct assimp_import import = {.path = name,
                                 .gltf = gltf,
                                 .scene = scene,
                                 .mesh = mesh,
                                 .report = report,
                                 .error = error,
                                 .textures = {.mesh = mesh, .options = options, .report = report}};
  if (result == TRAX_OK)
    result = assimp_copy_materials(&import);
  if (result == TRAX_OK)
    result = copy_geometry(&import);
  if (result == TRAX_OK)
    result = assimp_copy_cameras(&import);
  scene_textures_release(&import.textures);
  free(import.uvs);
  if (result == TRAX_OK && system.missing > 0) {
    if (report->missing_files == 0)
      memcpy(report->first_missing_file, system.first_missing, sizeof system.first_missing);
    report->missing_files += system.missing;
  }
  aiReleaseImport(scene);
  free(system.main_file.data);
  free(name);
  if (result != TRAX_OK)
    trax_mesh_release(mesh);
  return result;
}
