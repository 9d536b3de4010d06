/* The tree as the builder makes it, and its numbering. */
#ifndef TRAX_SCENE_BUILT_TREE_H
#define TRAX_SCENE_BUILT_TREE_H

#include "crew.h"
#include "internal.h"

/* The crew owns it. */
struct built_node {
  uint32_t triangle_count; /* 0: an inner node */
  uint32_t below;          /* triangles of the subtree */
  uint32_t height;         /* most inner nodes from here to a leaf */
  uint32_t nodes;          /* of the subtree, with this one */
  struct built_node *child[2];
  struct scene_box box; /* of a leaf */
  uint32_t triangles[];
};

/* --- sah.c --- */

struct sah_prim;

struct sah_arguments {
  const struct trax_build_options *options; /* for progress and interrupt */
  const struct trax_mesh *mesh;
  struct sah_prim *prims; /* with their boxes and triangles */
  uint32_t count;         /* of these, at least 1 */
  size_t capacity;        /* for parts of triangles that are split */
  unsigned max_depth, max_leaf;
  float traversal_cost;
};

/* Builds the same tree for any number of threads. NULL when interrupted or out of memory. */
struct built_node *scene_build_sah(const struct sah_arguments *arguments, struct scene_crew *crew);

/* --- numbering.c --- */

struct scene_numbering {
  struct scene_tree *tree; /* receives the nodes */
  const struct trax_mesh *mesh;
  const struct scene_duplicates *duplicates; /* NULL: all triangles are in the tree already */
  unsigned max_depth, max_leaf;
  uint32_t *triangles; /* of a subtree to be rebuilt, or of a leaf: room for all */
};

/* The least height of a tree over `triangles` triangles. */
unsigned scene_least_height(uint32_t triangles, unsigned max_leaf);
/* Computes `below`, `height` and `nodes` of all nodes. False if the builder left triangles out. */
bool scene_measure_built(const struct scene_numbering *numbering, struct built_node *node);
/* Adds the nodes to the tree, depth first, and rebuilds each subtree that is too deep. False when out of memory. */
bool scene_number_built(struct scene_numbering *numbering, const struct built_node *root);
/* Adds the nodes of a tree by its links, which is not too deep. built: the node of each link. */
bool scene_number_links(struct scene_numbering *numbering, const struct scene_links *links,
                        struct built_node *const *built);

#endif
