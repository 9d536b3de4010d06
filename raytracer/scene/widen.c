/* Wide trees: a node of four children takes the place of up to three binary ones. */
#include "internal.h"

#include <stdlib.h>
#include <string.h>

struct widening {
  const struct scene_tree_node *binary;
  const double *areas;     /* of every binary node's box */
  const uint32_t *heights; /* inner nodes on the longest path down, itself included; of a leaf 0 */
  struct scene_tree *wide;
};

static void measure(double *areas, uint32_t *heights, struct scene_box *boxes, const struct scene_tree *tree) {
  for (uint32_t i = tree->node_count; i-- > 0;) { /* children stand behind their parents */
    const struct scene_tree_node *node = &tree->nodes[i];
    boxes[i] = node->triangle_count ? node->box : scene_empty_box();
    heights[i] = 0;
    for (int c = 0; c < 2 && !node->triangle_count; c++) {
      const uint32_t child = node->child[c];
      scene_box_add_box(&boxes[i], &boxes[child]);
      heights[i] = heights[child] + 1 > heights[i] ? heights[child] + 1 : heights[i];
    }
    areas[i] = scene_half_area(boxes[i].min, boxes[i].max);
  }
}

/* May children[opened] be replaced by its own two? Below each there must be room for a tree as it is now. */
static bool may_open(const struct widening *widening, const uint32_t children[], uint32_t count, uint32_t opened,
                     uint32_t entries) {
  const struct scene_tree_node *node = &widening->binary[children[opened]];
  if (node->triangle_count)
    return false;
  bool room = true;
  for (uint32_t i = 0; i < count; i++)
    room = room && (i == opened || count + widening->heights[children[i]] <= entries);
  for (int i = 0; i < 2; i++)
    room = room && count + widening->heights[node->child[i]] <= entries;
  return room;
}

/* The largest of the children gives way to its own until there are four; they stay in their order, so that leaves do.
   Returns the number of the node. Recursion is bounded by the binary tree's depth. */
static uint32_t widen(struct widening *widening, uint32_t index, uint32_t entries, uint32_t depth) {
  const struct scene_tree_node *binary = &widening->binary[index];
  struct scene_tree *wide = widening->wide;
  const uint32_t number = wide->node_count++;
  struct scene_tree_node *node = &wide->nodes[number];
  if (binary->triangle_count) {
    *node = *binary;
    return number;
  }
  uint32_t children[TRAX_MAX_WIDTH] = {binary->child[0], binary->child[1]}, count = 2;
  while (count < TRAX_MAX_WIDTH) {
    uint32_t largest = count;
    for (uint32_t i = 0; i < count; i++)
      if (may_open(widening, children, count, i, entries) &&
          (largest == count || widening->areas[children[i]] > widening->areas[children[largest]]))
        largest = i;
    if (largest == count)
      break;
    memmove(&children[largest + 2], &children[largest + 1], (count - largest - 1) * sizeof *children);
    memcpy(&children[largest], widening->binary[children[largest]].child, 2 * sizeof *children);
    count++;
  }
  *node = (struct scene_tree_node){0};
  wide->inner_count++;
  if (depth + count - 1 > wide->max_depth)
    wide->max_depth = depth + count - 1;
  for (uint32_t i = 0; i < count; i++) {
    const uint32_t child = widen(widening, children[i], entries - (count - 1), depth + count - 1);
    wide->nodes[number].child[i] = child;
  }
  return number;
}

trax_status scene_widen_tree(struct scene_tree *tree, uint32_t entries, trax_error *error) {
  const size_t count = tree->node_count;
  struct scene_tree wide = *tree;
  double *areas = malloc((count + 1) * sizeof *areas);
  uint32_t *heights = malloc((count + 1) * sizeof *heights);
  struct scene_box *boxes = malloc((count + 1) * sizeof *boxes);
  wide.nodes = malloc((count + 1) * sizeof *wide.nodes);
  wide.node_count = wide.inner_count = wide.max_depth = 0;
  const bool good = areas && heights && boxes && wide.nodes;
  if (good && count) {
    struct widening widening = {tree->nodes, areas, heights, &wide};
    measure(areas, heights, boxes, tree);
    widen(&widening, 0, entries > tree->max_depth ? entries : tree->max_depth, 0);
  }
  free(areas);
  free(heights);
  free(boxes);
  free(good ? tree->nodes : wide.nodes);
  if (!good)
    return scene_out_of_memory(error, "BVH");
  *tree = wide;
  return TRAX_OK;
}
