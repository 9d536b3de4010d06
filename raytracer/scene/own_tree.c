/* A tree of another builder, from arrays (docs/own-tree.md). Everything is checked here, except that the leaves of a
   triangle cover it, which needs the finished file. */
#include "npy.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST, MOST_CHILDREN = 8, PLANES = 6 };
#define NOT_SEEN UINT32_MAX

struct reading {
  struct scene_tree *tree;
  const struct trax_mesh *mesh;
  struct scene_npy nodes, triangles, boxes;
  bool has_boxes;
  unsigned children; /* most of a node, which are the first columns; the last one is the count */
  unsigned max_depth;
  uint32_t *parents; /* [nodes]: the first node that has it as a child; NOT_SEEN */
  uint32_t *copies;  /* [triangles of the mesh]: how many leaves have it */
};

static trax_status open_arrays(struct reading *reading, const struct trax_build_options *options, trax_error *error) {
  struct scene_npy *nodes = &reading->nodes, *triangles = &reading->triangles, *boxes = &reading->boxes;
  if (scene_npy_read(nodes, options->tree_nodes, SCENE_NPY_INTEGERS, error) != TRAX_OK ||
      scene_npy_read(triangles, options->tree_triangles, SCENE_NPY_INTEGERS, error) != TRAX_OK ||
      (options->tree_boxes && scene_npy_read(boxes, options->tree_boxes, SCENE_NPY_FLOATS, error) != TRAX_OK))
    return TRAX_ERROR;
  reading->has_boxes = options->tree_boxes != NULL;
  if (nodes->dimensions != 2 || nodes->shape[1] < 3 || nodes->shape[1] > MOST_CHILDREN + 1 || nodes->shape[0] == 0 ||
      nodes->shape[0] > INT32_MAX)
    return trax_fail(error, "%s: the nodes' shape is (N, 3): left, right, count; or, for k children, (N, k + 1)",
                     nodes->path);
  reading->children = (unsigned)nodes->shape[1] - 1;
  if (triangles->dimensions != 1 || triangles->count > INT32_MAX)
    return trax_fail(error, "%s: the shape of the leaves' triangles is (M,)", triangles->path);
  if (triangles->count == 0 || nodes->shape[0] > 2 * triangles->count - 1)
    return trax_fail(error, "%s: %" PRIu64 " nodes; a tree over the %" PRIu64 " triangles of %s has fewer", nodes->path,
                     nodes->shape[0], triangles->count, triangles->path);
  if (reading->mesh->triangle_count == 0)
    return trax_fail(error, "%s: the mesh has no triangles for a tree", triangles->path);
  if (reading->has_boxes && (boxes->dimensions < 2 || boxes->shape[0] != nodes->shape[0] ||
                             boxes->count != PLANES * nodes->shape[0] || boxes->shape[1] == 3))
    return trax_fail(error, "%s: the boxes' shape is (N, 2, 3) or (N, 6), with %" PRIu64 " nodes in %s", boxes->path,
                     nodes->shape[0], nodes->path);
  return TRAX_OK;
}

/* --- boxes --- */

static trax_status read_box(struct scene_box *box, const struct reading *reading, uint64_t node, trax_error *error) {
  for (unsigned plane = 0; plane < PLANES; plane++)
    (plane < 3 ? box->min : box->max)[plane % 3] = scene_npy_float(&reading->boxes, node * PLANES + plane);
  for (int axis = 0; axis < 3; axis++)
    if (!(box->min[axis] <= box->max[axis]) || !isfinite(box->min[axis]) || !isfinite(box->max[axis]))
      return trax_fail(error, "%s: node %" PRIu64 ": its box is from %g to %g on axis %d", reading->boxes.path, node,
                       (double)box->min[axis], (double)box->max[axis], axis);
  return TRAX_OK;
}

static bool contains(const struct scene_box *outer, const struct scene_box *inner) {
  for (int axis = 0; axis < 3; axis++)
    if (inner->min[axis] < outer->min[axis] || inner->max[axis] > outer->max[axis])
      return false;
  return true;
}

static struct scene_box triangle_box(const struct trax_mesh *mesh, uint32_t triangle, const float *corners[3]) {
  struct scene_box box = scene_empty_box();
  for (int corner = 0; corner < 3; corner++) {
    corners[corner] = mesh->vertices[mesh->triangles[triangle].vertices[corner]];
    scene_box_add_point(&box, corners[corner]);
  }
  return box;
}

/* Adds the part of the triangle that is in the leaf to its box. */
static trax_status add_part(struct scene_tree_node *leaf, const struct reading *reading, uint64_t node,
                            uint32_t triangle, trax_error *error) {
  const float *corners[3];
  struct scene_box part = triangle_box(reading->mesh, triangle, corners), box;
  if (reading->has_boxes) {
    if (read_box(&box, reading, node, error) != TRAX_OK)
      return TRAX_ERROR;
    if (!contains(&box, &part)) {
      if (reading->copies[triangle] == 1)
        return trax_fail(error,
                         "%s: node %" PRIu64 ": triangle %" PRIu32 ", which no other leaf has, is not within its box",
                         reading->boxes.path, node, triangle);
      for (int axis = 0; axis < 3; axis++)
        if (part.min[axis] > box.max[axis] || part.max[axis] < box.min[axis])
          return trax_fail(error, "%s: node %" PRIu64 ": triangle %" PRIu32 " is not in its box", reading->boxes.path,
                           node, triangle);
      const struct scene_box whole = part;
      part = scene_clip_triangle(corners, &box);
      for (int axis = 0; axis < 3; axis++) { /* it was rounded outwards, even beyond the triangle */
        part.min[axis] = fmaxf(part.min[axis], whole.min[axis]);
        part.max[axis] = fminf(part.max[axis], whole.max[axis]);
      }
    }
  }
  scene_box_add_box(&leaf->box, &part);
  return TRAX_OK;
}

/* --- nodes --- */

static uint64_t place_in_row(const struct reading *reading, uint32_t node, unsigned column) {
  return (uint64_t)node * (reading->children + 1) + column;
}

static trax_status read_child(uint32_t *child, struct reading *reading, uint32_t node, unsigned column,
                              trax_error *error) {
  static const char *const sides[] = {"left", "right"}, *const names[MOST_CHILDREN] = {"first",   "second", "third",
                                                                                       "fourth",  "fifth",  "sixth",
                                                                                       "seventh", "eighth"};
  const uint64_t index = place_in_row(reading, node, column), count = reading->nodes.shape[0];
  const uint64_t value = scene_npy_integer(&reading->nodes, index, count);
  char text[24];
  if (value == count) {
    scene_npy_print(&reading->nodes, index, text);
    return trax_fail(error, "%s: node %" PRIu32 ": its %s child is %s, and the nodes are 0 to %" PRIu64,
                     reading->nodes.path, node, reading->children == 2 ? sides[column] : names[column], text,
                     count - 1);
  }
  *child = (uint32_t)value;
  if (*child == 0)
    return trax_fail(error, "%s: node %" PRIu32 ": its child is node 0, the root", reading->nodes.path, node);
  if (reading->parents[*child] != NOT_SEEN)
    return trax_fail(error, "%s: node %" PRIu32 ": its child %" PRIu32 " is node %" PRIu32 "'s, too",
                     reading->nodes.path, node, *child, reading->parents[*child]);
  reading->parents[*child] = node;
  return TRAX_OK;
}

/* Reads the leaf's triangles. The first pass over all leaves counts the leaves of each triangle, the second finds
 * boxes. */
static trax_status read_leaf(struct scene_tree_node *leaf, struct reading *reading, uint32_t node, uint32_t count,
                             trax_error *error) {
  const uint64_t all = reading->triangles.count;
  const uint64_t first = scene_npy_integer(&reading->nodes, place_in_row(reading, node, FIRST), all + 1);
  if (first + count > all)
    return trax_fail(error,
                     "%s: node %" PRIu32 ": a leaf of %" PRIu32 " triangles has no place in %s, which has %" PRIu64,
                     reading->nodes.path, node, count, reading->triangles.path, all);
  leaf->triangle_count = count;
  leaf->box = scene_empty_box();
  for (uint32_t i = 0; i < count; i++) {
    const uint64_t triangle = scene_npy_integer(&reading->triangles, first + i, reading->mesh->triangle_count);
    char text[24];
    if (triangle == reading->mesh->triangle_count) {
      scene_npy_print(&reading->triangles, first + i, text);
      return trax_fail(error, "%s: element %" PRIu64 " is triangle %s, and the mesh's are 0 to %" PRIu32,
                       reading->triangles.path, first + i, text, reading->mesh->triangle_count - 1);
    }
    leaf->triangles[i] = (uint32_t)triangle;
    for (uint32_t other = 0; other < i; other++)
      if (leaf->triangles[other] == triangle)
        return trax_fail(error, "%s: node %" PRIu32 ": a leaf with triangle %" PRIu64 " twice", reading->nodes.path,
                         node, triangle);
    if (reading->copies[triangle]++ && !reading->has_boxes)
      return trax_fail(error,
                       "%s: element %" PRIu64 ": another leaf has triangle %" PRIu64 ", too; this needs --tree-boxes",
                       reading->triangles.path, first + i, triangle);
  }
  reading->tree->ref_count += count;
  if (count > reading->tree->max_leaf)
    reading->tree->max_leaf = count;
  return TRAX_OK;
}

/* Finds the rows of a node's children. In nodes of more than two, 0 is no child. */
static trax_status read_inner(uint32_t child[MOST_CHILDREN], unsigned *count, struct reading *reading, uint32_t node,
                              trax_error *error) {
  struct scene_box box, below;
  *count = 0;
  for (unsigned i = 0; i < reading->children; i++) {
    if (reading->children > 2 && scene_npy_integer(&reading->nodes, place_in_row(reading, node, i), 1) == 0)
      continue;
    if (read_child(&child[(*count)++], reading, node, i, error) != TRAX_OK)
      return TRAX_ERROR;
  }
  if (*count < 2)
    return trax_fail(error, "%s: node %" PRIu32 ": an inner node with %u children; it has 2 to %u", reading->nodes.path,
                     node, *count, reading->children);
  for (unsigned i = 0; i < *count && reading->has_boxes; i++) {
    if (read_box(&box, reading, node, error) != TRAX_OK || read_box(&below, reading, child[i], error) != TRAX_OK)
      return TRAX_ERROR;
    if (!contains(&box, &below))
      return trax_fail(error, "%s: node %" PRIu32 ": its box does not contain that of its child %" PRIu32,
                       reading->boxes.path, node, child[i]);
  }
  return TRAX_OK;
}

static trax_status read_subtree(struct reading *reading, uint32_t *rows, uint32_t node, unsigned depth,
                                trax_error *error);

/* Adds the binary node above children of a row, which are halved in their order, and what is below it. Recursion is
   bounded by the greatest depth. */
static trax_status add_inner(struct reading *reading, uint32_t *rows, uint32_t node, const uint32_t child[],
                             unsigned count, unsigned depth, trax_error *error) {
  struct scene_tree *tree = reading->tree;
  if (depth == reading->max_depth)
    return trax_fail(error, "%s: node %" PRIu32 ": the tree is deeper than %u inner nodes%s", reading->nodes.path, node,
                     reading->max_depth,
                     reading->max_depth < TRAX_SCENE_MAX_DEPTH ? "; --depth 62 allows the most" : "");
  const uint32_t place = tree->node_count++;
  rows[place] = node;
  tree->inner_count++;
  if (depth + 1 > tree->max_depth)
    tree->max_depth = depth + 1;
  for (unsigned i = 0, half = count / 2; i < 2; i++) {
    const uint32_t *part = i ? child + half : child;
    const unsigned size = i ? count - half : half;
    tree->nodes[place].child[i] = tree->node_count;
    const trax_status status = size == 1 ? read_subtree(reading, rows, *part, depth + 1, error)
                                         : add_inner(reading, rows, node, part, size, depth + 1, error);
    if (status != TRAX_OK)
      return TRAX_ERROR;
  }
  return TRAX_OK;
}

/* Depth first. */
static trax_status read_subtree(struct reading *reading, uint32_t *rows, uint32_t node, unsigned depth,
                                trax_error *error) {
  struct scene_tree *tree = reading->tree;
  const uint64_t index = place_in_row(reading, node, reading->children);
  const uint64_t count = scene_npy_integer(&reading->nodes, index, (uint64_t)TRAX_SCENE_MAX_LEAF + 1);
  uint32_t child[MOST_CHILDREN];
  unsigned children;
  if (count > TRAX_SCENE_MAX_LEAF) {
    char text[24];
    scene_npy_print(&reading->nodes, index, text);
    return trax_fail(error, "%s: node %" PRIu32 ": a count of %s; a leaf has 1 to %u triangles, and an inner node 0",
                     reading->nodes.path, node, text, TRAX_SCENE_MAX_LEAF);
  }
  if (count == 0)
    return read_inner(child, &children, reading, node, error) == TRAX_OK
               ? add_inner(reading, rows, node, child, children, depth, error)
               : TRAX_ERROR;
  const uint32_t place = tree->node_count++;
  rows[place] = node;
  return read_leaf(&tree->nodes[place], reading, node, (uint32_t)count, error);
}

/* After all leaves were read. */
static trax_status find_boxes(struct reading *reading, const uint32_t *rows, trax_error *error) {
  struct scene_tree *tree = reading->tree;
  tree->bounds = scene_empty_box();
  for (uint32_t i = 0; i < tree->node_count; i++)
    for (uint32_t t = 0; t < tree->nodes[i].triangle_count; t++) {
      const float *corners[3];
      const struct scene_box whole = triangle_box(reading->mesh, tree->nodes[i].triangles[t], corners);
      scene_box_add_box(&tree->bounds, &whole);
      if (add_part(&tree->nodes[i], reading, rows[i], tree->nodes[i].triangles[t], error) != TRAX_OK)
        return TRAX_ERROR;
    }
  return TRAX_OK;
}

/* Refuses triangles in several leaves that emit light or have duplicates, whose order would depend on the leaf. */
static trax_status check_copies(const struct reading *reading, trax_error *error) {
  const struct trax_mesh *mesh = reading->mesh;
  struct scene_duplicates duplicates = {0};
  trax_status result = scene_find_duplicates(&duplicates, mesh, error);
  for (uint32_t i = 0; i < mesh->triangle_count && result == TRAX_OK; i++) {
    const float *emission = mesh->materials[mesh->triangles[i].material].surface.emission;
    if (emission[0] > 0 || emission[1] > 0 || emission[2] > 0)
      result = trax_fail(
          error, "%s: triangles in several leaves, and triangle %" PRIu32 " emits light: it would be several lamps",
          reading->triangles.path, i);
    else if (duplicates.first[i] != i)
      result = trax_fail(error,
                         "%s: triangles in several leaves, and triangles %" PRIu32 " and %" PRIu32 " are at one place",
                         reading->triangles.path, duplicates.first[i], i);
  }
  scene_duplicates_release(&duplicates);
  return result;
}

static trax_status read_tree(struct reading *reading, uint32_t *rows, trax_error *error) {
  const uint64_t count = reading->nodes.shape[0];
  for (uint64_t i = 0; i < count; i++)
    reading->parents[i] = NOT_SEEN;
  if (read_subtree(reading, rows, 0, 0, error) != TRAX_OK)
    return TRAX_ERROR;
  for (uint32_t i = 1; i < count; i++)
    if (reading->parents[i] == NOT_SEEN)
      return trax_fail(error, "%s: node %" PRIu32 " is not below the root, node 0", reading->nodes.path, i);
  for (uint32_t i = 0; i < reading->mesh->triangle_count; i++)
    if (!reading->copies[i])
      return trax_fail(error, "%s: no leaf has triangle %" PRIu32, reading->triangles.path, i);
  reading->tree->split = reading->tree->ref_count > reading->mesh->triangle_count;
  if (reading->tree->split && check_copies(reading, error) != TRAX_OK)
    return TRAX_ERROR;
  return find_boxes(reading, rows, error);
}

trax_status scene_read_tree(struct scene_tree *tree, const struct trax_mesh *mesh,
                            const struct trax_build_options *options, trax_error *error) {
  struct reading reading = {
      .tree = tree, .mesh = mesh, .max_depth = options->max_depth ? options->max_depth : TRAX_SCENE_DEFAULT_DEPTH};
  uint32_t *rows = NULL;
  trax_status result = open_arrays(&reading, options, error);
  if (result == TRAX_OK) {
    const size_t nodes = (size_t)reading.nodes.shape[0];
    const size_t most = reading.children == 2 ? nodes : 2 * nodes; /* with the binary nodes between wide ones */
    tree->nodes = calloc(most, sizeof *tree->nodes);
    reading.parents = malloc(nodes * sizeof *reading.parents);
    reading.copies = calloc(mesh->triangle_count, sizeof *reading.copies);
    rows = malloc(most * sizeof *rows);
    result = tree->nodes && reading.parents && reading.copies && rows ? read_tree(&reading, rows, error)
                                                                      : scene_out_of_memory(error, "BVH");
  }
  free(rows);
  free(reading.parents);
  free(reading.copies);
  scene_npy_release(&reading.nodes);
  scene_npy_release(&reading.triangles);
  scene_npy_release(&reading.boxes);
  return result;
}
