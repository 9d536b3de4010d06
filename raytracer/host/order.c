/* Where in the file each node stands. A node is one line of the cache, so order cannot make two of them share a line;
   in a direct-mapped cache it decides which of them drive each other out. Nodes are taken by the area of their boxes,
   to which the chance of a visit is proportional:
   - Treelets: from a root, the largest nodes that a part of the cache has room for stand together, hence in different
     sets; then, for each node below them, the next treelet.
   - The hottest nodes of all have sets of their own: they stand first, and what shares their sets, in every further
     stretch of the size of the cache, are the smallest nodes of the tree.
   docs/raytracer.md has the measurements. */
#include "internal.h"

#include <stdlib.h>
#include <string.h>

struct order {
  const struct scene_tree *tree;
  const double *areas; /* of every node's box */
  uint32_t *sequence;  /* nodes of the tree in treelet order */
  uint32_t placed;
  uint32_t treelet; /* nodes in one */
};

static bool is_inner(const struct scene_tree *tree, uint32_t node) {
  return tree->nodes[node].triangle_count == 0;
}

static void measure_areas(double *areas, struct scene_box *boxes, const struct scene_tree *tree,
                          const struct trax_mesh *mesh) {
  for (uint32_t i = tree->node_count; i-- > 0;) { /* children stand behind their parents */
    const struct scene_tree_node *node = &tree->nodes[i];
    boxes[i] = scene_empty_box();
    for (uint32_t t = 0; t < node->triangle_count; t++)
      for (int corner = 0; corner < 3; corner++)
        scene_box_add_point(&boxes[i], mesh->vertices[mesh->triangles[node->triangles[t]].vertices[corner]]);
    for (int c = 0; c < 2 && !node->triangle_count; c++)
      scene_box_add_box(&boxes[i], &boxes[node->child[c]]);
    areas[i] = scene_half_area(boxes[i].min, boxes[i].max);
  }
}

/* The treelet below root and, recursively, those below it; each level of recursion is at least one of the tree.
   frontier has room for treelet + 1 nodes for every level. */
static void place_treelets(struct order *order, uint32_t root, uint32_t *frontier) {
  uint32_t count = 1;
  frontier[0] = root;
  for (uint32_t taken = 0; taken < order->treelet && count > 0; taken++) {
    uint32_t largest = 0;
    for (uint32_t i = 1; i < count; i++)
      if (order->areas[frontier[i]] > order->areas[frontier[largest]])
        largest = i;
    uint32_t node = frontier[largest];
    order->sequence[order->placed++] = node;
    /* The node's place in the frontier is taken by those of its children that are nodes: it stays depth first. */
    uint32_t children[2], inner = 0;
    for (int c = 0; c < 2; c++)
      if (is_inner(order->tree, order->tree->nodes[node].child[c]))
        children[inner++] = order->tree->nodes[node].child[c];
    memmove(frontier + largest + inner, frontier + largest + 1, (count - largest - 1) * sizeof *frontier);
    memcpy(frontier + largest, children, inner * sizeof *frontier);
    count += inner - 1;
  }
  for (uint32_t i = 0; i < count; i++)
    place_treelets(order, frontier[i], frontier + count);
}

struct ranked {
  double area;
  uint32_t node;
};

/* Largest first; equal ones as they stand in the tree, so that the order is one. */
static int compare_ranked(const void *a, const void *b) {
  const struct ranked *left = a, *right = b;
  if (left->area != right->area)
    return left->area > right->area ? -1 : 1;
  return left->node < right->node ? -1 : left->node > right->node;
}

/* Gives each node its final position: hot ones the first, cold ones those that share the hot ones' sets, the others the
   rest, each kind in treelet order. */
static void assign_positions(uint32_t *positions, const struct order *order, struct ranked *ranked, uint32_t cache,
                             uint32_t hot) {
  uint32_t count = order->placed;
  for (uint32_t i = 0; i < count; i++)
    ranked[i] = (struct ranked){order->areas[order->sequence[i]], order->sequence[i]};
  qsort(ranked, count, sizeof *ranked, compare_ranked);
  uint32_t hot_count = count < hot ? count : hot, cold_count = 0;
  if (count > cache)
    cold_count = (count / cache - 1) * hot + (count % cache < hot ? count % cache : hot);
  enum { warm_kind, hot_kind, cold_kind };
  /* positions first holds each node's kind */
  for (uint32_t i = 0; i < count; i++)
    positions[ranked[i].node] = i < hot_count ? hot_kind : i >= count - cold_count ? cold_kind : warm_kind;
  uint32_t next_hot = 0, next_cold = cache, next_warm = hot_count;
  for (uint32_t i = 0; i < count; i++) {
    uint32_t *position = &positions[order->sequence[i]];
    switch (*position) {
    case hot_kind:
      *position = next_hot++;
      break;
    case cold_kind:
      *position = next_cold++;
      if (next_cold % cache == hot)
        next_cold += cache - hot;
      break;
    default:
      *position = next_warm++;
      if (next_warm % cache == 0)
        next_warm += hot;
    }
  }
}

trax_status scene_order_nodes(uint32_t **positions, const struct scene_tree *tree, const struct trax_mesh *mesh,
                              uint32_t cache_lines, trax_error *error) {
  size_t count = tree->node_count;
  *positions = malloc((count + 1) * sizeof **positions);
  if (!*positions)
    return scene_out_of_memory(error, "BVH");
  if (cache_lines < 8 || tree->inner_count == 0) { /* depth first */
    for (uint32_t i = 0, inner = 0; i < count; i++)
      (*positions)[i] = is_inner(tree, i) ? inner++ : 0;
    return TRAX_OK;
  }
  struct order order = {.tree = tree, .treelet = cache_lines / 2};
  double *areas = malloc(count * sizeof *areas);
  struct scene_box *boxes = malloc(count * sizeof *boxes);
  struct ranked *ranked = malloc(count * sizeof *ranked);
  uint32_t *sequence = malloc(count * sizeof *sequence);
  uint32_t *frontier = malloc((tree->max_depth + (size_t)1) * (order.treelet + 1) * sizeof *frontier);
  trax_status result = TRAX_OK;
  if (areas && boxes && ranked && sequence && frontier) {
    measure_areas(areas, boxes, tree, mesh);
    order.areas = areas;
    order.sequence = sequence;
    place_treelets(&order, 0, frontier);
    assign_positions(*positions, &order, ranked, cache_lines, cache_lines / 4);
  } else
    result = scene_out_of_memory(error, "BVH");
  free(areas);
  free(boxes);
  free(ranked);
  free(sequence);
  free(frontier);
  if (result != TRAX_OK)
    free(*positions);
  return result;
}
