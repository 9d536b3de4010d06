/* Declarations shared by the files of the scene library. */
#ifndef TRAX_SCENE_INTERNAL_H
#define TRAX_SCENE_INTERNAL_H

#include "boxes.h"
#include "files.h"
#include "images.h"
#include "layouts/layouts.h"

/* Larger coordinates are treated as infinite: Embree takes none beyond 1.844e18. */
#define SCENE_MAX_COORDINATE 0x1.8p60f

/* what: the file or the step. */
trax_status scene_out_of_memory(trax_error *error, const char *what);

/* Polled by loops that take longer than 0.1 s on a large scene. */
static inline bool scene_is_interrupted(const volatile int *interrupt) {
  return interrupt && *interrupt;
}

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

/* Each triangle's first one with the same vertices, perhaps itself, and its next one or SCENE_NO_DUPLICATE. */
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
/* Orders the parts of a tree with splits: duplicates are in this order along the tree. */
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
