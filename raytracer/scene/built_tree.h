/* The tree as Embree's callbacks make it, and its numbering. */
#ifndef TRAX_SCENE_BUILT_TREE_H
#define TRAX_SCENE_BUILT_TREE_H

#include "internal.h"

/* Embree's allocator owns it. */
struct built_node {
  uint32_t triangle_count; /* 0: an inner node */
  uint32_t below;          /* triangles of the subtree */
  uint32_t height;         /* most inner nodes from here to a leaf */
  struct built_node *child[2];
  struct scene_box box; /* of a leaf */
  uint32_t triangles[];
};

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
/* Computes `below` and `height` of all nodes. False if the builder left triangles out. */
bool scene_measure_built(const struct scene_numbering *numbering, struct built_node *node);
/* Adds the nodes to the tree, depth first, and rebuilds each subtree that is too deep. False when out of memory. */
bool scene_number_built(struct scene_numbering *numbering, const struct built_node *root);

#endif
