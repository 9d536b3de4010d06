/* The builder's recursion. A set and its room are a range of one array, so subtrees are built by any thread. */
#include "sah.h"
#include "built_tree.h"
#include "crew.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LEVELS_OF_LARGE_LEAVES = 8, MOST_BUDGET = 31, LEAST_OF_TASK = 4096 };

struct builder {
  struct sah sah;
  const struct sah_arguments *arguments;
  struct scene_crew *crew;
  uint32_t done; /* primitives in leaves */
  bool failed;   /* out of memory */
};

/* --- rooms --- */

/* Gives each side room by the budgets of its primitives. */
static void share_room(const struct sah *sah, const struct sah_set *set, struct sah_set sides[2],
                       const size_t weights[2]) {
  const size_t room = set->room_end - set->end;
  if (room == 0)
    return;
  const float share = (float)weights[0] / (float)(weights[0] + weights[1]);
  const size_t wanted = (size_t)floorf(share * (float)room), left = wanted < room ? wanted : room;
  const size_t size = sides[1].end - sides[1].begin;
  struct sah_prim *right = sah->prims + sides[1].begin;
  if (left < size)
    memcpy(right + size, right, left * sizeof *right);
  else
    memcpy(right + left, right, size * sizeof *right);
  sides[0].room_end = sides[0].end + left;
  sides[1].begin += left, sides[1].end += left;
  sides[1].room_end = set->room_end;
}

/* --- leaves --- */

static int compare_prims(const void *a, const void *b) {
  const struct sah_prim *left = a, *right = b;
  if (left->triangle != right->triangle)
    return left->triangle < right->triangle ? -1 : 1;
  if (left->budget != right->budget)
    return left->budget < right->budget ? -1 : 1;
  return memcmp(left, right, sizeof *left);
}

static void sort(const struct sah *sah, const struct sah_set *set) {
  qsort(sah->prims + set->begin, set->end - set->begin, sizeof *sah->prims, compare_prims);
}

/* Halves a set by number. */
static void halve(const struct sah *sah, const struct sah_set *set, struct sah_set sides[2]) {
  const size_t middle = (set->begin + set->end) / 2;
  size_t weights[2] = {0, 0};
  for (int side = 0; side < 2; side++) {
    struct sah_set *half = &sides[side];
    half->box = half->middles = sah_empty_box();
    half->begin = side ? middle : set->begin, half->end = half->room_end = side ? set->end : middle;
    for (size_t i = half->begin; i < half->end; i++) {
      const struct sah_box box = sah_box_of(&sah->prims[i]);
      const __m128 sum = _mm_add_ps(box.min, box.max);
      sah_extend(&half->box, &box);
      sah_extend(&half->middles, &(struct sah_box){sum, sum});
      weights[side] += sah->prims[i].budget;
    }
  }
  share_room(sah, set, sides, weights);
}

static struct built_node *new_node(struct builder *builder, struct scene_worker *worker, size_t triangles) {
  struct built_node *node = scene_worker_take(worker, sizeof *node + triangles * sizeof node->triangles[0]);
  if (node)
    *node = (struct built_node){.box = scene_empty_box()};
  else
    __atomic_store_n(&builder->failed, true, __ATOMIC_RELAXED);
  return node;
}

static struct built_node *make_leaf(struct builder *builder, struct scene_worker *worker, const struct sah_set *set) {
  struct built_node *leaf = new_node(builder, worker, set->end - set->begin);
  for (size_t i = set->begin; leaf && i < set->end; i++) {
    const struct sah_prim *prim = &builder->sah.prims[i];
    const struct scene_box part = {{prim->min[0], prim->min[1], prim->min[2]},
                                   {prim->max[0], prim->max[1], prim->max[2]}};
    scene_box_add_box(&leaf->box, &part);
    size_t at = leaf->triangle_count; /* insertion sort: sets are small */
    while (at > 0 && leaf->triangles[at - 1] > prim->triangle)
      at--;
    if (at > 0 && leaf->triangles[at - 1] == prim->triangle)
      continue; /* another part of the same triangle */
    memmove(leaf->triangles + at + 1, leaf->triangles + at, (leaf->triangle_count - at) * sizeof *leaf->triangles);
    leaf->triangles[at] = prim->triangle;
    leaf->triangle_count++;
  }
  return leaf;
}

/* Leaves over a sorted set. */
static struct built_node *make_leaves(struct builder *builder, struct scene_worker *worker, const struct sah_set *set) {
  if (set->end - set->begin <= builder->arguments->max_leaf)
    return make_leaf(builder, worker, set);
  struct sah_set sides[2];
  halve(&builder->sah, set, sides);
  struct built_node *node = new_node(builder, worker, 0);
  for (int side = 0; node && side < 2; side++)
    node->child[side] = make_leaves(builder, worker, &sides[side]);
  return node;
}

/* --- the recursion --- */

static struct sah_split find_split(const struct sah *sah, const struct sah_set *set) {
  struct sah_box overlap;
  const struct sah_split object = sah_find_object_split(sah, set, &overlap);
  const float area = sah_area(&overlap);
  if (set->end == set->room_end || area < 0.000005f * sah->root_area || area < 0.1f * sah_area(&set->box))
    return object;
  const struct sah_split spatial = sah_find_spatial_split(sah, set, 0.99f * object.cost);
  return spatial.cost < INFINITY ? spatial : object;
}

static void divide(struct builder *builder, const struct sah_split *split, struct sah_set *set,
                   struct sah_set sides[2]) {
  if (!(split->cost < INFINITY)) {
    sort(&builder->sah, set);
    halve(&builder->sah, set, sides);
    return;
  }
  if (split->spatial)
    sah_divide(&builder->sah, split, set);
  size_t weights[2];
  sah_partition(&builder->sah, split, set, sides, weights);
  share_room(&builder->sah, set, sides, weights);
}

/* A subtree to be built, and where its root goes. */
struct task {
  struct builder *builder;
  struct sah_set set;
  unsigned depth;
  struct built_node **root;
};

static void build(struct builder *builder, struct scene_worker *worker, struct sah_set set, unsigned depth,
                  struct built_node **root);

static void run_task(struct scene_worker *worker, void *pointer) {
  struct task *task = pointer;
  build(task->builder, worker, task->set, task->depth, task->root);
  free(task);
}

static void run_first(struct scene_worker *worker, void *pointer) {
  const struct task *task = pointer;
  build(task->builder, worker, task->set, task->depth, task->root);
}

/* Leaves the subtree to another thread if it is large. False: the caller has to build it. */
static bool hand_over(struct builder *builder, const struct sah_set *set, unsigned depth, struct built_node **root) {
  struct task *task = set->end - set->begin < LEAST_OF_TASK ? NULL : malloc(sizeof *task);
  if (!task)
    return false;
  *task = (struct task){builder, *set, depth, root};
  if (scene_crew_add(builder->crew, run_task, task))
    return true;
  free(task);
  return false;
}

static void build(struct builder *builder, struct scene_worker *worker, struct sah_set set, unsigned depth,
                  struct built_node **root) {
  const struct sah_arguments *arguments = builder->arguments;
  const size_t size = set.end - set.begin;
  *root = NULL;
  if (scene_is_interrupted(arguments->options->interrupt) || __atomic_load_n(&builder->failed, __ATOMIC_RELAXED))
    return;
  const struct sah_split split = find_split(&builder->sah, &set);
  const float area = sah_half_area(&set.box);
  if (size <= 1 || depth + LEVELS_OF_LARGE_LEAVES >= arguments->max_depth ||
      (size <= arguments->max_leaf && area * (float)size <= arguments->traversal_cost * area + split.cost)) {
    sort(&builder->sah, &set);
    *root = make_leaves(builder, worker, &set);
    const uint32_t done = __atomic_add_fetch(&builder->done, (uint32_t)size, __ATOMIC_RELAXED);
    if (scene_worker_number(worker) == 0 && done / 4096 != (done - (uint32_t)size) / 4096)
      scene_report(arguments->options, SCENE_BUILD, (double)done / arguments->count);
    return;
  }
  struct sah_set sides[2];
  divide(builder, &split, &set, sides);
  struct built_node *node = new_node(builder, worker, 0);
  if (!node)
    return;
  *root = node;
  const int larger = sides[1].end - sides[1].begin > sides[0].end - sides[0].begin; /* it comes first */
  if (!hand_over(builder, &sides[!larger], depth + 1, &node->child[1]))
    build(builder, worker, sides[!larger], depth + 1, &node->child[1]);
  build(builder, worker, sides[larger], depth + 1, &node->child[0]);
}

/* Gives each triangle a budget of splits by its share of the area. */
static void set_budgets(struct sah_prim *prims, uint32_t count) {
  double sum = 0;
  for (uint32_t i = 0; i < count; i++) {
    const struct sah_box box = sah_box_of(&prims[i]);
    sum += 2 * sah_half_area(&box);
  }
  const float reciprocal = 1 / (float)sum;
  for (uint32_t i = 0; i < count; i++) {
    const struct sah_box box = sah_box_of(&prims[i]);
    const float share = ceilf(10.0f * (float)count * (2 * sah_half_area(&box)) * reciprocal);
    const int more = share >= 1 && share < 0x1p31f ? share < MOST_BUDGET - 4 ? (int)share : MOST_BUDGET - 4 : 1;
    prims[i].budget = (uint32_t)(4 + more);
  }
}

struct built_node *scene_build_sah(const struct sah_arguments *arguments, struct scene_crew *crew) {
  struct builder builder = {.arguments = arguments, .crew = crew};
  builder.sah = (struct sah){.prims = arguments->prims, .mesh = arguments->mesh};
  struct sah_set all = {.box = sah_empty_box(), .middles = sah_empty_box(), .end = arguments->count};
  all.room_end = arguments->capacity;
  for (size_t i = 0; i < all.end; i++) {
    const struct sah_box box = sah_box_of(&arguments->prims[i]);
    const __m128 sum = _mm_add_ps(box.min, box.max);
    sah_extend(&all.box, &box);
    sah_extend(&all.middles, &(struct sah_box){sum, sum});
  }
  builder.sah.root_area = sah_area(&all.box);
  if (all.room_end > all.end)
    set_budgets(arguments->prims, arguments->count);
  struct built_node *root = NULL;
  struct task task = {&builder, all, 1, &root};
  scene_crew_run(crew, run_first, &task);
  return builder.failed ? NULL : root;
}
