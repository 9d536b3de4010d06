/* One subtree after another is removed and inserted where it costs least: the definition of scene_reinsert. */
#include "plain_reinsert.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_FOCI = 8, FOCUS_STEP = 4, LEAST_OF_TRIANGLES = 16 };

/* Limits a search in trees with many overlapping boxes. */
enum { MOST_LOOKED_AT = 1000 };

struct place {
  double least; /* the cost that the part adds to the nodes above, if it is inserted beside or below this node */
  uint32_t node, depth;
};

/* The foci as columns, so that the compiler takes several at once. Those beyond `count` are zero. */
struct foci {
  int count;
  double min[3][MOST_FOCI], max[3][MOST_FOCI];
  double scale[MOST_FOCI]; /* the reciprocal of a box's half area */
};

struct search {
  struct scene_links *links;
  struct foci foci;
  struct place *heap; /* the least first */
  size_t heap_count, heap_capacity;
};

static inline double least_of(double a, double b) {
  return a < b ? a : b;
}

/* Expected visits to a node with this box. */
static double visits(const struct foci *foci, const struct scene_box *box) {
  double parts[MOST_FOCI], sum = 0;
  /* Without branches: what does not meet a focus is multiplied by 0. */
  for (int i = 0; i < MOST_FOCI; i++) {
    double size[3];
    for (int axis = 0; axis < 3; axis++) {
      const double min = box->min[axis], max = box->max[axis];
      size[axis] = least_of(max, foci->max[axis][i]) - (min > foci->min[axis][i] ? min : foci->min[axis][i]);
    }
    const double inside = least_of(size[0], least_of(size[1], size[2])) >= 0;
    parts[i] = foci->scale[i] * (size[0] * size[1] + size[1] * size[2] + size[2] * size[0]) * inside;
  }
  for (int i = 0; i < MOST_FOCI; i++) /* in this order on every host */
    sum += parts[i];
  return sum;
}

static void choose_foci(struct search *search) {
  const struct scene_link *nodes = search->links->nodes, *node = &nodes[search->links->root];
  const uint32_t least = node->triangles / LEAST_OF_TRIANGLES;
  struct foci *foci = &search->foci;
  double last = __builtin_inf();
  while (node->child[0] != SCENE_NO_LINK && node->triangles >= least && foci->count < MOST_FOCI) {
    const double area = scene_half_area(node->box.min, node->box.max);
    if (area > 0 && area * FOCUS_STEP <= last) {
      for (int axis = 0; axis < 3; axis++) {
        foci->min[axis][foci->count] = node->box.min[axis];
        foci->max[axis][foci->count] = node->box.max[axis];
      }
      foci->scale[foci->count++] = 1 / area;
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

/* --- the heap --- */

static bool comes_before(const struct place *a, const struct place *b) {
  return a->least != b->least ? a->least < b->least : a->node < b->node;
}

/* False when out of memory. */
static bool push(struct search *search, struct place place) {
  if (search->heap_count == search->heap_capacity) {
    const size_t capacity = 2 * search->heap_capacity + 256;
    struct place *heap = realloc(search->heap, capacity * sizeof *heap);
    if (!heap)
      return false;
    search->heap = heap, search->heap_capacity = capacity;
  }
  __builtin_prefetch(&search->links->nodes[place.node]);
  size_t at = search->heap_count++;
  for (; at > 0 && comes_before(&place, &search->heap[(at - 1) / 2]); at = (at - 1) / 2)
    search->heap[at] = search->heap[(at - 1) / 2];
  search->heap[at] = place;
  return true;
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

/* --- the tree --- */

/* Refits the box and height of a node. Returns whether they changed. */
static bool refit_node(const struct search *search, uint32_t index) {
  struct scene_link *node = &search->links->nodes[index];
  const struct scene_link *a = &search->links->nodes[node->child[0]], *b = &search->links->nodes[node->child[1]];
  const struct scene_box box = join(&a->box, &b->box);
  const uint32_t height = 1 + (a->height > b->height ? a->height : b->height);
  const bool moved = memcmp(&box, &node->box, sizeof box) != 0;
  if (!moved && height == node->height)
    return false;
  node->height = height;
  if (moved) {
    node->box = box;
    node->visits = visits(&search->foci, &box);
  }
  return true;
}

/* Refits from here up to the root, or to the first node that stays as it is. */
static void refit_from(const struct search *search, uint32_t index) {
  while (index != SCENE_NO_LINK && refit_node(search, index))
    index = search->links->nodes[index].parent;
}

/* Makes `new` the child of old's parent, or the root if old is that. */
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
  return least + visits(&search->foci, &both);
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

/* Finds the node beside which the removed part costs least: `now` if no other is better; SCENE_NO_LINK when out of
   memory. Branch and bound: below a node, the part costs at least the growth of the boxes above and a node of its own
   size. */
static uint32_t find_place(struct search *search, const struct scene_link *part, uint32_t now) {
  const struct scene_links *links = search->links;
  const double own = part->visits;
  double best_cost = cost_at(search, &part->box, now);
  uint32_t best = now;
  search->heap_count = 0;
  if (!push(search, (struct place){0, links->root, 0}))
    return SCENE_NO_LINK;
  for (int looked_at = 0; looked_at < MOST_LOOKED_AT && search->heap_count; looked_at++) {
    const struct place place = pop(search);
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
      if (!push(search, (struct place){below, node->child[i], place.depth + 1}))
        return SCENE_NO_LINK;
  }
  return best;
}

/* Removes the part with its parent, whose other child takes the parent's place, and reinserts it. False when out of
   memory. */
static bool reinsert(struct search *search, uint32_t part) {
  struct scene_links *links = search->links;
  struct scene_link *nodes = links->nodes;
  const uint32_t parent = nodes[part].parent, beside = nodes[parent].child[nodes[parent].child[0] == part];
  take_place_of(links, beside, parent);
  refit_from(search, nodes[beside].parent);
  const uint32_t place = find_place(search, &nodes[part], beside);
  if (place == SCENE_NO_LINK)
    return false;
  take_place_of(links, parent, place);
  nodes[parent].child[0] = place, nodes[parent].child[1] = part;
  nodes[place].parent = parent;
  refit_node(search, parent);
  refit_from(search, nodes[parent].parent);
  return true;
}

struct ranked {
  double visits;
  uint32_t node;
};

static int compare_ranked(const void *a, const void *b) {
  const struct ranked *left = a, *right = b;
  if (left->visits != right->visits)
    return left->visits > right->visits ? -1 : 1;
  return left->node < right->node ? -1 : left->node > right->node;
}

bool plain_reinsert(struct scene_links *links, unsigned passes) {
  struct search search = {.links = links};
  struct ranked *ranked = malloc(links->count * sizeof *ranked);
  choose_foci(&search);
  if (search.foci.count == 0)
    passes = 0;
  for (uint32_t i = 0; i < links->count; i++)
    links->nodes[i].visits = visits(&search.foci, &links->nodes[i].box);
  bool good = ranked;
  for (unsigned pass = 0; pass < passes && good; pass++) {
    for (uint32_t i = 0; i < links->count; i++)
      ranked[i] = (struct ranked){links->nodes[i].visits, i};
    qsort(ranked, links->count, sizeof *ranked, compare_ranked);
    for (uint32_t i = 0; i < links->count && good; i++)
      good = ranked[i].node == links->root || reinsert(&search, ranked[i].node);
  }
  free(ranked);
  free(search.heap);
  return good;
}
