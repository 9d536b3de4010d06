/* One subtree after another is removed and inserted where it costs least: the definition of scene_reinsert. */
#include "plain_reinsert.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_FOCI = 8, FOCUS_STEP = 4, LEAST_OF_TRIANGLES = 16 };

/* Limits a search in trees with many overlapping boxes. */
enum { MOST_LOOKED_AT = 1000 };

struct place {
  double least; /* the cost that the part adds to the nodes above, if it is inserted beside or below this node */
  uint32_t node, depth;
};

struct focus {
  struct scene_box box;
  double scale; /* the reciprocal of the box's half area */
};

struct search {
  struct scene_links *links;
  struct focus foci[MOST_FOCI];
  int focus_count;
  struct place open[2 * MOST_LOOKED_AT + 1]; /* the least last */
  size_t open_count;
};

/* Expected visits to a node with this box. */
static double visits(const struct search *search, const struct scene_box *box) {
  double sum = 0;
  for (int i = 0; i < search->focus_count; i++) {
    const struct focus *focus = &search->foci[i];
    double size[3];
    for (int axis = 0; axis < 3; axis++)
      size[axis] = fmin(box->max[axis], focus->box.max[axis]) - fmax(box->min[axis], focus->box.min[axis]);
    if (size[0] >= 0 && size[1] >= 0 && size[2] >= 0)
      sum += focus->scale * (size[0] * size[1] + size[1] * size[2] + size[2] * size[0]);
  }
  return sum;
}

static void choose_foci(struct search *search) {
  const struct scene_link *nodes = search->links->nodes, *node = &nodes[search->links->root];
  const uint32_t least = node->triangles / LEAST_OF_TRIANGLES;
  double last = __builtin_inf();
  while (node->child[0] != SCENE_NO_LINK && node->triangles >= least && search->focus_count < MOST_FOCI) {
    const double area = scene_half_area(node->box.min, node->box.max);
    if (area > 0 && area * FOCUS_STEP <= last) {
      search->foci[search->focus_count++] = (struct focus){node->box, 1 / area};
      last = area;
    }
    const struct scene_link *a = &nodes[node->child[0]], *b = &nodes[node->child[1]];
    node = b->triangles > a->triangles ? b : a;
  }
}

static struct scene_box join(const struct scene_box *a, const struct scene_box *b) {
  struct scene_box both = *a;
  scene_box_add_box(&both, b);
  return both;
}

static bool comes_before(const struct place *a, const struct place *b) {
  return a->least != b->least ? a->least < b->least : a->node < b->node;
}

static void put(struct search *search, struct place place) {
  size_t at = search->open_count++;
  for (; at > 0 && comes_before(&search->open[at - 1], &place); at--)
    search->open[at] = search->open[at - 1];
  search->open[at] = place;
}

/* --- the tree --- */

/* Refits this node and those above. */
static void refit_from(const struct search *search, uint32_t index) {
  for (; index != SCENE_NO_LINK; index = search->links->nodes[index].parent) {
    struct scene_link *node = &search->links->nodes[index];
    const struct scene_link *a = &search->links->nodes[node->child[0]], *b = &search->links->nodes[node->child[1]];
    node->box = join(&a->box, &b->box);
    node->height = 1 + (a->height > b->height ? a->height : b->height);
    node->visits = visits(search, &node->box);
  }
}

/* Makes the node the child of old's parent, or the root if old is that. */
static void take_place_of(struct scene_links *links, uint32_t index, uint32_t old) {
  const uint32_t parent = links->nodes[old].parent;
  links->nodes[index].parent = parent;
  if (parent == SCENE_NO_LINK)
    links->root = index;
  else
    links->nodes[parent].child[links->nodes[parent].child[1] == old] = index;
}

/* The cost of the part if it is inserted beside `node`: of a new node over both, and of the growth of the nodes above.
   least: the growth of the nodes above `node`. */
static double cost_beside(const struct search *search, const struct scene_box *part, const struct scene_box *node,
                          double least) {
  const struct scene_box both = join(part, node);
  return least + visits(search, &both);
}

static double cost_at(const struct search *search, const struct scene_box *part, uint32_t place) {
  const struct scene_link *nodes = search->links->nodes;
  uint32_t above[TRAX_SCENE_MAX_DEPTH];
  int count = 0;
  for (uint32_t node = nodes[place].parent; node != SCENE_NO_LINK; node = nodes[node].parent)
    above[count++] = node;
  double least = 0;
  while (count-- > 0) {
    const struct scene_link *node = &nodes[above[count]];
    least = cost_beside(search, part, &node->box, least) - node->visits;
  }
  return cost_beside(search, part, &nodes[place].box, least);
}

/* Finds the node beside which the removed part costs least: `now` if no other is better. Branch and bound: below
   a node, the part costs at least the growth of the boxes above and a node of its own size. */
static uint32_t find_place(struct search *search, const struct scene_link *part, uint32_t now) {
  const struct scene_links *links = search->links;
  const double own = part->visits;
  double best_cost = cost_at(search, &part->box, now);
  uint32_t best = now;
  search->open_count = 0;
  put(search, (struct place){0, links->root, 0});
  for (int looked_at = 0; looked_at < MOST_LOOKED_AT && search->open_count; looked_at++) {
    const struct place place = search->open[--search->open_count];
    if (place.least + own >= best_cost)
      break;
    const struct scene_link *node = &links->nodes[place.node];
    const double cost = cost_beside(search, &part->box, &node->box, place.least);
    const uint32_t height = node->height > part->height ? node->height : part->height;
    if (cost < best_cost && place.depth + 1 + height <= links->max_depth)
      best_cost = cost, best = place.node;
    if (node->child[0] == SCENE_NO_LINK)
      continue;
    const double below = cost - node->visits;
    for (int i = 0; i < 2 && below + own < best_cost; i++)
      put(search, (struct place){below, node->child[i], place.depth + 1});
  }
  return best;
}

/* Removes the part with its parent, whose other child takes the parent's place, and reinserts it. */
static void reinsert(struct search *search, uint32_t part) {
  struct scene_links *links = search->links;
  struct scene_link *nodes = links->nodes;
  const uint32_t parent = nodes[part].parent, beside = nodes[parent].child[nodes[parent].child[0] == part];
  take_place_of(links, beside, parent);
  refit_from(search, nodes[beside].parent);
  const uint32_t place = find_place(search, &nodes[part], beside);
  take_place_of(links, parent, place);
  nodes[parent].child[0] = place, nodes[parent].child[1] = part;
  nodes[place].parent = parent;
  refit_from(search, parent);
}

int compare_ranks(const void *a, const void *b) {
  const struct rank *left = a, *right = b;
  if (left->value != right->value)
    return left->value > right->value ? -1 : 1;
  return left->number < right->number ? -1 : left->number > right->number;
}

bool plain_reinsert(struct scene_links *links, unsigned passes) {
  struct search search = {.links = links};
  struct rank *ranked = malloc(links->count * sizeof *ranked);
  if (!ranked)
    return false;
  choose_foci(&search);
  for (uint32_t i = 0; i < links->count; i++)
    links->nodes[i].visits = visits(&search, &links->nodes[i].box);
  for (unsigned pass = 0; pass < passes && search.focus_count; pass++) {
    for (uint32_t i = 0; i < links->count; i++)
      ranked[i] = (struct rank){links->nodes[i].visits, i};
    qsort(ranked, links->count, sizeof *ranked, compare_ranks);
    for (uint32_t i = 0; i < links->count; i++)
      if (ranked[i].number != links->root)
        reinsert(&search, ranked[i].number);
  }
  free(ranked);
  return true;
}
