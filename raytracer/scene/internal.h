/* Declarations shared by the files of the scene library. */
#ifndef TRAX_SCENE_INTERNAL_H
#define TRAX_SCENE_INTERNAL_H

#include "trax/input.h"
#include "trax/scene.h"

/* Larger coordinates are treated as infinite: Embree takes none beyond 1.844e18. */
#define SCENE_MAX_COORDINATE 0x1.8p60f

/* what: the file or the step. */
trax_status scene_out_of_memory(trax_error *error, const char *what);

/* Polled by loops that take longer than 0.1 s on a large scene. */
static inline bool scene_is_interrupted(const volatile int *interrupt) {
  return interrupt && *interrupt;
}

/* --- files.c --- */

struct scene_bytes {
  unsigned char *data; /* released with free; aligned for any type */
  size_t size;
};

/* The most bytes of a file: as it is, and unpacked or from a pipe or a device. */
struct scene_limits {
  size_t plain, unpacked;
};

/* The limits of meshes, scenes and images. Nothing beyond 4 GiB makes a scene that 32-bit offsets can address. */
static inline struct scene_limits scene_limits_of(size_t unpack_limit) {
  return (struct scene_limits){(size_t)4 << 30, unpack_limit ? unpack_limit : TRAX_DEFAULT_UNPACK_LIMIT};
}

/* The limits of files that people write. */
#define SCENE_TEXT_LIMITS ((struct scene_limits){TRAX_TEXT_LIMIT, TRAX_TEXT_LIMIT})

/* Reads a whole file, unpacking it if it begins as an .xz or .gz file does. */
trax_status scene_load_file(struct scene_bytes *bytes, const char *path, struct scene_limits limits, trax_error *error);

/* --- unpack.c --- */

/* Replaces the bytes of a packed file by the unpacked ones; others stay. Nothing is left after an error. */
trax_status scene_unpack(struct scene_bytes *bytes, size_t limit, const char *path, trax_error *error);

/* --- files.c --- */

/* extension with its dot; upper and lower case are the same. */
bool scene_has_extension(const char *name, const char *extension);

/* The same as scene_load_file, with a NUL behind the last byte that size does not count. */
trax_status scene_load_text(struct scene_bytes *bytes, const char *path, struct scene_limits limits, trax_error *error);

/* Puts a NUL behind the last byte, which size does not count. When out of memory the bytes are released. */
trax_status scene_terminate(struct scene_bytes *bytes);

/* Makes room for a record behind count others: array is the address of a pointer that realloc may change. False when
   out of memory. */
bool scene_grow(void *array, size_t record_size, uint32_t count, size_t *capacity);

/* The path of a file that `referrer` calls `name`, to be freed; NULL when out of memory. Relative names are
   relative to the referrer's folder, with either slash. Absolute names usually come from another computer: their last
   part is looked up in the referrer's folder. */
char *scene_referred_path(const char *referrer, const char *name);

/* Reads such a file. Devices and pipes, which may never end, are refused. */
trax_status scene_load_referred(struct scene_bytes *bytes, const char *path, struct scene_limits limits);

/* The limit of memory of a mesh whose files have `bytes` bytes. Readers refuse files that ask for more. */
static inline uint64_t scene_memory_for(uint64_t bytes) {
  return ((uint64_t)1 << 30) + 1024 * bytes;
}

/* The bytes of all files that were read so far. */
uint64_t scene_bytes_read(void);

/* A copy of path without a final .xz or .gz, so that it ends as the unpacked file would; NULL when out of memory. */
char *scene_unpacked_name(const char *path);

/* --- image.c --- */

struct scene_image {
  uint32_t width, height;
  unsigned char *rgba; /* row by row from the top left; colours as sRGB, alpha linear */
};

/* PNG or JPEG of at most 2^26 pixels. */
trax_status scene_decode_image(struct scene_image *image, const struct scene_bytes *file, const char *name,
                               trax_error *error);
void scene_image_release(struct scene_image *image);

/* --- texture.c --- */

struct scene_texture {
  const char *base, *mask; /* names of images as the mesh file has them, or NULL; mask: where there are holes */
  uint32_t flags;          /* TRAX_TEXTURE_CLAMP */
  enum { SCENE_TEXTURE_COLOUR, SCENE_TEXTURE_DATA } use;
  bool mean_only; /* do not add it to the mesh */
  /* found */
  bool good;
  uint32_t number; /* in the mesh, from 1 */
  float mean[3];   /* linear, if it is a colour */
};

/* The textures of one mesh file. */
struct scene_textures {
  struct trax_mesh *mesh;
  const struct trax_import_options *options;
  struct trax_import_report *report;
  /* Sets the bytes of an image within the mesh file; false: it is a file of its own. NULL: there are none. */
  bool (*embedded)(void *context, const char *name, struct scene_bytes *file);
  void *context;
  struct scene_texture **known;
  uint32_t count;
  size_t capacity;
};

/* Finds a texture, or takes it from those found before. *found is valid until the release. It is not good if the image
   is missing or cannot be read, which the report notes. */
trax_status scene_find_texture(struct scene_textures *textures, const struct scene_texture *wanted,
                               const char *referrer, const struct scene_texture **found, trax_error *error);
/* Adds an image to the mesh as its last texture. */
trax_status scene_add_image(struct scene_textures *textures, const struct scene_image *image, uint32_t flags,
                            const char *name, trax_error *error);
void scene_textures_release(struct scene_textures *textures);

/* --- pages.c --- */

/* Memory for large arrays that are read at random: whole lines of the host's cache, and large pages if there are any.
   To be freed. */
void *scene_allocate(size_t size);

/* --- rank.c --- */

struct scene_ranking {
  uint64_t *keys; /* the bits of a binary64 number that is not negative */
  uint32_t *numbers;
};

/* Sorts records by their keys, greatest first; those with equal keys keep their order. Keys change. The arrays of
   `room` are as long; they may change places with those of the records. */
void scene_rank(struct scene_ranking *records, struct scene_ranking *room, uint32_t count);

/* --- attributes.c --- */

/* Extends *array, an array of the mesh, to `count` records. New records are zero. */
bool scene_reach(void *array, size_t record_size, uint32_t count, size_t *capacity);

/* Moves large texture coordinates near zero by whole repeats, and replaces those that are not finite by zeros. */
void scene_mend_uvs(struct trax_mesh *mesh, struct trax_import_report *report);

/* --- sequence.c --- */

/* Finds %d or %0Nd, N from 1 to 9. Returns its place, or NULL. */
const char *scene_find_number(const char *path, int *digits, size_t *length);
/* The file of a name with a number at the moment of the options; others as they are. To be freed. */
trax_status scene_name_at(char **name, const char *path, const struct trax_import_options *options,
                          struct trax_import_report *report, trax_error *error);

/* --- mesh.c --- */

/* Adds the report of a file to that of those before it. */
void scene_add_report(struct trax_import_report *total, const struct trax_import_report *part);
/* Reads and merges the files: what trax_mesh_import does before it places instances and overrides materials. */
trax_status scene_import_meshes(struct trax_mesh *mesh, const char *const *paths, size_t path_count,
                                const struct trax_import_options *options, struct trax_import_report *report,
                                trax_error *error);

/* --- gltf_reader.c, obj_reader.c, ply_reader.c --- */

/* Import one file. source_id and material of the triangles count within the file; report is added to. */
typedef trax_status scene_reader(struct trax_mesh *mesh, const char *path, const struct trax_import_options *options,
                                 struct trax_import_report *report, trax_error *error);
scene_reader scene_read_gltf, scene_read_obj, scene_read_ply;

/* Into 0 to 1; NaN and -0 become 0. */
static inline float scene_clamp_colour(float value) {
  return value > 0 ? (value < 1 ? value : 1) : 0;
}

/* --- material.c --- */

trax_status scene_override_materials(struct trax_mesh *mesh, const struct trax_import_options *options,
                                     trax_error *error);

/* --- forest.c --- */

/* A mesh of 174,117 triangles; other seeds give other forests. */
trax_status scene_generate_forest(struct trax_mesh *mesh, uint64_t seed, trax_error *error);
/* One of its firs, at the origin; y is up. */
trax_status scene_generate_fir(struct trax_mesh *mesh, uint64_t seed, trax_error *error);

/* --- normals.c --- */

/* crease_cosine: the cosine of the largest angle between neighbouring faces of one smooth surface. */
trax_status scene_smooth_normals(struct trax_triangle_normals *normals, const struct trax_triangle *triangles,
                                 uint32_t count, double crease_cosine, trax_error *error);

/* Scales the files' normals to length 1, and reverses a triangle's if all point away from it. Normals that are not
   finite, nearly in the triangle's plane or behind it become zero, and are computed later. */
void scene_mend_normals(struct trax_mesh *mesh, struct trax_import_report *report);

/* Computes those that are zero. */
trax_status scene_complete_normals(struct trax_triangle_normals *normals, const struct trax_triangle *triangles,
                                   uint32_t count, double crease_cosine, trax_error *error);

/* --- camera.c --- */

float scene_dot(const float a[3], const float b[3]);
/* False if the length is zero, or not finite. */
bool scene_normalise(float v[3]);
/* Makes up perpendicular to the direction; false if they are parallel, both being of unit length. */
bool scene_make_perpendicular(float up[3], const float direction[3]);

/* --- polygon.c --- */

/* Memory that is used again from one polygon to the next; zeroed at first. */
struct scene_polygon_work {
  void *points;
  uint32_t *ring;
  uint32_t (*triangles)[3];
  uint32_t capacity;
  uint64_t steps; /* that all polygons of the file have taken */
  const volatile int *interrupt;
};

/* The most steps for all polygons of a file: seconds. */
#define SCENE_POLYGON_STEPS ((uint64_t)1 << 29)

/* Cuts a simple polygon, convex or not, into count - 2 triangles over its own corners, from 0; *triangles is valid
   until the next call. Returns NULL, or why it was not cut. */
const char *scene_cut_polygon(struct scene_polygon_work *work, float (*positions)[3], const uint32_t *corners,
                              uint32_t count, const uint32_t (**triangles)[3]);
void scene_polygon_work_release(struct scene_polygon_work *work);

/* --- boxes, in host arithmetic --- */

struct scene_box {
  float min[3], max[3];
};

static inline struct scene_box scene_empty_box(void) {
  return (struct scene_box){{__builtin_inff(), __builtin_inff(), __builtin_inff()},
                            {-__builtin_inff(), -__builtin_inff(), -__builtin_inff()}};
}

static inline void scene_box_add_point(struct scene_box *box, const float point[3]) {
  for (int axis = 0; axis < 3; axis++) {
    box->min[axis] = point[axis] < box->min[axis] ? point[axis] : box->min[axis];
    box->max[axis] = point[axis] > box->max[axis] ? point[axis] : box->max[axis];
  }
}

/* Half of the surface: proportional to the chance that a random line hits the box. */
static inline double scene_half_area(const float min[3], const float max[3]) {
  double x = (double)max[0] - min[0], y = (double)max[1] - min[1], z = (double)max[2] - min[2];
  return x * y + y * z + z * x;
}

static inline void scene_box_add_box(struct scene_box *box, const struct scene_box *other) {
  scene_box_add_point(box, other->min);
  scene_box_add_point(box, other->max);
}

/* What both boxes have in common. */
static inline struct scene_box scene_box_within(const struct scene_box *a, const struct scene_box *b) {
  struct scene_box box;
  for (int axis = 0; axis < 3; axis++) {
    box.min[axis] = a->min[axis] > b->min[axis] ? a->min[axis] : b->min[axis];
    box.max[axis] = a->max[axis] < b->max[axis] ? a->max[axis] : b->max[axis];
  }
  return box;
}

static inline struct scene_box scene_triangle_box(const struct trax_mesh *mesh, uint32_t triangle) {
  struct scene_box box = scene_empty_box();
  for (int corner = 0; corner < 3; corner++)
    scene_box_add_point(&box, mesh->vertices[mesh->triangles[triangle].vertices[corner]]);
  return box;
}

/* --- nodes.c --- */

struct scene_tree;

/* A leaf's box as the layout's nodes have it: exact, or in cells of the grid, rounded outwards. All boxes below are in
   the same unit. */
struct scene_box scene_box_as_stored(enum trax_node_layout layout, const struct trax_scene_grid *grid,
                                     const struct scene_box *box);

/* A box as this node stores it, in its frame if it has one. */
struct scene_box scene_box_in_node(const struct trax_scene *scene, uint32_t number, const struct scene_box *box);

/* A node in a form for all layouts. */
struct scene_node {
  uint32_t count;
  struct scene_box box[TRAX_NODE_MOST_CHILDREN];
  trax_scene_ref child[TRAX_NODE_MOST_CHILDREN];
  uint8_t slot[TRAX_NODE_MOST_CHILDREN]; /* of eight children, ascending: which of the eight they are */
};

/* The least box that contains all children. */
struct scene_box scene_box_around(const struct scene_node *node);
/* The bytes of a node, and a node from its bytes. Boxes are as stored, but of eight children exact ones are written. */
void scene_node_write(void *bytes, enum trax_node_layout layout, const struct scene_node *node);
void scene_node_read(struct scene_node *node, enum trax_node_layout layout, const void *bytes);
void scene_node_of(struct scene_node *node, const struct trax_scene *scene, uint32_t number);
/* The stack's entries below a node with `above` above it. *most: so far at once. */
uint32_t scene_stack_entries(enum trax_node_layout layout, uint32_t above, uint32_t children, uint32_t *most);
/* Whether boxes on the scene's grid cost few additional visits in each larger part of the tree. */
bool scene_grid_suits(const struct scene_tree *tree);

/* --- nodes_wide8.c --- */

void scene_wide8_write(struct trax_wide8_node *out, const struct scene_node *node);
void scene_wide8_read(struct scene_node *node, const struct trax_wide8_node *in);
struct scene_box scene_wide8_box(const struct trax_wide8_node *node, const struct scene_box *box);
/* The distance of planes along an axis. */
double scene_wide8_cell(const struct trax_wide8_node *node, int axis);

/* --- wide.c --- */

/* The wide nodes of a tree: which of its nodes and leaves are children of which. */
struct scene_wide {
  struct scene_wide_node {
    uint32_t count, child[TRAX_NODE_MOST_CHILDREN]; /* indices of the tree */
    uint8_t slot[TRAX_NODE_MOST_CHILDREN];
  } * nodes;
  uint32_t *number;   /* of each node of the tree: its number among `nodes` */
  uint32_t *position; /* of each of `nodes`: its place in the file */
  uint32_t *by_position;
  uint32_t *leaves;        /* of the tree, in the order of the file; NULL: depth first */
  uint32_t count, entries; /* entries: as header.max_depth */
};

/* Makes them from a binary tree. */
trax_status scene_widen(struct scene_wide *wide, const struct scene_tree *tree, enum trax_node_layout layout,
                        trax_error *error);
/* Decides on their places, unless the layout has. position: of the tree's inner nodes (struct scene_order), whose order
   the wide nodes keep. */
void scene_place_wide(struct scene_wide *wide, const struct scene_tree *tree, const uint32_t *position);
void scene_wide_release(struct scene_wide *wide);

/* --- clip.c --- */

/* The next float below or above a finite one. */
static inline float scene_next_float(float x, bool up) {
  union {
    float value;
    uint32_t bits;
  } both = {x};
  both.bits = x == 0 ? (up ? 1 : 0x80000001) : both.bits + ((x > 0) == up ? 1 : UINT32_MAX);
  return both.value;
}

/* The part of a convex polygon where sign * coordinate >= sign * plane. Returns the number of its corners; those beyond
   `most` are left out. */
unsigned scene_clip_polygon(double (*restrict out)[3], unsigned most, const double (*restrict in)[3], unsigned count,
                            int axis, double sign, double plane);
/* The bounds of that part of a triangle which is in the box, rounded outwards but not beyond the box. */
struct scene_box scene_clip_triangle(const float *const corners[3], const struct scene_box *box);
/* The same of the two parts of the box below and above a position on an axis. */
void scene_split_triangle(const float *const corners[3], const struct scene_box *box, int axis, float position,
                          struct scene_box parts[2]);

/* --- parts.c --- */

struct scene_range {
  uint32_t first, end;
};

struct scene_parts {
  const struct trax_scene *scene;
  const struct scene_range *ranges; /* of each node: the triangles below it */
  const uint32_t *in_part;          /* of each triangle: not 0 if it is not within the box of its leaf */
};

/* Checks that each triangle in several leaves is covered by the boxes of these together. *bad receives the number of
   the first that is not, or UINT32_MAX. Triangles in more than 1024 leaves are refused. */
trax_status scene_check_parts(const struct scene_parts *parts, uint32_t *bad, trax_error *error);

/* --- check_tree.c --- */

/* Checks the tree of a file whose sections and triangles have been checked. name: of the file, for messages. */
trax_status scene_check_tree(const struct trax_scene *view, const char *name, trax_error *error);

/* --- bvh.c --- */

/* A tree as the builder makes it; links are indices into nodes. */
struct scene_tree {
  struct scene_tree_node {
    uint32_t triangle_count; /* 0: an inner node */
    union {
      uint32_t child[2];
      struct {
        uint32_t triangles[TRAX_SCENE_MAX_LEAF]; /* of the mesh */
        struct scene_box box;                    /* of the triangles' parts that are in this leaf */
      };
    };
  } * nodes; /* depth first, the root first */
  uint32_t node_count, inner_count, max_leaf;
  uint32_t max_depth;      /* as in the file's header */
  uint32_t ref_count;      /* triangles in leaves; those that were split are in several */
  struct scene_box bounds; /* of all triangles */
  bool split;              /* triangles at one place are in the order of their numbers in every leaf */
  bool unique;             /* no two triangles are at one place; false: not known */
};

trax_status scene_build_tree(struct scene_tree *tree, const struct trax_mesh *mesh,
                             const struct trax_build_options *options, trax_error *error);
void scene_tree_release(struct scene_tree *tree);

/* --- refit.c --- */

/* The tree of options->refit around the mesh's triangles, which have the same numbers in their files. *positions: as of
   struct scene_order, to be freed. */
trax_status scene_refit_tree(struct scene_tree *tree, uint32_t **positions, const struct trax_mesh *mesh,
                             const struct trax_build_options *options, trax_error *error);

/* --- splits.c --- */

struct scene_duplicates;

/* False if they do not, which is decided without duplicates. */
bool scene_splits_may_suit(const struct trax_mesh *mesh);
/* Decides whether they pay if they may. Only the first triangle at each place counts, as in the tree. */
trax_status scene_splits_suit(bool *suit, const struct trax_mesh *mesh, const struct scene_duplicates *duplicates,
                              trax_error *error);
/* Refuses splits of a mesh that emits light, because a split triangle is in the file several times, and would be
   several lamps. */
trax_status scene_check_emitters(const struct trax_mesh *mesh, trax_error *error);

/* --- own_tree.c --- */

/* Reads and checks the tree of options->tree_nodes. *tree is to be released also after an error. */
trax_status scene_read_tree(struct scene_tree *tree, const struct trax_mesh *mesh,
                            const struct trax_build_options *options, trax_error *error);

/* --- reinsert.c --- */

#define SCENE_NO_LINK UINT32_MAX

/* A binary tree by its links. */
struct scene_links {
  struct scene_link {
    struct scene_box box;
    uint32_t triangles; /* of the subtree, as built */
    uint32_t parent;    /* SCENE_NO_LINK: it is the root */
    uint32_t child[2];  /* SCENE_NO_LINK: it is a leaf */
    uint32_t height;    /* most inner nodes from here to a leaf; of a leaf that will be divided more than 0 */
    double visits;      /* of scene_reinsert: how often a ray is expected here */
  } __attribute__((aligned(64))) * nodes; /* each in a line of the host's cache */
  uint32_t count, root;
  uint32_t max_depth; /* of inner nodes from the root to a leaf; it is kept */
};

struct scene_crew;

/* Moves parts of the tree so that rays visit fewer nodes; leaves stay as they are. The same tree for any number of
   threads. options: for progress and interrupt. */
trax_status scene_reinsert(struct scene_links *links, unsigned passes, struct scene_crew *crew,
                           const struct trax_build_options *options, trax_error *error);

/* --- phases.c --- */

enum scene_phase { SCENE_BUILD, SCENE_IMPROVE, SCENE_LAY_OUT };

/* fraction: of this phase. options->splits: as decided. */
void scene_report(const struct trax_build_options *options, enum scene_phase phase, double fraction);

/* --- duplicates.c --- */

#define SCENE_NO_DUPLICATE UINT32_MAX

/* For each triangle: the first one with the same vertices, perhaps itself, and the next one or SCENE_NO_DUPLICATE. */
struct scene_duplicates {
  uint32_t *first, *after;
  bool any;
};

trax_status scene_find_duplicates(struct scene_duplicates *duplicates, const struct trax_mesh *mesh, trax_error *error);
void scene_duplicates_release(struct scene_duplicates *duplicates);

/* Puts triangles with the same vertices in the order of their numbers, along the tree depth first, or along `leaves`,
   which may be NULL. */
trax_status scene_order_duplicates(struct scene_tree *tree, const uint32_t *leaves, const struct trax_mesh *mesh,
                                   trax_error *error);
/* The same of a tree with splits, in which they are in this order along the tree. */
trax_status scene_order_split_duplicates(struct scene_tree *tree, const uint32_t *leaves, const struct trax_mesh *mesh,
                                         trax_error *error);

/* --- order.c --- */

/* The positions of a tree's inner nodes in the file. Nodes of one group share a line; the root of a group is its first
   node, and stands first in it. */
struct scene_order {
  uint32_t *position; /* of each inner node of the tree, among those of the file; the root's is 0 */
  uint32_t *group;    /* of each inner node: the root of its group */
  uint32_t *next;     /* of each inner node: the next one of its group; 0: none */
};

/* cache_lines: of the direct-mapped cache it is made for; below 8 the order is depth first. */
trax_status scene_order_nodes(struct scene_order *order, const struct scene_tree *tree, enum trax_node_layout layout,
                              uint32_t cache_lines, const volatile int *interrupt, trax_error *error);
void scene_order_release(struct scene_order *order);

#endif
