/* The search for the best place of a part of the tree. */
#include "reinsert.h"

#include <stdlib.h>

/* --- the heap --- */

static bool comes_before(const struct place *a, const struct place *b) {
  return a->least != b->least ? a->least < b->least : a->node < b->node;
}

static void push(struct search *search, struct place place) {
  __builtin_prefetch(&search->links->nodes[place.node]);
  size_t at = search->heap_count++;
  for (; at > 0 && comes_before(&place, &search->heap[(at - 1) / 2]); at = (at - 1) / 2)
    search->heap[at] = search->heap[(at - 1) / 2];
  search->heap[at] = place;
}

static struct place pop(struct search *search) {
  const struct place least = search->heap[0], last = search->heap[--search->heap_count];
  size_t at = 0;
  for (size_t child; (child = 2 * at + 1) < search->heap_count; at = child) {
    if (child + 1 < search->heap_count && comes_before(&search->heap[child + 1], &search->heap[child]))
      child++;
    if (!comes_before(&search->heap[child], &last))
      break;
    search->heap[at] = search->heap[child];
  }
  search->heap[at] = last;
  return least;
}

/* --- the tree without the part --- */

static bool note(struct search *search, uint32_t node) {
  if (!search->records)
    return true;
  if (search->read_count == search->read_capacity) {
    const size_t capacity = 2 * search->read_capacity + 256;
    uint32_t *read = realloc(search->read, capacity * sizeof *read);
    if (!read)
      return false;
    search->read = read, search->read_capacity = capacity;
  }
  search->read[search->read_count++] = node;
  return true;
}

/* Takes the part out. False when out of memory. */
static bool take_out(struct search *search, uint32_t part) {
  const struct scene_link *nodes = search->links->nodes;
  search->part = &nodes[part];
  search->parent = nodes[part].parent;
  const struct scene_link *parent = &nodes[search->parent];
  search->beside = parent->child[parent->child[0] == part];
  search->depth = 0;
  for (uint32_t node = parent->parent; node != SCENE_NO_LINK; node = nodes[node].parent)
    search->depth++;
  if (!note(search, part) || !note(search, search->parent) || !note(search, search->beside))
    return false;
  struct scene_box below = nodes[search->beside].box;
  uint32_t height = nodes[search->beside].height, from = search->parent, node = parent->parent;
  bool same = false;
  for (uint32_t i = search->depth; i-- > 0; from = node, node = nodes[node].parent) {
    const struct scene_link *link = &nodes[node];
    struct above *above = &search->above[i];
    *above = (struct above){node, link->height, link->box, link->visits};
    if (!note(search, node))
      return false;
    if (same)
      continue;
    const uint32_t other = link->child[link->child[0] == from];
    if (!note(search, other))
      return false;
    const struct scene_box box = join_boxes(&below, &nodes[other].box);
    above->height = 1 + (height > nodes[other].height ? height : nodes[other].height);
    bool moved = false;
    for (int axis = 0; axis < 3; axis++)
      moved |= (box.min[axis] != link->box.min[axis]) | (box.max[axis] != link->box.max[axis]);
    if (moved)
      above->box = box, above->visits = visits_of(search->foci, &box);
    same = !moved && above->height == link->height;
    below = above->box, height = above->height;
  }
  return true;
}

/* The cost of the part if it is inserted beside a node: of a new node over both, and of the growth of the nodes above.
   least: that growth. */
static inline double cost_beside(const struct search *search, const struct scene_box *box, double least) {
  const struct scene_box both = join_boxes(&search->part->box, box);
  return least + visits_of(search->foci, &both);
}

/* Whether some place costs less than the part's own. As the limit does not fall meanwhile, the order in which the nodes
   are looked at does not matter. Also true if there are too many to be sure. */
static bool may_gain(struct search *search, const double *least, double limit) {
  const struct scene_link *nodes = search->links->nodes;
  const double own = search->part->visits;
  struct place *queue = search->queue;
  uint32_t first = 0, end = 0; /* first in, first out: nodes are in the cache when they are looked at */
  for (uint32_t i = 0; i <= search->depth && least[i + 1] + own < limit; i++) {
    /* The other children of the nodes above, and those of the sibling. */
    const struct scene_link *node = &nodes[i < search->depth ? search->above[i].node : search->beside];
    const uint32_t skipped = i == search->depth      ? SCENE_NO_LINK
                             : i + 1 < search->depth ? search->above[i + 1].node
                                                     : search->parent;
    for (int c = 0; c < 2 && node->child[0] != SCENE_NO_LINK; c++)
      if (node->child[c] != skipped) {
        __builtin_prefetch(&nodes[node->child[c]]);
        queue[end++] = (struct place){least[i + 1], node->child[c], 0};
      }
  }
  while (first < end) {
    const struct place place = queue[first++];
    const struct scene_link *node = &nodes[place.node];
    if (first > MOST_LOOKED_AT - TRAX_SCENE_MAX_DEPTH || !note(search, place.node))
      return true;
    const bool leaf = node->child[0] == SCENE_NO_LINK;
    if (leaf && place.least + node->visits >= limit)
      continue;
    const double cost = cost_beside(search, &node->box, place.least);
    if (cost < limit)
      return true;
    const double below = cost - node->visits;
    for (int c = 0; c < 2 && !leaf && below + own < limit; c++) {
      __builtin_prefetch(&nodes[node->child[c]]);
      queue[end++] = (struct place){below, node->child[c], 0};
    }
  }
  return false;
}

/* Branch and bound: below a node, the part costs at least the growth of the boxes above and a node of its own size. */
static uint32_t find_best(struct search *search, double best_cost) {
  const struct scene_link *nodes = search->links->nodes;
  const double own = search->part->visits;
  uint32_t best = search->beside;
  search->heap_count = 0;
  push(search, (struct place){0, search->depth ? search->above[0].node : search->beside, 0});
  for (int looked_at = 0; looked_at < MOST_LOOKED_AT && search->heap_count; looked_at++) {
    const struct place place = pop(search);
    if (place.least + own >= best_cost)
      break;
    const struct scene_link *node = &nodes[place.node];
    const bool changed = place.depth < search->depth && search->above[place.depth].node == place.node;
    const struct above *above = &search->above[place.depth];
    const uint32_t own_height = changed ? above->height : node->height;
    const double cost = cost_beside(search, changed ? &above->box : &node->box, place.least);
    const uint32_t height = own_height > search->part->height ? own_height : search->part->height;
    if (cost < best_cost && place.depth + 1 + height <= search->links->max_depth)
      best_cost = cost, best = place.node;
    if (!note(search, place.node))
      return SCENE_NO_LINK;
    if (node->child[0] == SCENE_NO_LINK)
      continue;
    const double below = cost - (changed ? above->visits : node->visits);
    for (int i = 0; i < 2 && below + own < best_cost; i++) {
      const uint32_t child = node->child[i] == search->parent ? search->beside : node->child[i];
      push(search, (struct place){below, child, place.depth + 1});
    }
  }
  return best;
}

uint32_t scene_find_place(struct search *search, uint32_t part) {
  double least[TRAX_SCENE_MAX_DEPTH + 3], limit;
  bool cheaper = false;
  if (!take_out(search, part))
    return SCENE_NO_LINK;
  /* least[i]: of the node at depth i on the way to the sibling; the sibling's cost is the limit. */
  double costs[TRAX_SCENE_MAX_DEPTH + 1];
  least[0] = 0;
  for (uint32_t i = 0; i < search->depth; i++) {
    costs[i] = cost_beside(search, &search->above[i].box, least[i]);
    least[i + 1] = costs[i] - search->above[i].visits;
  }
  const struct scene_link *beside = &search->links->nodes[search->beside];
  limit = cost_beside(search, &beside->box, least[search->depth]);
  least[search->depth + 1] = limit - beside->visits;
  for (uint32_t i = 0; i < search->depth; i++)
    cheaper |= costs[i] < limit;
  return cheaper || may_gain(search, least, limit) ? find_best(search, limit) : search->beside;
}
