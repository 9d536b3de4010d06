/* Nodes of each layout (scene_format.h), and wide trees. */
#ifndef TRAX_SCENE_NODE_LAYOUTS_H
#define TRAX_SCENE_NODE_LAYOUTS_H

#include "boxes.h"

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

#endif
