/* A tree of another builder, from arrays (docs/own-tree.md). Everything is checked here, except that the leaves of a
   triangle cover it, which needs the finished file. */
#include "own_tree.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST, MOST_CHILDREN = 8, PLANES = 6 };

static trax_status open_arrays(struct scene_tree_reading *reading, const struct trax_build_options *options,
                               trax_error *error) {
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

/* --- nodes --- */

static uint64_t place_in_row(const struct scene_tree_reading *reading, uint32_t node, unsigned column) {
  return (uint64_t)node * (reading->children + 1) + column;
}

static trax_status read_child(uint32_t *child, struct scene_tree_reading *reading, uint32_t node, unsigned column,
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
  if (reading->parents[*child] != SCENE_NOT_SEEN)
    return trax_fail(error, "%s: node %" PRIu32 ": its child %" PRIu32 " is node %" PRIu32 "'s, too",
                     reading->nodes.path, node, *child, reading->parents[*child]);
  reading->parents[*child] = node;
  return TRAX_OK;
}

/* Reads some of a row's triangles, from an element on. Boxes are found when all leaves are known. */
static trax_status read_leaf(struct scene_tree_node *leaf, struct scene_tree_reading *reading, uint32_t node,
                             uint64_t first, uint32_t count, trax_error *error) {
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
    if (reading->latest[triangle] == node)
      return trax_fail(error, "%s: node %" PRIu32 ": a leaf with triangle %" PRIu64 " twice", reading->nodes.path, node,
                       triangle);
    reading->latest[triangle] = node;
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
static trax_status read_inner(uint32_t child[MOST_CHILDREN], unsigned *count, struct scene_tree_reading *reading,
                              uint32_t node, trax_error *error) {
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
    if (scene_read_row_box(&box, reading, node, error) != TRAX_OK ||
        scene_read_row_box(&below, reading, child[i], error) != TRAX_OK)
      return TRAX_ERROR;
    if (!scene_box_contains(&box, &below))
      return trax_fail(error, "%s: node %" PRIu32 ": its box does not contain that of its child %" PRIu32,
                       reading->boxes.path, node, child[i]);
  }
  return TRAX_OK;
}

static trax_status read_subtree(struct scene_tree_reading *reading, uint32_t node, unsigned depth, trax_error *error);

/* Adds an inner node of the tree, whose children come next; NULL: the tree is too deep. */
static struct scene_tree_node *begin_inner(struct scene_tree_reading *reading, uint32_t node, unsigned depth,
                                           trax_error *error) {
  struct scene_tree *tree = reading->tree;
  if (depth == reading->max_depth) {
    trax_fail(error, "%s: node %" PRIu32 ": the tree is deeper than %u inner nodes%s", reading->nodes.path, node,
              reading->max_depth, reading->max_depth < TRAX_SCENE_MAX_DEPTH ? "; --depth 62 allows the most" : "");
    return NULL;
  }
  if (depth + 1 > tree->max_depth)
    tree->max_depth = depth + 1;
  tree->inner_count++;
  reading->rows[tree->node_count] = node;
  return &tree->nodes[tree->node_count++];
}

/* Adds the binary node above children of a row, which are halved in their order, and what is below it. Recursion, here
   and below, is bounded by the greatest depth. */
static trax_status add_inner(struct scene_tree_reading *reading, uint32_t node, const uint32_t child[], unsigned count,
                             unsigned depth, trax_error *error) {
  struct scene_tree_node *inner = begin_inner(reading, node, depth, error);
  trax_status status = inner ? TRAX_OK : TRAX_ERROR;
  for (unsigned i = 0, half = count / 2; i < 2 && status == TRAX_OK; i++) {
    const uint32_t *part = i ? child + half : child;
    const unsigned size = i ? count - half : half;
    inner->child[i] = reading->tree->node_count;
    status = size == 1 ? read_subtree(reading, *part, depth + 1, error)
                       : add_inner(reading, node, part, size, depth + 1, error);
  }
  return status;
}

static uint32_t leaves_for(uint64_t triangles) {
  return (uint32_t)((triangles + TRAX_SCENE_MAX_LEAF - 1) / TRAX_SCENE_MAX_LEAF);
}

/* Adds a leaf. A leaf too large for the format becomes the fewest leaves that hold its triangles, nearly equal in
   size, below binary nodes that halve them. */
static trax_status add_leaf(struct scene_tree_reading *reading, uint32_t node, uint64_t first, uint32_t count,
                            unsigned depth, trax_error *error) {
  struct scene_tree *tree = reading->tree;
  const uint32_t leaves = leaves_for(count);
  if (leaves == 1) {
    reading->rows[tree->node_count] = node;
    return read_leaf(&tree->nodes[tree->node_count++], reading, node, first, count, error);
  }
  struct scene_tree_node *inner = begin_inner(reading, node, depth, error);
  trax_status status = inner ? TRAX_OK : TRAX_ERROR;
  const uint32_t half = (uint32_t)((uint64_t)count * (leaves / 2) / leaves);
  for (unsigned i = 0; i < 2 && status == TRAX_OK; i++) {
    inner->child[i] = tree->node_count;
    status = add_leaf(reading, node, i ? first + half : first, i ? count - half : half, depth + 1, error);
  }
  return status;
}

/* Depth first. */
static trax_status read_subtree(struct scene_tree_reading *reading, uint32_t node, unsigned depth, trax_error *error) {
  const uint64_t all = reading->triangles.count;
  const uint32_t count =
      (uint32_t)scene_npy_integer(&reading->nodes, place_in_row(reading, node, reading->children), all + 1);
  uint32_t child[MOST_CHILDREN];
  unsigned children;
  if (count == 0)
    return read_inner(child, &children, reading, node, error) == TRAX_OK
               ? add_inner(reading, node, child, children, depth, error)
               : TRAX_ERROR;
  const uint64_t first = scene_npy_integer(&reading->nodes, place_in_row(reading, node, FIRST), all + 1);
  if (first + count > all)
    return trax_fail(error,
                     "%s: node %" PRIu32 ": a leaf of %" PRIu32 " triangles has no place in %s, which has %" PRIu64,
                     reading->nodes.path, node, count, reading->triangles.path, all);
  return add_leaf(reading, node, first, count, depth, error);
}

/* The nodes of the tree: the rows, the binary nodes between wide ones, and those of large leaves. These have no more
   triangles together than there are, so that a small file makes no large tree. */
static trax_status count_nodes(size_t *nodes, const struct scene_tree_reading *reading, trax_error *error) {
  const uint64_t rows = reading->nodes.shape[0], all = reading->triangles.count;
  uint64_t in_large = 0;
  *nodes = (size_t)(reading->children == 2 ? rows : 2 * rows);
  for (uint32_t node = 0; node < rows; node++) {
    const uint64_t index = place_in_row(reading, node, reading->children);
    const uint64_t count = scene_npy_integer(&reading->nodes, index, all + 1);
    char text[24];
    if (count > all) {
      scene_npy_print(&reading->nodes, index, text);
      return trax_fail(error,
                       "%s: node %" PRIu32 ": a count of %s; a leaf has 1 to %" PRIu64
                       " triangles, those of %s, and an inner node 0",
                       reading->nodes.path, node, text, all, reading->triangles.path);
    }
    if (count <= TRAX_SCENE_MAX_LEAF)
      continue;
    in_large += count;
    if (in_large > all)
      return trax_fail(error,
                       "%s: node %" PRIu32 ": with this one's %" PRIu64 ", leaves of more than %u have more triangles"
                       " than the %" PRIu64 " of %s",
                       reading->nodes.path, node, count, TRAX_SCENE_MAX_LEAF, all, reading->triangles.path);
    *nodes += 2 * (leaves_for(count) - 1);
  }
  return TRAX_OK;
}

/* Refuses triangles in several leaves that emit light or have duplicates, whose order would depend on the leaf. */
static trax_status check_copies(const struct scene_tree_reading *reading, trax_error *error) {
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

static trax_status read_tree(struct scene_tree_reading *reading, trax_error *error) {
  const uint64_t count = reading->nodes.shape[0];
  for (uint64_t i = 0; i < count; i++)
    reading->parents[i] = SCENE_NOT_SEEN;
  for (uint32_t i = 0; i < reading->mesh->triangle_count; i++)
    reading->latest[i] = SCENE_NOT_SEEN;
  if (read_subtree(reading, 0, 0, error) != TRAX_OK)
    return TRAX_ERROR;
  for (uint32_t i = 1; i < count; i++)
    if (reading->parents[i] == SCENE_NOT_SEEN)
      return trax_fail(error, "%s: node %" PRIu32 " is not below the root, node 0", reading->nodes.path, i);
  for (uint32_t i = 0; i < reading->mesh->triangle_count; i++)
    if (!reading->copies[i])
      return trax_fail(error, "%s: no leaf has triangle %" PRIu32, reading->triangles.path, i);
  reading->tree->split = reading->tree->ref_count > reading->mesh->triangle_count;
  if (reading->tree->split && check_copies(reading, error) != TRAX_OK)
    return TRAX_ERROR;
  return scene_find_leaf_boxes(reading, error);
}

trax_status scene_read_tree(struct scene_tree *tree, const struct trax_mesh *mesh,
                            const struct trax_build_options *options, trax_error *error) {
  struct scene_tree_reading reading = {
      .tree = tree, .mesh = mesh, .max_depth = options->max_depth ? options->max_depth : TRAX_SCENE_DEFAULT_DEPTH};
  size_t most;
  trax_status result = open_arrays(&reading, options, error);
  if (result == TRAX_OK)
    result = count_nodes(&most, &reading, error);
  if (result == TRAX_OK) {
    tree->nodes = calloc(most, sizeof *tree->nodes);
    reading.rows = malloc(most * sizeof *reading.rows);
    reading.parents = malloc((size_t)reading.nodes.shape[0] * sizeof *reading.parents);
    reading.copies = calloc(mesh->triangle_count, sizeof *reading.copies);
    reading.latest = malloc(mesh->triangle_count * sizeof *reading.latest);
    result = tree->nodes && reading.rows && reading.parents && reading.copies && reading.latest
                 ? read_tree(&reading, error)
                 : scene_out_of_memory(error, "BVH");
  }
  free(reading.rows);
  free(reading.parents);
  free(reading.copies);
  free(reading.latest);
  scene_npy_release(&reading.nodes);
  scene_npy_release(&reading.triangles);
  scene_npy_release(&reading.boxes);
  return result;
}
