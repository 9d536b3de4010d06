/* Wide nodes from a binary tree: of a node's children the one with the largest surface gives way to its own two, until
   there are as many as the layout has room for (Wald, Benthin and Boulos, "Getting rid of packets", 2008). */
#include "layouts.h"

#include <stdlib.h>

enum { NONE = UINT32_MAX };

struct widening {
  struct scene_wide *wide;
  const struct scene_tree *tree;
  enum trax_node_layout layout;
  const struct trax_node_format *format;
  bool arranged;           /* nodes decide on the places of their children */
  struct scene_box *boxes; /* of each node of the tree */
  uint32_t *heights;       /* inner nodes from each to a leaf */
  uint32_t *room;          /* entries of the stack that each wide node may use, by its first node of the tree */
};

static bool is_inner(const struct scene_tree *tree, uint32_t index) {
  return tree->nodes[index].triangle_count == 0;
}

/* Children have greater indices than their parents. */
static void measure(struct widening *w) {
  for (uint32_t i = w->tree->node_count; i-- > 0;) {
    const struct scene_tree_node *node = &w->tree->nodes[i];
    w->boxes[i] = is_inner(w->tree, i) ? scene_empty_box() : node->box;
    w->heights[i] = 0;
    for (int k = 0; k < 2 && is_inner(w->tree, i); k++) {
      const uint32_t child = node->child[k], height = w->heights[child] + 1;
      scene_box_add_box(&w->boxes[i], &w->boxes[child]);
      w->heights[i] = height > w->heights[i] ? height : w->heights[i];
    }
  }
}

/* Whether these may be the children of one node. There must be room for the tree below each. */
static bool fits(const struct widening *w, const uint32_t *children, uint32_t count, uint32_t room) {
  uint32_t triangles = 0;
  for (uint32_t i = 0; i < count; i++) {
    triangles += w->tree->nodes[children[i]].triangle_count;
    if (!w->arranged && count - 1 + w->heights[children[i]] > room)
      return false;
  }
  return !w->arranged || triangles <= w->format->code->most_triangles;
}

/* Puts the children of a child in its place. */
static void open_child(uint32_t *out, const uint32_t *children, uint32_t count, uint32_t place,
                       const struct scene_tree *tree) {
  for (uint32_t i = 0, at = 0; i < count; i++)
    for (int k = 0; k < (i == place ? 2 : 1); k++)
      out[at++] = i == place ? tree->nodes[children[i]].child[k] : children[i];
}

static void widen_node(struct widening *w, uint32_t index) {
  const uint32_t most = w->format->children, room = w->room[index];
  struct scene_wide *wide = w->wide;
  struct scene_wide_node *node = &wide->nodes[wide->number[index] = wide->count++];
  *node = (struct scene_wide_node){.count = 1, .child = {index}};
  while (node->count < most) {
    uint32_t opened[TRAX_NODE_MOST_CHILDREN], best = NONE;
    double best_area = -1;
    for (uint32_t i = 0; i < node->count; i++) {
      const struct scene_box *box = &w->boxes[node->child[i]];
      if (!is_inner(w->tree, node->child[i]) || scene_half_area(box->min, box->max) <= best_area)
        continue;
      open_child(opened, node->child, node->count, i, w->tree);
      if (node->count > 1 && !fits(w, opened, node->count + 1, room))
        continue;
      best = i, best_area = scene_half_area(box->min, box->max);
    }
    if (best == (uint32_t)NONE)
      break;
    const struct scene_wide_node old = *node;
    open_child(node->child, old.child, node->count++, best, w->tree);
  }
  if (w->arranged)
    w->format->code->arrange(node, w->boxes, &w->boxes[index]);
  for (uint32_t i = 0; i < node->count; i++)
    w->room[node->child[i]] = w->arranged ? 1 : room - (node->count - 1);
}

/* Positions and the order of leaves where the layout decides them: children that are nodes follow one another, and
   leaves come before the leaves of nodes. Recursion, here and below, is bounded by the depth of the tree. */
static void place_below(struct scene_wide *wide, const struct scene_tree *tree, uint32_t number, uint32_t *next_node,
                        uint32_t *next_leaf) {
  const struct scene_wide_node *node = &wide->nodes[number];
  for (uint32_t i = 0; i < node->count; i++)
    if (is_inner(tree, node->child[i]))
      wide->position[wide->number[node->child[i]]] = (*next_node)++;
    else
      wide->leaves[(*next_leaf)++] = node->child[i];
  for (uint32_t i = 0; i < node->count; i++)
    if (is_inner(tree, node->child[i]))
      place_below(wide, tree, wide->number[node->child[i]], next_node, next_leaf);
}

static void count_entries(struct scene_wide *wide, const struct widening *w, uint32_t number, uint32_t above) {
  const struct scene_wide_node *node = &wide->nodes[number];
  const uint32_t here = scene_stack_entries(w->layout, above, node->count, &wide->entries);
  for (uint32_t i = 0; i < node->count; i++)
    if (is_inner(w->tree, node->child[i]))
      count_entries(wide, w, wide->number[node->child[i]], here);
}

static void widen_all(struct widening *w) {
  struct scene_wide *wide = w->wide;
  const struct scene_tree *tree = w->tree;
  measure(w);
  for (uint32_t i = 0; i < tree->node_count; i++)
    w->room[i] = 0, wide->number[i] = NONE;
  w->room[0] = tree->max_depth < TRAX_SCENE_DEFAULT_DEPTH ? TRAX_SCENE_DEFAULT_DEPTH : tree->max_depth;
  for (uint32_t i = 0; i < tree->node_count; i++)
    if (w->room[i] && (is_inner(tree, i) || (i == 0 && w->arranged)))
      widen_node(w, i);
  if (wide->count)
    count_entries(wide, w, 0, 0);
  if (w->arranged) {
    uint32_t next_node = 1, next_leaf = 0;
    wide->position[0] = 0;
    place_below(wide, tree, 0, &next_node, &next_leaf);
  }
}

bool scene_widen(struct scene_wide *wide, const struct scene_tree *tree, enum trax_node_layout layout) {
  const struct trax_node_format *format = &trax_node_formats[layout];
  const bool arranged = format->code->arrange != NULL;
  const size_t count = tree->node_count + (size_t)1;
  *wide = (struct scene_wide){.nodes = malloc((tree->inner_count + (size_t)1) * sizeof *wide->nodes),
                              .number = malloc(count * sizeof *wide->number),
                              .position = malloc((tree->inner_count + (size_t)1) * sizeof *wide->position),
                              .by_position = malloc((tree->inner_count + (size_t)1) * sizeof *wide->by_position)};
  struct widening w = {wide,
                       tree,
                       layout,
                       format,
                       arranged,
                       malloc(count * sizeof *w.boxes),
                       malloc(count * sizeof *w.heights),
                       malloc(count * sizeof *w.room)};
  if (arranged)
    wide->leaves = malloc(count * sizeof *wide->leaves);
  const bool room = wide->nodes && wide->number && wide->position && wide->by_position && w.boxes && w.heights &&
                    w.room && (!arranged || wide->leaves);
  if (room)
    widen_all(&w);
  free(w.boxes);
  free(w.heights);
  free(w.room);
  if (!room)
    scene_wide_release(wide);
  return room;
}

void scene_place_wide(struct scene_wide *wide, const struct scene_tree *tree, const uint32_t *position) {
  if (wide->leaves)
    return; /* the layout has decided */
  uint32_t *at = wide->by_position, next = 0;
  for (uint32_t i = 0; i < tree->node_count; i++)
    if (is_inner(tree, i))
      at[position[i]] = i;
  for (uint32_t i = 0; i < tree->inner_count; i++)
    if (wide->number[at[i]] != (uint32_t)NONE)
      wide->position[wide->number[at[i]]] = next++;
}

void scene_wide_release(struct scene_wide *wide) {
  free(wide->nodes);
  free(wide->number);
  free(wide->position);
  free(wide->by_position);
  free(wide->leaves);
  *wide = (struct scene_wide){0};
}
