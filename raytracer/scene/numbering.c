/* Numbers the nodes of a built tree depth first, so that nothing depends on which thread built them, and
   rebuilds subtrees that are too deep. */
#include "built_tree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

unsigned scene_least_height(uint32_t triangles, unsigned max_leaf) {
  unsigned height = 0;
  while ((uint64_t)max_leaf << height < triangles)
    height++;
  return height;
}

/* Adds a leaf's triangles, each followed by the others at its place. */
static uint32_t *add_leaf(uint32_t *end, const struct scene_numbering *numbering, const struct built_node *leaf) {
  for (uint32_t i = 0; i < leaf->triangle_count; i++) {
    *end++ = leaf->triangles[i];
    for (uint32_t other = leaf->triangles[i];
         numbering->duplicates && (other = numbering->duplicates->after[other]) != SCENE_NO_DUPLICATE;)
      *end++ = other;
  }
  return end;
}

/* Recursion is bounded by the builder's depth (bvh.c). */
bool scene_measure_built(const struct scene_numbering *numbering, struct built_node *node) {
  node->below = node->triangle_count;
  node->height = 0;
  node->nodes = 1;
  if (node->triangle_count) {
    for (uint32_t i = 0; i < node->triangle_count && numbering->duplicates; i++)
      for (uint32_t other = node->triangles[i]; (other = numbering->duplicates->after[other]) != SCENE_NO_DUPLICATE;)
        node->below++;
    node->height = scene_least_height(node->below, numbering->max_leaf);
    return true;
  }
  for (int i = 0; i < 2; i++) {
    struct built_node *child = node->child[i];
    if (!child || !scene_measure_built(numbering, child))
      return false;
    node->below += child->below;
    node->nodes += child->nodes;
    node->height = child->height + 1 > node->height ? child->height + 1 : node->height;
  }
  return true;
}

static struct scene_tree_node *add_node(struct scene_tree *tree, unsigned depth, const uint32_t *triangles,
                                        uint32_t triangle_count) {
  struct scene_tree_node *node = &tree->nodes[tree->node_count++];
  node->triangle_count = triangle_count;
  if (triangle_count) {
    memcpy(node->triangles, triangles, triangle_count * sizeof *triangles);
    tree->ref_count += triangle_count;
    if (triangle_count > tree->max_leaf)
      tree->max_leaf = triangle_count;
  } else {
    memset(node->child, 0, sizeof node->child);
    tree->inner_count++;
    if (depth + 1 > tree->max_depth)
      tree->max_depth = depth + 1;
  }
  return node;
}

static uint32_t *collect(uint32_t *end, const struct scene_numbering *numbering, const struct built_node *built) {
  if (built->triangle_count)
    return add_leaf(end, numbering, built);
  for (int i = 0; i < 2; i++)
    end = collect(end, numbering, built->child[i]);
  return end;
}

static int compare_numbers(const void *a, const void *b) {
  const uint32_t *left = a, *right = b;
  return *left < *right ? -1 : *left > *right;
}

/* Removes repeated triangles. */
static uint32_t unite(uint32_t *triangles, uint32_t count) {
  uint32_t kept = 0;
  qsort(triangles, count, sizeof *triangles, compare_numbers);
  for (uint32_t i = 0; i < count; i++)
    if (kept == 0 || triangles[i] != triangles[kept - 1])
      triangles[kept++] = triangles[i];
  return kept;
}

struct sort_key {
  double place; /* twice the middle of the triangle's box */
  uint32_t triangle;
};

static int compare_keys(const void *a, const void *b) {
  const struct sort_key *left = a, *right = b;
  if (left->place != right->place)
    return left->place < right->place ? -1 : 1;
  return left->triangle < right->triangle ? -1 : left->triangle > right->triangle;
}

static double middle(const struct trax_mesh *mesh, uint32_t triangle, int axis) {
  const struct scene_box box = scene_triangle_box(mesh, triangle);
  return (double)box.min[axis] + (double)box.max[axis];
}

/* Builds a tree of the least height: halves the triangles by number, along the axis on which their middles spread most,
   until they fit in leaves. False when out of memory. */
static bool add_balanced(struct scene_numbering *numbering, uint32_t *triangles, uint32_t count, unsigned depth) {
  if (count <= numbering->max_leaf) {
    qsort(triangles, count, sizeof *triangles, compare_numbers);
    struct scene_tree_node *leaf = add_node(numbering->tree, depth, triangles, count);
    leaf->box = scene_empty_box();
    for (uint32_t i = 0; i < count; i++) {
      const struct scene_box part = scene_triangle_box(numbering->mesh, triangles[i]);
      scene_box_add_box(&leaf->box, &part);
    }
    return true;
  }
  int widest = 0;
  double most = -1;
  for (int axis = 0; axis < 3; axis++) {
    double low = INFINITY, high = -INFINITY;
    for (uint32_t i = 0; i < count; i++) {
      double place = middle(numbering->mesh, triangles[i], axis);
      low = fmin(low, place), high = fmax(high, place);
    }
    if (high - low > most)
      most = high - low, widest = axis;
  }
  struct sort_key *keys = malloc(count * sizeof *keys);
  if (!keys)
    return false;
  for (uint32_t i = 0; i < count; i++)
    keys[i] = (struct sort_key){middle(numbering->mesh, triangles[i], widest), triangles[i]};
  qsort(keys, count, sizeof *keys, compare_keys);
  for (uint32_t i = 0; i < count; i++)
    triangles[i] = keys[i].triangle;
  free(keys);
  struct scene_tree_node *node = add_node(numbering->tree, depth, NULL, 0);
  const uint32_t half = (count + 1) / 2;
  node->child[0] = numbering->tree->node_count;
  if (!add_balanced(numbering, triangles, half, depth + 1))
    return false;
  node->child[1] = numbering->tree->node_count;
  return add_balanced(numbering, triangles + half, count - half, depth + 1);
}

/* depth: the inner nodes above. A subtree is rebuilt as low as possible: where its children have too few levels left
   for any tree over their triangles. */
static bool number_nodes(struct scene_numbering *numbering, const struct built_node *built, unsigned depth) {
  if (built->triangle_count) {
    const uint32_t count = (uint32_t)(add_leaf(numbering->triangles, numbering, built) - numbering->triangles);
    if (count > numbering->max_leaf)
      return add_balanced(numbering, numbering->triangles, count, depth);
    add_node(numbering->tree, depth, numbering->triangles, count)->box = built->box;
    return true;
  }
  if (depth + built->height > numbering->max_depth)
    for (int i = 0; i < 2; i++)
      if (depth + 1 + scene_least_height(built->child[i]->below, numbering->max_leaf) > numbering->max_depth) {
        uint32_t *end = collect(numbering->triangles, numbering, built);
        return add_balanced(numbering, numbering->triangles,
                            unite(numbering->triangles, (uint32_t)(end - numbering->triangles)), depth);
      }
  struct scene_tree_node *node = add_node(numbering->tree, depth, NULL, 0);
  for (int i = 0; i < 2; i++) {
    node->child[i] = numbering->tree->node_count;
    if (!number_nodes(numbering, built->child[i], depth + 1))
      return false;
  }
  return true;
}

bool scene_number_built(struct scene_numbering *numbering, const struct built_node *root) {
  return number_nodes(numbering, root, 0);
}

static bool number_linked(struct scene_numbering *numbering, const struct scene_links *links,
                          struct built_node *const *built, uint32_t index, unsigned depth) {
  const struct scene_link *link = &links->nodes[index];
  if (link->child[0] == SCENE_NO_LINK)
    return number_nodes(numbering, built[index], depth);
  struct scene_tree_node *node = add_node(numbering->tree, depth, NULL, 0);
  for (int i = 0; i < 2; i++) {
    node->child[i] = numbering->tree->node_count;
    if (!number_linked(numbering, links, built, link->child[i], depth + 1))
      return false;
  }
  return true;
}

bool scene_number_links(struct scene_numbering *numbering, const struct scene_links *links,
                        struct built_node *const *built) {
  return number_linked(numbering, links, built, links->root, 0);
}
