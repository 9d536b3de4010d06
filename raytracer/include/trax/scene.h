/* Scenes on the host: meshes are imported, a BVH is built, and the result is a scene file (scene_format.h) in memory,
   which is written, read back and checked.

     struct trax_mesh mesh = {0};
     trax_mesh_import(&mesh, paths, count, &import_options, &report, &error);
     struct trax_scene scene = {0};
     trax_scene_build(&scene, &mesh, &build_options, &error);
     trax_scene_write(&scene, "bunny.trax", &error);

   Functions return TRAX_OK, TRAX_ERROR with the reason in *error, or TRAX_INTERRUPTED. Release the objects that they
   filled with trax_mesh_release or trax_scene_release, which also accept a zeroed or already released object. */
#ifndef TRAX_SCENE_H
#define TRAX_SCENE_H

#include "trax/files.h"
#include "trax/scene_format.h"
#include "trax/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* --- meshes --- */

struct trax_mesh_triangle {
  uint32_t vertices[3];
  uint32_t material;
  uint32_t source_id; /* its number among all imported triangles, including those that were dropped */
};

#define TRAX_MESH_NAME 64

struct trax_mesh_material {
  char name[TRAX_MESH_NAME];    /* "" if it has none; of trax_mesh_name */
  struct trax_material surface; /* its texture is one of the mesh's */
};

/* The mesh's texels from first_texel on, as in the scene file. */
struct trax_mesh_texture {
  uint32_t first_texel, log2_width, log2_height, flags;
};

/* A camera of a mesh file. */
struct trax_mesh_camera {
  char name[TRAX_MESH_NAME];         /* of trax_mesh_name */
  float eye[3], direction[3], up[3]; /* of unit length, perpendicular */
  float fov;                         /* vertical, degrees */
};

/* Triangles that are placed together. */
struct trax_mesh_part {
  uint32_t first_triangle, triangle_count;
  uint32_t source_count; /* with those that were dropped: their source_id is below it */
};

/* The point p of the part is at transform (p, 1). */
struct trax_mesh_instance {
  double transform[3][4];
  uint32_t part;
  uint32_t material; /* of all triangles; TRAX_NO_MATERIAL: their own */
};

struct trax_mesh {
  float (*vertices)[3];
  struct trax_mesh_triangle *triangles;
  struct trax_mesh_material *materials; /* at least one after an import */
  struct trax_mesh_texture *textures;
  uint32_t *texels;
  struct trax_mesh_camera *cameras;
  /* Attributes of the triangles' corners, from the files. NULL: no file has any; zeros: the corner has none. */
  float (*normals)[3][3];
  float (*uvs)[3][2];
  uint32_t vertex_count, triangle_count, material_count, texture_count, texel_count, camera_count;
  /* Without instances every triangle is where its vertices are. Otherwise parts follow one another, and have all of the
     triangles. */
  struct trax_mesh_part *parts;
  struct trax_mesh_instance *instances;
  uint32_t part_count, instance_count;
};

/* A name of at most TRAX_MESH_NAME - 1 characters. A longer one becomes its beginning, "~", and 16 digits that depend
   on all of it, so that different names stay different. */
void trax_mesh_name(char name[TRAX_MESH_NAME], const char *text);

/* Reports the progress of a long step. fraction is 0 to 1, or negative if unknown. May be called from any thread. */
typedef void trax_scene_progress(void *context, const char *step, double fraction);

enum trax_override_kind {
  TRAX_OVERRIDE_DIFFUSE, /* colour */
  TRAX_OVERRIDE_LAMBERT,
  TRAX_OVERRIDE_MIRROR,   /* colour: what it reflects */
  TRAX_OVERRIDE_GLASS,    /* value: index of refraction */
  TRAX_OVERRIDE_GGX,      /* value: roughness; colour: what it reflects at normal incidence */
  TRAX_OVERRIDE_EMISSION, /* colour: radiance */
};

struct trax_material_override {
  const char *name; /* of the material; NULL: all of them */
  float colour[3];  /* linear RGB, 0 to 1, but for emission */
  enum trax_override_kind kind;
  float value;
};

/* Parse the value of --diffuse, [NAME=]R,G,B, or --material, [NAME=]KIND (trax-scene --help). The function cuts text at
   the end of the name, and override refers to text. */
trax_status trax_override_diffuse(struct trax_material_override *override, char *text, trax_error *error);
trax_status trax_override_material(struct trax_material_override *override, char *text, trax_error *error);

/* The default limit of bytes of a packed file, or one without a size (a pipe): docs/scene-file.md, "Limits". */
#define TRAX_DEFAULT_UNPACK_LIMIT ((size_t)1 << 30)

/* Parses "700M", "2G", "65536": bytes; K, M and G are powers of 1024; 1 to 4 GiB. False: text is no size. */
bool trax_parse_size(const char *text, size_t *bytes);

struct trax_import_options {
  bool drop_nonfinite;     /* drop triangles with a NaN or infinite vertex instead of refusing the mesh */
  bool no_textures;        /* images are not read; materials keep only their colours */
  bool instances;          /* a mesh of several glTF nodes is kept once, and placed */
  bool flatten;            /* every instance gets triangles of its own */
  unsigned texture_size;   /* limit of texels a side; a power of two up to 4096; 0: 4096 */
  size_t unpack_limit;     /* bytes; 0: TRAX_DEFAULT_UNPACK_LIMIT */
  bool moves;              /* meshes are those of a moment: `at` */
  double at;               /* seconds of glTF's animations; the number of a frame for names with %d */
  const char *animation;   /* its name in the glTF file; NULL: the first one */
  const trax_files *files; /* of the command; meshes must not refer to its outputs; may be NULL */
  const struct trax_material_override *overrides; /* applied in order */
  size_t override_count;
  trax_scene_progress *progress; /* may be NULL */
  void *progress_context;
  const volatile int *interrupt; /* polled; may be NULL (a signal handler's sig_atomic_t fits) */
};

struct trax_import_report {
  uint64_t source_triangles;    /* after polygons were cut into triangles */
  uint64_t degenerate;          /* dropped: zero area */
  uint64_t nonfinite;           /* dropped: a vertex is NaN or infinite */
  uint64_t other_primitives;    /* skipped: points and lines */
  uint64_t turned_normals;      /* triangles with normals that all pointed away from them */
  uint64_t mended_normals;      /* triangles with a computed normal: theirs was zero, not finite, or pointed away */
  uint64_t mended_uvs;          /* triangles with texture coordinates that were not finite, or too large */
  uint32_t missing_files;       /* files, such as material libraries, that meshes refer to and that cannot be read */
  char first_missing_file[256]; /* its name */
  uint32_t bad_images;          /* textures that exist but are no readable PNG or JPEG */
  char first_bad_image[256];    /* its name and the reason */
  bool moved;                   /* a mesh depends on `at` */
  unsigned unread;              /* TRAX_UNREAD_: features of the meshes that the ray tracer does not have */
};

enum { TRAX_UNREAD_COLOURS = 1, TRAX_UNREAD_NORMAL_MAPS = 2, TRAX_UNREAD_UV_TRANSFORMS = 4 };

/* Prints notes on parts that were left out, mended or missing (trax/message.h), if there are any. */
void trax_import_print_notes(const struct trax_import_report *report, const char *program);

/* The material of triangles without one: light grey, Lambert's. */
extern const struct trax_material trax_default_material;

/* Whether the path names a generated mesh, "generate:forest", and no file. */
bool trax_mesh_is_generated(const char *path);
/* Checks that the path is of a file that can be read, or a valid "generate:forest". */
trax_status trax_mesh_check(const char *path, trax_error *error);

/* Reads and merges the files: PLY, OBJ with MTL, glTF, GLB, plain or compressed as .xz or .gz; or "generate:forest",
   see docs/scene-file.md. Node transforms are applied and polygons cut into triangles, in the order of the files.
   report may be NULL. Errors: a file that cannot be read or is no mesh, indices out of range, vertices that are not
   finite (unless dropped), overrides that match no material. A mesh without triangles is no error here. */
trax_status trax_mesh_import(struct trax_mesh *mesh, const char *const *paths, size_t path_count,
                             const struct trax_import_options *options, struct trax_import_report *report,
                             trax_error *error);
void trax_mesh_release(struct trax_mesh *mesh);

/* Lists each file that an import or a build reads from now on, in the file of this descriptor. A line is as that of
   `xxhsum -H2`, or begins with "-" if the file cannot be read. 0 ends the list. */
void trax_scene_list_files(int descriptor);

/* --- scenes --- */

/* The grid of quantised nodes: plane number q of an axis is at origin + q * cell. */
struct trax_scene_grid {
  float origin[3], cell[3];
};

struct trax_scene {
  void *bytes; /* the file, 64-byte aligned */
  size_t size; /* bytes */
  /* Views into it; pointers of empty sections are NULL. */
  const struct trax_scene_header *header;
  const void *nodes; /* in the layout header->node_layout */
  const struct trax_triangle *triangles;
  const struct trax_triangle_normals *normals;
  const struct trax_triangle_uvs *uvs;
  const struct trax_material *materials;
  const struct trax_texture *textures;
  const uint32_t *texels;
  const uint32_t *source_ids;
  uint32_t node_count, triangle_count, material_count, texture_count, texel_count;
  struct trax_scene_grid grid;
  const struct trax_instance *instances; /* NULL: triangles are where their vertices are */
  const struct trax_scene_mesh *meshes;
  uint32_t instance_count, mesh_count;
};

struct trax_scene_grid trax_scene_grid_of(const float bounds_min[3], const float bounds_max[3]);

struct trax_build_options {
  uint32_t nodes;       /* layouts/records.h */
  bool choose_nodes;    /* quantised nodes instead, if the scene's grid is fine enough for nearly all boxes */
  unsigned max_leaf;    /* triangles in a leaf, 1 to TRAX_SCENE_MAX_LEAF; 0: default */
  unsigned max_depth;   /* inner nodes on a path, at most TRAX_SCENE_MAX_DEPTH; 0: default */
  unsigned cache_lines; /* of the direct-mapped data cache that nodes are ordered for; 0: default; 1: depth first */
  float splits;         /* large triangles are split until leaves have `splits` times as many; 0 or 1: none */
  bool choose_splits;   /* the default instead, if many triangles' boxes are much larger than they; never of lamps */
  unsigned passes;      /* over the tree that was built, to improve it: at most TRAX_SCENE_MAX_PASSES */
  float traversal_cost; /* of a node, relative to a triangle's; 0: default */
  /* Another builder's tree instead, from arrays (docs/own-tree.md): .npy files. NULL: none; without tree_boxes each
     triangle is in one leaf. */
  const char *tree_nodes, *tree_triangles, *tree_boxes;
  /* An earlier scene of the same mesh, whose vertices have moved since: its tree, its layout and the order of its
     nodes, with new boxes. NULL: none. Its name, for messages. */
  const struct trax_scene *refit;
  const char *refit_name;
  bool allow_empty;              /* a mesh without triangles gives a scene without triangles instead of an error */
  bool without_source_ids;       /* leave that section out */
  bool smooth;                   /* with normals for smooth shading, across edges of up to crease_degrees */
  bool compute_normals;          /* even if the mesh has normals */
  float crease_degrees;          /* up to 180; 0: default */
  unsigned threads;              /* of the host; the bytes do not depend on their number; 0: one for each processor */
  trax_scene_progress *progress; /* may be NULL */
  void *progress_context;
  const volatile int *interrupt; /* polled; may be NULL */
};

/* Sets the layout by its name, or auto. False if there is no such layout. */
bool trax_node_layout_choose(const char *name, struct trax_build_options *build);

/* Sets the splits: a number, auto, or NULL for the default. False if it is none of these, or out of range. */
bool trax_splits_choose(const char *text, struct trax_build_options *build);

#define TRAX_DEFAULT_SPLITS 1.5f
#define TRAX_SCENE_MAX_SPLITS 8.0f
#define TRAX_DEFAULT_PASSES 2u /* of trax-scene and trax-render (docs/results/raytracer.md has what they gain) */
#define TRAX_SCENE_MAX_PASSES 16u
#define TRAX_DEFAULT_CREASE 60 /* degrees */

/* Builds the BVH (surface-area heuristic) and lays the file out. The same mesh and options give the same bytes on every
   x86-64 host. */
trax_status trax_scene_build(struct trax_scene *scene, const struct trax_mesh *mesh,
                             const struct trax_build_options *options, trax_error *error);

/* Writes the triangles of a mesh as a user's tree numbers them: an array of floats (.npy) of the shape (n, 3, 3). */
trax_status trax_mesh_write_triangles(const struct trax_mesh *mesh, const char *path, trax_error *error);

/* path is replaced at once or stays as it was (trax/output.h). */
trax_status trax_scene_write(const struct trax_scene *scene, const char *path, trax_error *error);

/* Reads a file and checks it completely: header, checksum, sections, and the BVH as a tree in which every box is exact
   and every triangle within its leaf's, or those of several leaves together. An accepted scene cannot lead a traversal
   astray. unpack_limit: as of an import. */
trax_status trax_scene_read(struct trax_scene *scene, const char *path, size_t unpack_limit, trax_error *error);

/* Checks bytes in memory, which the caller keeps, likewise; messages contain name. On success *scene, if not NULL,
   views the bytes, and need not be released. bytes must be 64-byte aligned. */
trax_status trax_scene_check(struct trax_scene *scene, const void *bytes, size_t size, const char *name,
                             trax_error *error);
void trax_scene_release(struct trax_scene *scene);

struct trax_scene_stats {
  uint32_t leaves;
  uint32_t leaf_sizes[TRAX_SCENE_MAX_LEAF + 1]; /* the number of leaves with i triangles */
  double mean_leaf_depth;                       /* inner nodes above a leaf */
  /* Expected work of a long random ray that hits the scene's box and nothing else, from surface areas. */
  double sah_nodes;     /* nodes visited */
  double sah_triangles; /* triangles tested */
};

void trax_scene_measure(struct trax_scene_stats *stats, const struct trax_scene *scene);

#endif
