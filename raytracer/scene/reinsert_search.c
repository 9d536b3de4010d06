/* The search for the best place of a part of the tree. */
#include "reinsert.h"

#include <stdlib.h>
#include <string.h>

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

/* --- the nodes that a search depends on --- */

/* Makes room for those of one search. False when out of memory. */
static bool reserve(struct search *search) {
  enum { MOST_OF_ONE = 2 * MOST_LOOKED_AT + 2 * TRAX_SCENE_MAX_DEPTH + 8 };
  if (search->read_capacity - search->read_count >= MOST_OF_ONE)
    return true;
  const size_t capacity = 2 * search->read_capacity + MOST_OF_ONE;
  uint32_t *read = realloc(search->read, capacity * sizeof *read);
  if (!read)
    return false;
  search->read = read, search->read_capacity = capacity;
  return true;
}

static inline void note(struct search *search, uint32_t node) {
  search->read[search->read_count++] = node;
}

static void note_part(struct search *search, uint32_t part) {
  note(search, part);
  note(search, search->parent);
  note(search, search->beside);
}

static inline uint32_t other_child(const struct scene_link *node, uint32_t child) {
  return node->child[node->child[0] == child];
}

/* The cost of the part if it is inserted beside a node: of a new node over both, and of the growth of the nodes above.
   least: that growth. */
static inline double cost_beside(const struct search *search, const struct scene_box *box, double least) {
  const struct scene_box both = scene_join_boxes(&search->part->box, box);
  return least + visits_of(search->foci, &both);
}

/* --- whether there is a better place --- */

enum { AT_ONCE = 4 };

/* Lower bounds of the expected visits to nodes around the part and each of these, in binary32: rounding and underflow
   together take less than the two constants. */
static inline void least_visits(double bounds[AT_ONCE], const struct foci *foci, const struct scene_box *part,
                                const struct scene_link *const links[AT_ONCE]) {
  __m128 low[AT_ONCE], high[AT_ONCE], sum = _mm_setzero_ps();
  for (int i = 0; i < AT_ONCE; i++) {
    low[i] = _mm_loadu_ps(links[i]->box.min);
    high[i] = _mm_loadu_ps(links[i]->box.max);
  }
  _MM_TRANSPOSE4_PS(low[0], low[1], low[2], low[3]); /* to three axes, and what stands behind */
  _MM_TRANSPOSE4_PS(high[0], high[1], high[2], high[3]);
  for (int axis = 0; axis < 3; axis++) {
    low[axis] = _mm_min_ps(low[axis], _mm_set1_ps(part->min[axis]));
    high[axis] = _mm_max_ps(high[axis], _mm_set1_ps(part->max[axis]));
  }
  for (int i = 0; i < foci->count; i++) {
    __m128 size[3];
    for (int axis = 0; axis < 3; axis++)
      size[axis] = _mm_sub_ps(_mm_min_ps(high[axis], foci->coarse_max[i][axis]),
                              _mm_max_ps(low[axis], foci->coarse_min[i][axis]));
    const __m128 inside = _mm_cmpge_ps(_mm_min_ps(size[0], _mm_min_ps(size[1], size[2])), _mm_setzero_ps());
    const __m128 area = _mm_add_ps(_mm_mul_ps(size[0], _mm_add_ps(size[1], size[2])), _mm_mul_ps(size[1], size[2]));
    sum = _mm_add_ps(sum, _mm_and_ps(_mm_mul_ps(foci->coarse_scale[i], area), inside));
  }
  const __m128d factor = _mm_set1_pd(1 - 0x1p-19), underflow = _mm_set1_pd(foci->underflow);
  _mm_storeu_pd(bounds, _mm_sub_pd(_mm_mul_pd(_mm_cvtps_pd(sum), factor), underflow));
  _mm_storeu_pd(bounds + 2, _mm_sub_pd(_mm_mul_pd(_mm_cvtps_pd(_mm_movehl_ps(sum, sum)), factor), underflow));
}

/* False: no place costs less than the part's own. True for nearly all parts that have a better one, and for few others:
   as its limit does not fall meanwhile, the order in which nodes are looked at does not matter, and lower bounds do. */
static bool may_gain(struct search *search) {
  const struct scene_link *nodes = search->links->nodes, *part = search->part;
  struct place *queue = search->queue;
  uint32_t *read = search->read + search->read_count;
  uint32_t first = 0, end = 0; /* first in, first out: nodes are in the cache when they are looked at */
  /* The nodes above whose boxes are smaller without the part, from below. */
  struct {
    struct scene_box box;
    uint32_t other; /* the child that is not on the way */
  } open[TRAX_SCENE_MAX_DEPTH + 1];
  uint32_t open_count = 0, from = search->parent, node = nodes[from].parent;
  const __m128 part_min = _mm_loadu_ps(part->box.min), part_max = _mm_loadu_ps(part->box.max);
  __m128 min = _mm_loadu_ps(nodes[search->beside].box.min), max = _mm_loadu_ps(nodes[search->beside].box.max);
  for (; node != SCENE_NO_LINK; from = node, node = nodes[node].parent) {
    const uint32_t other = other_child(&nodes[node], from);
    *read++ = node, *read++ = other;
    min = _mm_min_ps(min, _mm_loadu_ps(nodes[other].box.min)); /* the fourth numbers count for nothing */
    max = _mm_max_ps(max, _mm_loadu_ps(nodes[other].box.max));
    const __m128 within = _mm_and_ps(_mm_cmple_ps(min, part_min), _mm_cmpge_ps(max, part_max));
    if ((_mm_movemask_ps(within) & 7) == 7)
      break;
    float below[2][4];
    _mm_storeu_ps(below[0], min), _mm_storeu_ps(below[1], max);
    memcpy(open[open_count].box.min, below[0], sizeof open->box.min);
    memcpy(open[open_count].box.max, below[1], sizeof open->box.max);
    open[open_count++].other = other;
  }
  const struct scene_link *whole = node != SCENE_NO_LINK ? &nodes[node] : NULL;
  double least = 0, least_of[TRAX_SCENE_MAX_DEPTH + 1], cheapest = whole ? whole->visits : __builtin_inf();
  for (uint32_t i = open_count; i-- > 0;) {
    const double cost = cost_beside(search, &open[i].box, least);
    cheapest = cost < cheapest ? cost : cheapest;
    least = cost - visits_of(search->foci, &open[i].box);
    least_of[i] = least;
  }
  const struct scene_link *beside = &nodes[search->beside];
  const double own = part->visits, limit = cost_beside(search, &beside->box, least);
  if (cheapest < limit)
    return true;
  for (uint32_t i = open_count; own < limit && i-- > 0 && least_of[i] + own < limit;)
    queue[end++] = (struct place){least_of[i], open[i].other, 0};
  least = limit - beside->visits;
  for (int c = 0; c < 2 && own < limit && beside->child[0] != SCENE_NO_LINK && least + own < limit; c++)
    queue[end++] = (struct place){least, beside->child[c], 0};
  const __m128d all_own = _mm_set1_pd(own), all_limit = _mm_set1_pd(limit);
  while (own < limit) {
    for (int i = 0; i < AT_ONCE && node != SCENE_NO_LINK; i++, from = node, node = nodes[node].parent) {
      *read++ = node;
      queue[end++] = (struct place){0, other_child(&nodes[node], from), 0};
    }
    if (first == end)
      break;
    if (first > MOST_LOOKED_AT - TRAX_SCENE_MAX_DEPTH - AT_ONCE)
      return true;
    while (end - first < AT_ONCE) /* what gains nothing */
      queue[end++] = (struct place){__builtin_inf(), search->parent, 0};
    const struct scene_link *links[AT_ONCE];
    double bounds[AT_ONCE], further[AT_ONCE];
    int gains = 0, grows = 0;
    for (int i = 0; i < AT_ONCE; i++)
      links[i] = &nodes[queue[first + i].node];
    least_visits(bounds, search->foci, &part->box, links);
    for (int i = 0; i < AT_ONCE; i += 2) {
      const __m128d above = _mm_set_pd(queue[first + i + 1].least, queue[first + i].least);
      const __m128d cost = _mm_add_pd(above, _mm_loadu_pd(&bounds[i]));
      const __m128d under = _mm_max_pd(_mm_sub_pd(cost, _mm_set_pd(links[i + 1]->visits, links[i]->visits)), above);
      gains |= _mm_movemask_pd(_mm_cmplt_pd(cost, all_limit));
      grows |= _mm_movemask_pd(_mm_cmplt_pd(_mm_add_pd(under, all_own), all_limit)) << i;
      _mm_storeu_pd(&further[i], under);
    }
    if (gains)
      return true;
    for (int i = 0; i < AT_ONCE; i++)
      *read++ = queue[first + i].node;
    for (int i = 0; i < AT_ONCE; i++)
      if (grows >> i & 1 && links[i]->child[0] != SCENE_NO_LINK)
        for (int c = 0; c < 2; c++) {
          __builtin_prefetch(&nodes[links[i]->child[c]]);
          queue[end++] = (struct place){further[i], links[i]->child[c], 0};
        }
    first += AT_ONCE;
  }
  search->read_count = (size_t)(read - search->read);
  return false;
}

/* --- the best place --- */

/* Takes the part out. */
static void take_out(struct search *search) {
  const struct scene_link *nodes = search->links->nodes;
  const uint32_t last = nodes[search->parent].parent;
  search->depth = 0;
  for (uint32_t node = last; node != SCENE_NO_LINK; node = nodes[node].parent)
    search->depth++;
  struct scene_box below = nodes[search->beside].box;
  uint32_t height = nodes[search->beside].height, from = search->parent, node = last;
  bool same = false;
  for (uint32_t i = search->depth; i-- > 0; from = node, node = nodes[node].parent) {
    const struct scene_link *link = &nodes[node];
    struct above *above = &search->above[i];
    *above = (struct above){node, link->height, link->box, link->visits};
    note(search, node);
    if (same)
      continue;
    const uint32_t other = other_child(link, from);
    note(search, other);
    const struct scene_box box = scene_join_boxes(&below, &nodes[other].box);
    above->height = 1 + (height > nodes[other].height ? height : nodes[other].height);
    bool moved = false;
    for (int axis = 0; axis < 3; axis++)
      moved |= (box.min[axis] != link->box.min[axis]) | (box.max[axis] != link->box.max[axis]);
    if (moved)
      above->box = box, above->visits = visits_of(search->foci, &box);
    same = !moved && above->height == link->height;
    below = above->box, height = above->height;
  }
}

/* The cost of the place that the part has. */
static double own_cost(const struct search *search) {
  double least = 0;
  for (uint32_t i = 0; i < search->depth; i++)
    least = cost_beside(search, &search->above[i].box, least) - search->above[i].visits;
  return cost_beside(search, &search->links->nodes[search->beside].box, least);
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
    note(search, place.node);
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
  const struct scene_link *nodes = search->links->nodes;
  if (!reserve(search))
    return SCENE_NO_LINK;
  search->part = &nodes[part];
  search->parent = nodes[part].parent;
  search->beside = other_child(&nodes[search->parent], part);
  const size_t first = search->read_count;
  note_part(search, part);
  search->heights = may_gain(search);
  if (!search->heights)
    return search->beside;
  search->read_count = first; /* the best place is another one or not, whatever that has read */
  note_part(search, part);
  take_out(search);
  return find_best(search, own_cost(search));
}
