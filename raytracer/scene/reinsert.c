/* Optimises a tree after it was built: one subtree after another is removed and reinserted where it costs least, found
   by a search of the whole tree. J. Bittner, M. Hapala and V. Havran, "Fast insertion-based optimization of bounding
   volume hierarchies" (Computer Graphics Forum 32(1), 2013), but with subtrees moved as a whole, as in D. Meister and
   J. Bittner, "Parallel reinsertion for bounding volume hierarchy optimization" (Computer Graphics Forum 37(2), 2018).

   The cost of a tree is the sum of the expected visits to its inner nodes. Lines through the whole scene alone would
   neglect small parts: a clearing in a forest would become slower for the sake of the forest, although a viewer in the
   clearing sees little else. So expected visits are summed over random lines through several boxes with equal weights:
   the root's, and smaller ones on the way down to the children with more triangles, each with a quarter of the surface
   of the one before. */
#include "reinsert.h"
#include "crew.h"

#include <stdlib.h>
#include <string.h>

enum { FOCUS_STEP = 4, LEAST_OF_TRIANGLES = 16 };

static void choose_foci(struct foci *foci, const struct scene_links *links) {
  const struct scene_link *nodes = links->nodes, *node = &nodes[links->root];
  const uint32_t least = node->triangles / LEAST_OF_TRIANGLES;
  double last = __builtin_inf();
  while (node->child[0] != SCENE_NO_LINK && node->triangles >= least && foci->count < MOST_FOCI) {
    const double area = scene_half_area(node->box.min, node->box.max);
    if (area > 0 && area * FOCUS_STEP <= last) {
      for (int axis = 0; axis < 3; axis++) {
        foci->min[axis][foci->count] = node->box.min[axis];
        foci->max[axis][foci->count] = node->box.max[axis];
        foci->coarse_min[foci->count][axis] = _mm_set1_ps(node->box.min[axis]);
        foci->coarse_max[foci->count][axis] = _mm_set1_ps(node->box.max[axis]);
      }
      if (area > 0x1p-80 && area < 0x1p80) { /* else zero, a bound that is of no use but true */
        foci->coarse_scale[foci->count] = _mm_set1_ps((float)(1 / area));
        foci->underflow += 0x1p-140 / area;
      }
      foci->scale[foci->count++] = 1 / area;
      last = area;
    }
    const struct scene_link *a = &nodes[node->child[0]], *b = &nodes[node->child[1]];
    node = b->triangles > a->triangles ? b : a;
  }
}

/* --- the tree --- */

struct improver {
  struct scene_links *links;
  struct foci foci;
  /* The nodes that changed in this round, a bit each, and a list of the words that have some; NULL: one thread only. */
  uint64_t (*changed)[2]; /* of anything, and of more than the height */
  uint32_t *changed_words, changed_count;
  /* The nodes that the current move has refitted, as they were before it. Most become what they were when the part is
     inserted again. */
  struct refitted {
    uint32_t node, height;
    struct scene_box box;
  } refitted[2 * TRAX_SCENE_MAX_DEPTH + 2];
  uint32_t refitted_count, refitted_first; /* first: on the way from where the part was taken out */
};

static void mark(struct improver *improver, uint32_t node, bool height_only) {
  if (!improver->changed || node == SCENE_NO_LINK)
    return;
  uint64_t *const words = improver->changed[node / 64];
  if (words[0] == 0)
    improver->changed_words[improver->changed_count++] = node / 64;
  words[0] |= (uint64_t)1 << node % 64;
  words[1] |= (uint64_t)!height_only << node % 64;
}

static void remember(struct improver *improver, uint32_t node) {
  if (!improver->changed)
    return;
  for (uint32_t i = 0; i < improver->refitted_first; i++)
    if (improver->refitted[i].node == node)
      return;
  const struct scene_link *link = &improver->links->nodes[node];
  improver->refitted[improver->refitted_count++] = (struct refitted){node, link->height, link->box};
}

static void mark_refitted(struct improver *improver) {
  for (uint32_t i = 0; i < improver->refitted_count; i++) {
    const struct refitted *old = &improver->refitted[i];
    const struct scene_link *link = &improver->links->nodes[old->node];
    const bool moved = memcmp(&old->box, &link->box, sizeof old->box) != 0;
    if (moved || old->height != link->height)
      mark(improver, old->node, !moved);
  }
  improver->refitted_count = improver->refitted_first = 0;
}

/* Refits the box and height of a node. Returns whether they changed. */
static bool refit_node(struct improver *improver, uint32_t index) {
  struct scene_link *node = &improver->links->nodes[index];
  const struct scene_link *a = &improver->links->nodes[node->child[0]], *b = &improver->links->nodes[node->child[1]];
  const struct scene_box box = scene_join_boxes(&a->box, &b->box);
  const uint32_t height = 1 + (a->height > b->height ? a->height : b->height);
  const bool moved = memcmp(&box, &node->box, sizeof box) != 0;
  if (!moved && height == node->height)
    return false;
  remember(improver, index);
  node->height = height;
  if (moved) {
    node->box = box;
    node->visits = visits_of(&improver->foci, &box);
  }
  return true;
}

/* Refits from here up to the root, or to the first node that stays as it is. */
static void refit_from(struct improver *improver, uint32_t index) {
  while (index != SCENE_NO_LINK && refit_node(improver, index))
    index = improver->links->nodes[index].parent;
}

/* Makes `index` the child of old's parent, or the root if old is that. */
static void take_place_of(struct improver *improver, uint32_t index, uint32_t old) {
  struct scene_links *links = improver->links;
  const uint32_t parent = links->nodes[old].parent;
  links->nodes[index].parent = parent;
  mark(improver, index, false);
  mark(improver, parent, false);
  if (parent == SCENE_NO_LINK)
    links->root = index;
  else
    links->nodes[parent].child[links->nodes[parent].child[1] == old] = index;
}

/* Removes the part with its parent, whose other child takes the parent's place, and inserts it beside `place`. */
static void reinsert(struct improver *improver, uint32_t part, uint32_t place) {
  struct scene_link *nodes = improver->links->nodes;
  const uint32_t parent = nodes[part].parent, beside = nodes[parent].child[nodes[parent].child[0] == part];
  if (place != beside) {
    take_place_of(improver, beside, parent);
    refit_from(improver, nodes[beside].parent);
    improver->refitted_first = improver->refitted_count;
    take_place_of(improver, parent, place);
    nodes[place].parent = parent;
    mark(improver, place, false);
    mark(improver, part, false);
  }
  if (nodes[parent].child[0] != place) /* else in order: a line that is not written stays with all threads */
    nodes[parent].child[0] = place, nodes[parent].child[1] = part;
  if (place != beside) {
    refit_node(improver, parent);
    refit_from(improver, nodes[parent].parent);
    mark_refitted(improver);
  }
}

/* --- the order of the parts --- */

/* Sorts the nodes by expected visits, most first, then by number. */
static void rank(struct scene_ranking *ranked, struct scene_ranking *room, const struct scene_links *links) {
  for (uint32_t i = 0; i < links->count; i++) {
    memcpy(&ranked->keys[i], &links->nodes[i].visits, sizeof ranked->keys[i]);
    ranked->numbers[i] = i;
  }
  scene_rank(ranked, room, links->count);
}

/* --- rounds --- */

/* Parts are searched by all threads at once, then moved in order by one. A search that depends on a node that has
   changed in this round is repeated, so each part is moved as if it were alone. */
enum { ROUND = 1024, STEP = 64 };

struct round {
  struct improver *improver;
  struct search *searches; /* of each worker */
  const uint32_t *parts;
  uint32_t count, next; /* next: the first that no worker has taken */
  struct found {
    uint32_t place, parent; /* parent: of the part */
    size_t first, end;      /* of what was read */
    uint32_t worker;
    bool heights; /* whether it depends on heights */
  } found[ROUND];
};

/* Searches go through all of memory: fetches the nodes above the next parts, one level of each at every step. */
enum { AHEAD = 16 };

struct fetcher {
  uint32_t nodes[AHEAD], next; /* next: the part that joins */
};

static inline void fetch_ahead(struct fetcher *fetcher, const struct scene_link *nodes, const uint32_t *parts,
                               uint32_t count, uint32_t at) {
  if (fetcher->next < at || at == 0)
    *fetcher = (struct fetcher){.next = at};
  for (uint32_t i = 0; i < AHEAD; i++) {
    const struct scene_link *node = &nodes[fetcher->nodes[i]];
    for (int c = 0; c < 2 && node->child[0] != SCENE_NO_LINK; c++)
      __builtin_prefetch(&nodes[node->child[c]]);
    if (node->parent != SCENE_NO_LINK) {
      __builtin_prefetch(&nodes[node->parent]);
      fetcher->nodes[i] = node->parent;
    }
  }
  for (; fetcher->next < at + AHEAD && fetcher->next < count; fetcher->next++) {
    __builtin_prefetch(&nodes[parts[fetcher->next]]);
    fetcher->nodes[fetcher->next % AHEAD] = parts[fetcher->next];
  }
}

static void search_some(struct scene_worker *worker, void *pointer) {
  struct round *round = pointer;
  const uint32_t number = scene_worker_number(worker);
  struct search *search = &round->searches[number];
  struct fetcher fetcher = {.next = 0};
  for (;;) {
    const uint32_t first = __atomic_fetch_add(&round->next, STEP, __ATOMIC_RELAXED);
    if (first >= round->count)
      return;
    for (uint32_t i = first; i < first + STEP && i < round->count; i++) {
      struct found *found = &round->found[i];
      *found = (struct found){SCENE_NO_LINK, SCENE_NO_LINK, search->read_count, 0, number, false};
      fetch_ahead(&fetcher, search->links->nodes, round->parts, round->count, i);
      if (round->parts[i] != round->improver->links->root)
        found->place = scene_find_place(search, round->parts[i]), found->parent = search->parent;
      found->end = search->read_count, found->heights = search->heights;
    }
  }
}

static bool has_changed(const struct improver *improver, const struct search *search, const struct found *found) {
  const int kind = !found->heights;
  uint64_t any = 0;
  for (size_t i = found->first; i < found->end && improver->changed_count; i++)
    any |= improver->changed[search->read[i] / 64][kind] >> search->read[i] % 64;
  return any & 1;
}

/* False when out of memory. */
static bool work_round(struct round *round, struct scene_crew *crew) {
  struct improver *improver = round->improver;
  const unsigned threads = scene_crew_size(crew);
  round->next = 0;
  while (improver->changed_count)
    memset(improver->changed[improver->changed_words[--improver->changed_count]], 0, sizeof *improver->changed);
  for (unsigned i = 0; i < threads; i++)
    round->searches[i].read_count = 0;
  for (unsigned i = 1; i < threads; i++) /* any worker takes one, so all are ready before */
    scene_crew_add(crew, search_some, round);
  scene_crew_run(crew, search_some, round);
  struct search *own = &round->searches[0];
  for (uint32_t i = 0; i < round->count; i++) {
    const struct found *found = &round->found[i];
    if (i + AHEAD < round->count && found[AHEAD].place != SCENE_NO_LINK) {
      __builtin_prefetch(&improver->links->nodes[round->parts[i + AHEAD]]);
      __builtin_prefetch(&improver->links->nodes[found[AHEAD].parent]);
    }
    uint32_t place = found->place;
    if (round->parts[i] == improver->links->root)
      continue;
    if (place != SCENE_NO_LINK && has_changed(improver, &round->searches[found->worker], found))
      place = scene_find_place(own, round->parts[i]);
    if (place == SCENE_NO_LINK)
      return false;
    reinsert(improver, round->parts[i], place);
  }
  return true;
}

static trax_status work_pass(struct round *round, struct scene_crew *crew, const uint32_t *ranked, uint32_t count,
                             const struct trax_build_options *options, unsigned pass, trax_error *error) {
  struct improver *improver = round->improver;
  struct search *search = &round->searches[0];
  struct fetcher fetcher = {.next = 0};
  for (uint32_t i = 0; i < count; i += ROUND) {
    round->parts = ranked + i;
    round->count = count - i < ROUND ? count - i : ROUND;
    if (i / ROUND % 8 == 0)
      scene_report(options, SCENE_IMPROVE, (pass + (double)i / count) / options->passes);
    if (scene_is_interrupted(options->interrupt))
      return TRAX_INTERRUPTED;
    bool good = true;
    if (improver->changed)
      good = work_round(round, crew);
    else
      for (uint32_t k = 0; k < round->count && good; k++) {
        const uint32_t part = round->parts[k];
        search->read_count = 0;
        fetch_ahead(&fetcher, improver->links->nodes, round->parts, round->count, k);
        const uint32_t place = part == improver->links->root ? part : scene_find_place(search, part);
        good = place != SCENE_NO_LINK;
        if (good && place != part)
          reinsert(improver, part, place);
      }
    if (!good)
      return scene_out_of_memory(error, "BVH");
  }
  return TRAX_OK;
}

trax_status scene_reinsert(struct scene_links *links, unsigned passes, struct scene_crew *crew,
                           const struct trax_build_options *options, trax_error *error) {
  struct improver improver = {.links = links};
  const unsigned threads = scene_crew_size(crew);
  const bool several = threads > 1;
  const size_t words = links->count / 64 + 1;
  uint32_t *numbers = malloc(2 * (size_t)links->count * sizeof *numbers);
  uint64_t *keys = malloc(2 * (size_t)links->count * sizeof *keys);
  struct search *searches = calloc(threads, sizeof *searches);
  struct round *round = malloc(sizeof *round);
  improver.changed = several ? calloc(words, sizeof *improver.changed) : NULL;
  improver.changed_words = several ? malloc(words * sizeof *improver.changed_words) : NULL;
  choose_foci(&improver.foci, links);
  if (improver.foci.count == 0) /* all triangles are on one line */
    passes = 0;
  for (uint32_t i = 0; i < links->count; i++)
    links->nodes[i].visits = visits_of(&improver.foci, &links->nodes[i].box);
  trax_status result = TRAX_OK;
  if (!numbers || !keys || !searches || !round || (several && (!improver.changed || !improver.changed_words)))
    result = scene_out_of_memory(error, "BVH");
  else {
    for (unsigned i = 0; i < threads; i++)
      searches[i] = (struct search){.links = links, .foci = &improver.foci};
    *round = (struct round){.improver = &improver, .searches = searches};
  }
  struct scene_ranking ranked = {keys, numbers}, room = {keys + links->count, numbers + links->count};
  for (unsigned pass = 0; pass < passes && result == TRAX_OK; pass++) {
    rank(&ranked, &room, links);
    result = work_pass(round, crew, ranked.numbers, links->count, options, pass, error);
  }
  for (unsigned i = 0; searches && i < threads; i++)
    free(searches[i].read);
  free(improver.changed), free(improver.changed_words), free(round), free(searches), free(keys), free(numbers);
  return result;
}
