/* Shared by the files that read glTF 2.0: its JSON, and the bytes that it refers to. */
#ifndef TRAX_SCENE_GLTF_H
#define TRAX_SCENE_GLTF_H

#include "internal.h"

#include <jansson.h>

/* A material's texture coordinates: which set of the primitive's, and a matrix over (u, v, 1), v up on both sides. */
struct gltf_uvs {
  uint32_t set;
  float map[2][3];
};

/* Bytes outside of the JSON. */
struct gltf_bytes {
  struct scene_bytes bytes; /* data: NULL until they are loaded */
  bool owned;               /* to be released */
};

/* A node's transform: a matrix, or translation, rotation (a quaternion) and scale, applied from the last to the first.
 */
struct gltf_pose {
  bool is_matrix;
  double matrix[3][4], move[3], turn[4], scale[3];
  double global[3][4]; /* with those of the nodes above it; of an animation only */
  double *weights;     /* of the mesh's morph targets, as an animation sets them; NULL: it does not */
  uint32_t weight_count;
};

struct gltf {
  const char *path; /* without .xz or .gz */
  const struct trax_import_options *options;
  struct trax_import_report *report;
  trax_error *error;
  json_t *root;
  struct scene_bytes body;    /* the second chunk of a GLB; part of the file */
  struct gltf_bytes *buffers; /* as many as the JSON names */
  struct gltf_bytes *images;  /* the same, but for images in files of their own */
  uint64_t bytes_read;        /* of all files */
  struct trax_mesh *mesh;
  struct scene_textures textures;
  struct gltf_uvs *uvs;    /* of each material of the mesh */
  struct gltf_pose *poses; /* of each node at the time of an animation; NULL: as the file has them */
};

/* The element of a top-level array that `reference`, a number, names; NULL: there is none. */
const json_t *gltf_item(const struct gltf *gltf, const char *array, const json_t *reference);
size_t gltf_count(const struct gltf *gltf, const char *array);
/* The index of that element; SIZE_MAX: there is none. */
size_t gltf_index(const struct gltf *gltf, const char *array, const json_t *reference);
/* A member that is a finite number, else `otherwise`. */
double gltf_number(const json_t *object, const char *key, double otherwise);
/* An array of finite numbers; false, with nothing set, if the member is not one of this length. */
bool gltf_numbers(double *numbers, size_t count, const json_t *object, const char *key);
/* A string, "" if there is none. */
const char *gltf_text(const json_t *object, const char *key);
const json_t *gltf_extension(const json_t *object, const char *name);

/* The bytes of a URI with base64 data, and of a buffer view. */
trax_status gltf_decode_data(struct scene_bytes *bytes, const struct gltf *gltf, const char *uri);
trax_status gltf_find_view(struct scene_bytes *bytes, struct gltf *gltf, const json_t *reference);
/* Replaces %XX by bytes. */
void gltf_decode_name(char *name);

struct gltf_accessor {
  const unsigned char *data;
  uint32_t count; /* of elements */
  size_t stride;
  unsigned components; /* of an element, 1 to 4; 16: a matrix by columns */
  int type;            /* of a component, glTF's number */
  bool normalised;     /* integers stand for 0 to 1 or -1 to 1 */
};

trax_status gltf_find_accessor(struct gltf_accessor *accessor, struct gltf *gltf, const json_t *reference);
/* The first `count` components of an element. */
void gltf_read(float *values, unsigned count, const struct gltf_accessor *accessor, uint32_t element);
uint32_t gltf_read_index(const struct gltf_accessor *accessor, uint32_t element);

/* gltf_materials.c */
trax_status gltf_copy_materials(struct gltf *gltf);

/* gltf_nodes.c: checks that nodes form trees, and copies the meshes and cameras of the scene's nodes. */
trax_status gltf_copy_nodes(struct gltf *gltf);

/* The first three rows of matrices. */
void gltf_rest(struct gltf_pose *pose, const json_t *node); /* as the file has it */
void gltf_transform(double m[3][4], const struct gltf_pose *pose);

/* gltf_animation.c: the nodes' poses at options->at, if an animation is wanted and there is one. parents: of each node
   its number and 1, 0: none. */
trax_status gltf_find_poses(struct gltf *gltf, const uint32_t *parents);
void gltf_release_poses(struct gltf *gltf);

/* The differences of a node's mesh from the file's vertices. */
struct gltf_deform {
  double *weights; /* of morph targets */
  uint32_t weight_count, joint_count;
  double (*joints)[3][4]; /* from the mesh's coordinates to the scene's; NULL: the node's matrix is for all vertices */
};

trax_status gltf_find_deform(struct gltf_deform *deform, struct gltf *gltf, size_t node_number);
void gltf_release_deform(struct gltf_deform *deform);

/* gltf_meshes.c: the size of a mesh, added up over the nodes that have it. */
struct gltf_size {
  uint64_t vertices, triangles, primitives;
  bool known, normals;
};

trax_status gltf_measure_mesh(struct gltf_size *size, struct gltf *gltf, size_t number);
/* Appends a mesh, transformed by the first three rows of a matrix; the arrays have room for it. */
trax_status gltf_copy_mesh(struct gltf *gltf, size_t number, const double matrix[3][4],
                           const struct gltf_deform *deform);

#endif
