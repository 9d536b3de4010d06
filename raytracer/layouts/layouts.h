/* Nodes of each layout on the host, and wide trees. */
#ifndef TRAX_LAYOUTS_LAYOUTS_H
#define TRAX_LAYOUTS_LAYOUTS_H

#include "boxes.h"
#include "records.h"
#include "trax/scene.h"

#include <math.h>

/* --- layouts.c --- */

/* A row of the table. */
struct trax_node_format {
  const char *name;     /* of trax-scene --nodes */
  uint32_t bytes;       /* of a node */
  uint32_t children;    /* at most */
  bool general;         /* general programs of the TPs know it */
  bool quantised;       /* boxes are in cells of the scene's grid */
  uint32_t plane_bytes; /* of a pair: 4: binary32; 2: a number */
  const struct node_code *code;
};
extern const struct trax_node_format trax_node_formats[TRAX_NODE_LAYOUTS];

/* A node in a common form for all layouts. Boxes are exact, because binary64 represents the planes of grids; those of
   frames are rounded into the box. */
struct trax_node_children {
  uint32_t count;
  trax_scene_ref child[TRAX_NODE_MOST_CHILDREN];
  double min[TRAX_NODE_MOST_CHILDREN][3], max[TRAX_NODE_MOST_CHILDREN][3];
  double cell[3]; /* the distance of planes; 0: they are anywhere */
};
void trax_node_read(struct trax_node_children *children, const struct trax_scene *scene, uint32_t number);

/* A node as it is written and checked. */
struct scene_node {
  uint32_t count;
  struct scene_box box[TRAX_NODE_MOST_CHILDREN];
  trax_scene_ref child[TRAX_NODE_MOST_CHILDREN];
  uint8_t slot[TRAX_NODE_MOST_CHILDREN]; /* if children have slots, ascending: which these are */
};

/* A node of a wide tree, by its children in the binary one. */
struct scene_wide_node {
  uint32_t count, child[TRAX_NODE_MOST_CHILDREN]; /* indices of the tree */
  uint8_t slot[TRAX_NODE_MOST_CHILDREN];
};

/* The code of a layout. A checker writes each node again, around the boxes that it has found, and compares the bytes.
 */
struct node_code {
  /* The bytes of a node, and a node from its bytes. Boxes are as stored, but in frames exact ones are written. */
  void (*write)(void *bytes, const struct trax_node_format *format, const struct scene_node *node);
  void (*read)(struct scene_node *node, const struct trax_node_format *format, const void *bytes);
  /* Prepare a node for the device: coordinates times 2^exponent, and addresses for references. */
  void (*scale)(void *bytes, const struct trax_node_format *format, int exponent);
  void (*relocate)(void *bytes, const struct trax_node_format *format, uint32_t address);
  /* NULL, or of nodes with frames of their own: a box as this node stores it; the distance of planes along an axis. */
  struct scene_box (*box)(const void *bytes, const struct scene_box *box);
  double (*cell)(const void *bytes, int axis);
  /* NULL, or of nodes that decide on the places of their children: puts these into slots. Children that are nodes
     follow one another then, leaves come before the leaves of nodes, the root is a node even if it has one child, and
     the stack has one entry for a level. */
  void (*arrange)(struct scene_wide_node *node, const struct scene_box *boxes, const struct scene_box *whole);
  uint32_t most_triangles; /* in the leaves of such a node */
};

/* A leaf's box as the layout's nodes have it: exact, or in cells of the grid, rounded outwards. All boxes below are in
   the same unit. */
struct scene_box scene_box_as_stored(enum trax_node_layout layout, const struct trax_scene_grid *grid,
                                     const struct scene_box *box);
/* A box as this node stores it, in its frame if it has one. */
struct scene_box scene_box_in_node(const struct trax_scene *scene, uint32_t number, const struct scene_box *box);
/* The least box that contains all children. */
struct scene_box scene_box_around(const struct scene_node *node);
void scene_node_of(struct scene_node *node, const struct trax_scene *scene, uint32_t number);
/* The entries on the stack below a node that has `above` of them above it. *most becomes at least as many. */
uint32_t scene_stack_entries(enum trax_node_layout layout, uint32_t above, uint32_t children, uint32_t *most);

static inline void trax_scale_floats(float *values, size_t count, int exponent) {
  for (size_t i = 0; i < count; i++)
    values[i] = ldexpf(values[i], exponent);
}

/* A reference as an address. Those to leaves are negated (device/run.h). */
static inline trax_scene_ref trax_ref_at(trax_scene_ref reference, uint32_t address) {
  const trax_scene_ref there = reference + address;
  return TRAX_SCENE_REF_COUNT(reference) ? -there : there;
}

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
  } *nodes; /* depth first, the root first */
  uint32_t node_count, inner_count, max_leaf;
  uint32_t max_depth;      /* as in the file's header */
  uint32_t ref_count;      /* triangles in leaves; those that were split are in several */
  struct scene_box bounds; /* of all triangles */
  bool split;              /* triangles at one place are in the order of their numbers in every leaf */
  bool unique;             /* no two triangles are at one place; false: not known */
};

/* --- grid.c --- */

/* Whether boxes on the scene's grid cost few additional visits in each larger part of the tree. */
bool scene_grid_suits(const struct scene_tree *tree);
/* Converts a box to cells, rounded outwards. */
struct scene_box scene_box_in_cells(const struct trax_scene_grid *grid, const struct scene_box *box);

/* --- widen.c --- */

/* The wide nodes of a tree: which of its nodes and leaves are children of which. */
struct scene_wide {
  struct scene_wide_node *nodes;
  uint32_t *number;   /* of each node of the tree: its number among `nodes` */
  uint32_t *position; /* of each of `nodes`: its place in the file */
  uint32_t *by_position;
  uint32_t *leaves;        /* of the tree, in the order of the file; NULL: depth first */
  uint32_t count, entries; /* entries: as header.max_depth */
};

/* Makes them from a binary tree. False when out of memory. */
bool scene_widen(struct scene_wide *wide, const struct scene_tree *tree, enum trax_node_layout layout);
/* Chooses the places of wide nodes, unless the layout has chosen. They keep the order of the tree's inner nodes, whose
   places are `position` (struct scene_order). */
void scene_place_wide(struct scene_wide *wide, const struct scene_tree *tree, const uint32_t *position);
void scene_wide_release(struct scene_wide *wide);

#endif
