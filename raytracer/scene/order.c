/* The order of nodes in the file. It decides which nodes share a cache line, if a line has room for two, and which
   lines conflict in a direct-mapped cache. The area of a node's box ranks it, since the chance of a visit is
   proportional to that:
   - Groups: a node and the larger of its children share a line. Two nodes that are left over share one.
   - Treelets: from a root, the groups with the largest nodes follow each other, as many as fit in half of the cache, so
     that they are in different sets. A treelet for each group below them follows.
   - The groups of the largest areas in the tree come first, and have cache sets of their own: at all further places of
     these sets are the groups of the smallest areas.
   docs/results/raytracer-tree.md has the measurements. */
#include "internal.h"

#include <stdlib.h>
#include <string.h>

#define LINE_BYTES 64

struct placing {
  const struct scene_tree *tree;
  const struct scene_order *order;
  double *areas;       /* of each node's box; after grouping, of a group's root: the sum over its nodes */
  uint32_t *sequence;  /* roots of groups in treelet order */
  unsigned char *done; /* of each group: whether it is in the sequence */
  uint32_t placed;
  uint32_t treelet; /* groups in one */
  const volatile int *interrupt;
};

static bool is_inner(const struct scene_tree *tree, uint32_t node) {
  return tree->nodes[node].triangle_count == 0;
}

static void measure_areas(double *areas, struct scene_box *boxes, const struct scene_tree *tree) {
  for (uint32_t i = tree->node_count; i-- > 0;) { /* children follow their parents */
    const struct scene_tree_node *node = &tree->nodes[i];
    boxes[i] = node->triangle_count ? node->box : scene_empty_box();
    for (int c = 0; c < 2 && !node->triangle_count; c++)
      scene_box_add_box(&boxes[i], &boxes[node->child[c]]);
    areas[i] = scene_half_area(boxes[i].min, boxes[i].max);
  }
}

/* --- groups --- */

/* The largest inner child of the group's nodes that is not in the group; 0 if there is none. */
static uint32_t largest_below(const struct scene_order *order, const struct scene_tree *tree, const double *areas,
                              uint32_t root) {
  uint32_t largest = 0;
  for (uint32_t node = root;; node = order->next[node]) {
    for (int c = 0; c < 2; c++) {
      uint32_t child = tree->nodes[node].child[c];
      if (is_inner(tree, child) && order->group[child] != root && (!largest || areas[child] > areas[largest]))
        largest = child;
    }
    if (!order->next[node])
      return largest;
  }
}

/* Parents come before their children, so a node without a group begins one. */
static void make_groups(const struct scene_order *order, const struct scene_tree *tree, double *areas,
                        uint32_t group_size) {
  uint32_t alone = 0; /* a group with room and without inner children; 0: none (the root, unless it is the only node) */
  for (uint32_t i = 0; i < tree->node_count; i++)
    order->group[i] = UINT32_MAX, order->next[i] = 0;
  for (uint32_t root = 0; root < tree->node_count; root++) {
    if (!is_inner(tree, root) || order->group[root] != UINT32_MAX)
      continue;
    order->group[root] = root;
    uint32_t last = root, size = 1;
    for (uint32_t node; size < group_size && (node = largest_below(order, tree, areas, root)) != 0; size++) {
      order->group[node] = root;
      order->next[last] = node;
      areas[root] += areas[node];
      last = node;
    }
    if (size < group_size && alone && size == 1) {
      order->group[root] = alone;
      order->next[alone] = root;
      areas[alone] += areas[root];
      alone = 0;
    } else if (size < group_size) {
      alone = root;
    }
  }
}

/* --- treelets --- */

/* Finds the groups below a group that are not in the sequence. */
static uint32_t groups_below(uint32_t below[], const struct placing *placing, uint32_t root) {
  const struct scene_order *order = placing->order;
  uint32_t count = 0;
  for (uint32_t node = root;; node = order->next[node]) {
    for (int c = 0; c < 2; c++) {
      uint32_t child = placing->tree->nodes[node].child[c];
      if (is_inner(placing->tree, child) && order->group[child] != root && !placing->done[order->group[child]])
        below[count++] = order->group[child];
    }
    if (!order->next[node])
      return count;
  }
}

enum { MOST_BELOW = 3 }; /* a group has two nodes at most */

/* Places the treelet at root and, recursively, those below it. Each level of recursion goes down at least one level of
   the tree. frontier has room for (MOST_BELOW - 1) * treelet + 1 groups for every level. */
static void place_treelets(struct placing *placing, uint32_t root, uint32_t *frontier) {
  if (scene_is_interrupted(placing->interrupt))
    return;
  uint32_t count = 1;
  frontier[0] = root;
  for (uint32_t taken = 0; taken < placing->treelet && count > 0;) {
    uint32_t largest = 0;
    for (uint32_t i = 1; i < count; i++)
      if (placing->areas[frontier[i]] > placing->areas[frontier[largest]])
        largest = i;
    uint32_t group = frontier[largest], below[MOST_BELOW], below_count = 0;
    if (!placing->done[group]) { /* it may be below two others */
      placing->done[group] = 1;
      placing->sequence[placing->placed++] = group;
      below_count = groups_below(below, placing, group);
      taken++;
    }
    /* The groups below it take its place in the frontier, which stays in depth-first order. */
    memmove(frontier + largest + below_count, frontier + largest + 1, (count - largest - 1) * sizeof *frontier);
    memcpy(frontier + largest, below, below_count * sizeof *frontier);
    count += below_count - 1;
  }
  for (uint32_t i = 0; i < count; i++)
    if (!placing->done[frontier[i]])
      place_treelets(placing, frontier[i], frontier + count);
}

/* --- lines --- */

/* Assigns a line to each group. Hot groups get the first lines, cold ones the lines that share the hot ones' sets, warm
   ones the others, each kind in treelet order. */
static void assign_lines(uint32_t *lines, const struct placing *placing, struct scene_ranking *ranked,
                         struct scene_ranking *room, uint32_t cache, uint32_t hot) {
  uint32_t count = 0;
  for (uint32_t i = 0; i < placing->tree->node_count; i++) /* equal ones in the order of the tree */
    if (placing->done[i]) {
      memcpy(&ranked->keys[count], &placing->areas[i], sizeof *ranked->keys);
      ranked->numbers[count++] = i;
    }
  scene_rank(ranked, room, count);
  uint32_t hot_count = count < hot ? count : hot, cold_count = 0;
  if (count > cache)
    cold_count = (count / cache - 1) * hot + (count % cache < hot ? count % cache : hot);
  enum { warm_kind, hot_kind, cold_kind };
  /* at first, lines has the kinds of groups */
  for (uint32_t i = 0; i < count; i++)
    lines[ranked->numbers[i]] = i < hot_count ? hot_kind : i >= count - cold_count ? cold_kind : warm_kind;
  uint32_t next_hot = 0, next_cold = cache, next_warm = hot_count;
  for (uint32_t i = 0; i < count; i++) {
    uint32_t *line = &lines[placing->sequence[i]];
    switch (*line) {
    case hot_kind:
      *line = next_hot++;
      break;
    case cold_kind:
      *line = next_cold++;
      if (next_cold % cache == hot)
        next_cold += cache - hot;
      break;
    default:
      *line = next_warm++;
      if (next_warm % cache == 0)
        next_warm += hot;
    }
  }
}

/* Converts the lines of groups, at their roots, to positions of nodes. A group that is not full gets the last line, so
   that no record stays empty. */
static void assign_positions(const struct placing *placing, uint32_t group_size) {
  const struct scene_order *order = placing->order;
  uint32_t *position = order->position, last = 0, short_one = UINT32_MAX;
  for (uint32_t i = 0; i < placing->placed; i++) {
    uint32_t root = placing->sequence[i], size = 1;
    for (uint32_t node = root; order->next[node]; node = order->next[node])
      size++;
    if (size < group_size)
      short_one = root;
    if (position[root] > position[last])
      last = root;
  }
  if (short_one != UINT32_MAX) {
    uint32_t line = position[short_one];
    position[short_one] = position[last];
    position[last] = line;
  }
  for (uint32_t i = 0; i < placing->placed; i++) {
    uint32_t root = placing->sequence[i], at = position[root] * group_size;
    for (uint32_t node = root;; node = order->next[node]) {
      position[node] = at++;
      if (!order->next[node])
        break;
    }
  }
}

trax_status scene_order_nodes(struct scene_order *order, const struct scene_tree *tree, enum trax_node_layout layout,
                              uint32_t cache_lines, const volatile int *interrupt, trax_error *error) {
  const size_t count = tree->node_count;
  const uint32_t bytes = trax_node_formats[layout].bytes, group_size = bytes < LINE_BYTES ? LINE_BYTES / bytes : 1;
  *order = (struct scene_order){malloc((count + 1) * sizeof(uint32_t)), malloc((count + 1) * sizeof(uint32_t)),
                                malloc((count + 1) * sizeof(uint32_t))};
  const bool depth_first = cache_lines < 8 || tree->inner_count == 0;
  cache_lines = cache_lines * LINE_BYTES / (group_size * bytes); /* from here on in groups */
  struct placing placing = {.tree = tree, .order = order, .treelet = cache_lines / 2, .interrupt = interrupt};
  const size_t frontier_size = (MOST_BELOW - 1) * (size_t)placing.treelet + 1;
  placing.areas = malloc((count + 1) * sizeof *placing.areas);
  placing.sequence = malloc((count + 1) * sizeof *placing.sequence);
  placing.done = calloc(count + 1, 1);
  struct scene_box *boxes = malloc((count + 1) * sizeof *boxes);
  uint64_t *keys = malloc((tree->inner_count + (size_t)1) * 2 * sizeof *keys);
  uint32_t *numbers = malloc((tree->inner_count + (size_t)1) * 2 * sizeof *numbers);
  uint32_t *frontier = malloc((tree->max_depth + (size_t)1) * frontier_size * sizeof *frontier);
  trax_status result = TRAX_OK;
  if (!order->position || !order->group || !order->next || !placing.areas || !placing.sequence || !placing.done ||
      !boxes || !keys || !numbers || !frontier) {
    result = scene_out_of_memory(error, "BVH");
    scene_order_release(order);
  } else if (depth_first) {
    for (uint32_t i = 0, inner = 0; i < count; i++)
      order->position[i] = is_inner(tree, i) ? inner++ : 0;
  } else {
    measure_areas(placing.areas, boxes, tree);
    make_groups(order, tree, placing.areas, group_size);
    place_treelets(&placing, 0, frontier);
    if (!scene_is_interrupted(interrupt)) {
      struct scene_ranking ranked = {keys, numbers}, room = {keys + tree->inner_count, numbers + tree->inner_count};
      assign_lines(order->position, &placing, &ranked, &room, cache_lines, cache_lines / 4);
      assign_positions(&placing, group_size);
    }
  }
  if (result == TRAX_OK && scene_is_interrupted(interrupt)) {
    result = TRAX_INTERRUPTED;
    scene_order_release(order);
  }
  free(placing.areas);
  free(placing.sequence);
  free(placing.done);
  free(boxes);
  free(keys);
  free(numbers);
  free(frontier);
  return result;
}

void scene_order_release(struct scene_order *order) {
  free(order->position);
  free(order->group);
  free(order->next);
  *order = (struct scene_order){0};
}
