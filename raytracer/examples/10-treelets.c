/* Step 10: treelets (T. Aila, T. Karras, "Architecture Considerations for Tracing Incoherent Rays", HPG 2010). A
   treelet is a subtree that fits in a data cache with its triangles. A ray waits in memory until its treelet's turn. In
   each round the waiting rays are sorted by treelet, with a counting sort across all threads; a TM takes rays in a row,
   traces each through its treelet, and finds the next treelet of the ray in the tree above. A ray visits the nodes in
   the order of step 7, and the program is compared with step 7. */
#define TILE_BITS 6
#include "one-ray.h"
#include "stages.h"

#ifdef COUNT /* with -mstack=global */
#include <stdio.h>
#endif

#ifndef TREELET_BYTES
#define TREELET_BYTES 16384 /* the data cache of a TM */
#endif
#define WAVE (1u << 16) /* rays at once */
#define MOST_TREELETS (1u << 15)
#define TOP_DEPTH 16 /* of the tree above the treelets. A treelet that begins there may be larger */

/* A number of a node above the treelets or of a treelet has its kind in the lowest bits. */
enum { TOP_NODE = 0, TREELET = 1, LEAF = 3 /* a treelet that is a leaf */ };
#define NO_TREELET 0xFFFFFFFFu
#define ANY_TRIANGLE ((const struct trax_triangle *)1) /* the hit of a ray to the light */

static struct trax_quantised_node top[MOST_TREELETS]; /* copies, with such numbers as children */
static struct subtree {
  trax_scene_ref root;
  unsigned begin, end;     /* of its triangles */
} subtrees[MOST_TREELETS]; /* of top's nodes */
static trax_scene_ref treelets[MOST_TREELETS];
static unsigned top_root, new_nodes[3], treelet_count;

struct postponed {
  unsigned number;
  int enter; /* where the ray enters the box, as bits */
};

struct waiting_ray {
  struct path {
    struct vector origin, direction;
    unsigned pixel, lit; /* the pixel if nothing is in the way to the light; 0: a ray from the eye */
  } path;
  struct hit hit; /* so far */
  unsigned depth; /* of the stack */
  _Alignas(8) struct postponed stack[TOP_DEPTH];
} __attribute__((aligned(64)));

struct visit {
  unsigned ray, treelet;
};

static _Alignas(64) struct waiting_ray rays[WAVE];
static struct {
  struct visit next;
  unsigned rank; /* among the rays that wait for this treelet */
} queue[WAVE];
static struct visit order[WAVE];          /* the queue, sorted */
static unsigned counts[2][MOST_TREELETS]; /* rays that wait for a treelet; then where the first is in `order` */
static unsigned queued[3];

struct state {
  const struct trax_render_params *frame;
  unsigned stage; /* barriers before it */
  unsigned round;
};

/* --- treelets --- */

static inline const struct trax_quantised_node *node_at(trax_scene_ref reference) {
  return (const void *)((const char *)scene.data + reference);
}

/* Triangles are in the order of a depth-first traversal, so a subtree has all of a range. */
static unsigned first_triangle(trax_scene_ref reference) {
  while (!TRAX_SCENE_REF_COUNT(reference))
    reference = node_at(reference)->child[0];
  return TRAX_SCENE_REF_OFFSET(reference);
}

/* Makes a treelet or, of a subtree that is too large, a node above them, `base` and further on this level. */
static unsigned place(const struct subtree *subtree, unsigned level, unsigned base) {
  const struct trax_scene_section *sections = ((const struct trax_scene_header *)scene.data)->sections;
  float nodes_share = (float)(int)sections[TRAX_SCENE_NODES].size / (float)(int)sections[TRAX_SCENE_TRIANGLES].size;
  float bytes = (float)(int)(subtree->end - subtree->begin) * (1 + nodes_share);
  bool leaf = TRAX_SCENE_REF_COUNT(subtree->root) != 0, small = leaf || bytes <= TREELET_BYTES || level == TOP_DEPTH;
  unsigned number = small ? trax_atomic_inc(&treelet_count) : base + trax_atomic_inc(&new_nodes[level % 3]);
  if (number >= MOST_TREELETS)
    trax_abort("the scene has more than 32768 treelets");
  if (small)
    treelets[number] = subtree->root;
  else
    subtrees[number] = *subtree;
  return number << 2 | (leaf ? LEAF : small ? TREELET : TOP_NODE);
}

/* Makes the treelets of the scene, and the nodes above them level by level. */
static __attribute__((noinline)) void make_treelets(struct state *state) {
  const struct trax_scene_header *header = scene.data;
  const struct trax_scene_section *triangles = &header->sections[TRAX_SCENE_TRIANGLES];
  if (trax_thread() == 0)
    top_root = place(&(struct subtree){header->root, triangles->offset, triangles->offset + triangles->size}, 0, 0);
  barrier(&state->stage);
  for (unsigned level = 1, begin = 0, end = new_nodes[0]; begin < end; level++) {
    FOR_ALL(i, state->stage, end - begin) {
      struct subtree whole = subtrees[begin + i], parts[2] = {whole, whole};
      struct trax_quantised_node node = *node_at(whole.root);
      parts[0].end = parts[1].begin = first_triangle(node.child[1]);
      for (int c = 0; c < 2; c++) {
        parts[c].root = node.child[c];
        node.child[c] = place(&parts[c], level, end);
      }
      top[begin + i] = node;
    }
    barrier(&state->stage);
    if (trax_thread() == 0) /* nobody reads it any more, and the level after the next one uses it */
      new_nodes[(level + 2) % 3] = 0;
    begin = end;
    end += new_nodes[level % 3];
  }
}

/* The next treelet of a ray, from `number` or, if that is NO_TREELET, from its stack. Entries of the stack from `kept`
   on are in `stack` and those below in memory. */
static unsigned next_treelet(struct waiting_ray *waiting, const struct ray *ray, float distance, unsigned number) {
  struct postponed stack[TOP_DEPTH];
  unsigned kept = waiting->depth, depth = kept, far;
  const int nearest = in_units_of_boxes(distance);
  for (;;) {
    while (number == NO_TREELET && depth > 0) {
      struct postponed next = --depth < kept ? waiting->stack[depth] : stack[depth];
      kept = depth < kept ? depth : kept;
      if (next.enter <= nearest || (next.number & 3) == LEAF) /* step 7 visits a leaf without a test of its box */
        number = next.number;
    }
    if (number == NO_TREELET || (number & 3) != TOP_NODE)
      break;
    const struct trax_quantised_node *node = &top[number >> 2];
    int enter[2];
    bool hit0 = hit_box(ray, node->box[0].min, nearest, &enter[0]);
    bool hit1 = hit_box(ray, node->box[1].min, nearest, &enter[1]);
    far = hit0 && hit1 && enter[1] < enter[0] ? 0 : 1;
    if (hit0 && hit1)
      stack[depth++] = (struct postponed){node->child[far], enter[far]};
    number = hit0 && hit1 ? node->child[!far] : hit0 ? node->child[0] : hit1 ? node->child[1] : NO_TREELET;
  }
  for (unsigned i = kept; i < depth; i++)
    store_once(&waiting->stack[i], &stack[i], sizeof *stack);
  waiting->depth = depth;
  return number;
}

/* --- rays --- */

/* Lets the ray wait for its next treelet: from `number` on or, if that is NO_TREELET, from the stack. A ray from the
   eye that has none left writes the pixel as it is in shadow, and may become a ray to the light. */
static __attribute__((noinline)) void advance(const struct state *state, unsigned i, unsigned number) {
  const struct trax_render_params *frame = state->frame;
  struct path path;
  struct hit hit;
  load_once(&path, &rays[i].path, sizeof path);
  load_once(&hit, &rays[i].hit, sizeof hit);
  if (path.lit && hit.triangle)
    return;
  for (;;) {
    struct ray ray = make_ray(frame, path.origin, path.direction);
    number = next_treelet(&rays[i], &ray, hit.distance, number);
    if (number != NO_TREELET) {
      unsigned place = trax_atomic_inc(&queued[state->round % 3]);
      queue[place].next = (struct visit){i, number >> 2};
      queue[place].rank = trax_atomic_inc(&counts[state->round % 2][number >> 2]);
      return;
    }
    if (path.lit) {
      write_pixel(path.pixel, path.lit);
      return;
    }
    trax_count_items(1);
    if (!hit.triangle) {
      write_pixel(path.pixel, frame->background);
      return;
    }
    struct surface at = surface_at(frame, path.origin, path.direction, hit);
    write_pixel(path.pixel, colour_of(frame, at.material, at.light));
    if (at.from_light == 0)
      return;
    trax_count_rays(1);
    path = (struct path){at.origin, at.direction, path.pixel, colour_of(frame, at.material, at.light + at.from_light)};
    hit = (struct hit){at.distance, NULL};
    number = top_root;
    store_once(&rays[i].path, &path, sizeof path);
    rays[i].hit = hit;
  }
}

static __attribute__((noinline)) void start_rays(struct state *state, unsigned first_slot, unsigned count) {
  const struct trax_render_params *frame = state->frame;
  FOR_ALL(i, state->stage, count) {
    unsigned x, y;
    if (!slot_pixel(frame, first_slot + i, &x, &y))
      continue;
    trax_count_rays(1);
    rays[i].depth = 0;
    struct path path = {load(frame->eye), eye_direction(frame, x, y), y * frame->width + x, 0};
    store_once(&rays[i].path, &path, sizeof path);
    rays[i].hit = (struct hit){INFINITY, NULL};
    advance(state, i, top_root);
  }
  barrier(&state->stage);
}

static __attribute__((noinline)) void sort(struct state *state) {
  unsigned *places = counts[state->round % 2];
  if (trax_thread() == 0)
    queued[(state->round + 1) % 3] = 0;
  sum_counts(places, counts[(state->round + 1) % 2], treelet_count, &state->stage);
  FOR_ALL(i, state->stage, queued[state->round % 3]) {
    order[places[queue[i].next.treelet] + queue[i].rank] = queue[i].next;
  }
  barrier(&state->stage);
}

/* One loop traces and one advances, so that each fits in the instruction caches. */
static __attribute__((noinline)) void trace_treelets(struct state *state, unsigned count) {
  FOR_ALL(i, state->stage, count) {
    struct waiting_ray *waiting = &rays[trax_load_nt(&order[i].ray)];
    struct path path;
    struct hit hit;
    load_once(&path, &waiting->path, sizeof path);
    load_once(&hit, &waiting->hit, sizeof hit);
    struct ray ray = make_ray(state->frame, path.origin, path.direction);
    bool any = path.lit != 0;
    const trax_scene_ref root = treelets[trax_load_nt(&order[i].treelet)];
    bool found = trace_below(&root, &ray, any, &hit);
    if (found)
      waiting->hit = any ? (struct hit){0, ANY_TRIANGLE} : hit;
  }
  barrier(&state->stage);
}

static __attribute__((noinline)) void advance_rays(struct state *state, unsigned count) {
  FOR_ALL(i, state->stage, count) {
    advance(state, trax_load_nt(&order[i].ray), NO_TREELET);
  }
  barrier(&state->stage);
}

int main(void) {
  struct state state = {.frame = params.data};
  unsigned visits = 0;
  check_scene(state.frame);
  check_threads();
  make_treelets(&state);
  for (unsigned first = 0; first < state.frame->slot_count; first += WAVE) {
    unsigned left = state.frame->slot_count - first, count;
    if (first > 0)
      barrier(&state.stage); /* all have seen that no ray of the last wave is queued */
    start_rays(&state, first, left < WAVE ? left : WAVE);
    while ((count = queued[state.round % 3]) > 0) {
      sort(&state);
      state.round++;
      visits += count;
      trace_treelets(&state, count);
      advance_rays(&state, count);
    }
  }
#ifdef COUNT
  if (trax_thread() == 0)
    iprintf("%u treelets, %u visits in %u rounds\n", treelet_count, visits, state.round);
#else
  (void)visits;
#endif
  return 0;
}
