/* Shared by the files that read a tree of another builder. */
#ifndef TRAX_SCENE_OWN_TREE_H
#define TRAX_SCENE_OWN_TREE_H

#include "npy.h"

#define SCENE_NOT_SEEN UINT32_MAX

struct scene_tree_reading {
  struct scene_tree *tree;
  const struct trax_mesh *mesh;
  struct scene_npy nodes, triangles, boxes;
  bool has_boxes;
  unsigned children; /* most of a node, which are the first columns; the last one is the count */
  unsigned max_depth;
  uint32_t *parents; /* of each row: the first one that has it as a child; SCENE_NOT_SEEN */
  uint32_t *copies;  /* of each triangle of the mesh: how many leaves have it */
  uint32_t *latest;  /* of each triangle: the last row that has it; SCENE_NOT_SEEN */
  uint32_t *rows;    /* of each node of the tree: where it is from */
};

/* A row's box: finite, and its least corner not above the greatest. */
trax_status scene_read_row_box(struct scene_box *box, const struct scene_tree_reading *reading, uint64_t row,
                               trax_error *error);
bool scene_box_contains(const struct scene_box *outer, const struct scene_box *inner);
/* The boxes of the leaves and of the tree, after all leaves were read. */
trax_status scene_find_leaf_boxes(struct scene_tree_reading *reading, trax_error *error);

#endif
