/* Wide nodes. Of eight children (raytracer/layouts/wide8): planes contain the boxes and are the nearest that do,
   frames are the least, and what is read is written as the same bytes, for boxes that are flat, far away, tiny or
   large. Of trees of any shape (layouts/widen.c): every leaf is in one node, and the stack is large enough. */
#include "../../raytracer/scene/internal.h"
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CODE trax_node_formats[TRAX_NODES_WIDE8].code

static uint64_t state = 1;

static uint32_t next_random(uint32_t below) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return (uint32_t)(state >> 33) % below;
}

/* The sign of distance - (coordinate - origin), exactly: the difference is the sum of two numbers. */
static int compare(double distance, float coordinate, float origin) {
  const double c = (double)coordinate, o = (double)origin, sum = c - o, virtual_o = c - sum;
  const double rest = (c - (sum + virtual_o)) + (virtual_o - o);
  if (distance != sum)
    return distance < sum ? -1 : 1;
  return rest > 0 ? -1 : rest < 0;
}

static double distance_of(uint32_t plane, int scale) {
  return ldexp(plane, scale - 149);
}

/* A number near `middle`: a few floats away, or about 2^exponent away. */
static float any_coordinate(float middle, int exponent) {
  switch (next_random(4)) {
  case 0:
    return middle;
  case 1:
    for (uint32_t steps = next_random(5); steps > 0; steps--)
      middle = scene_next_float(middle, true);
    return middle;
  case 2:
    return middle + ldexpf((float)next_random(1 << 24), exponent - 24);
  default:
    return middle - ldexpf((float)next_random(256), exponent - 8);
  }
}

static void make_node(struct scene_node *node) {
  static const int exponents[] = {-149, -126, -60, -20, 0, 20, 40, 60};
  *node = (struct scene_node){.count = 0};
  float middle[3];
  int exponent[3];
  for (int axis = 0; axis < 3; axis++) {
    const int size = exponents[next_random(8)];
    middle[axis] = next_random(3)   ? ldexpf((float)next_random(1 << 24) - (1 << 23), size - 24)
                   : next_random(2) ? 0
                                    : -0.0f;
    exponent[axis] = next_random(2) ? size : exponents[next_random(8)];
  }
  uint32_t triangles = 0, nodes = 0;
  for (uint32_t slot = 0; slot < 8; slot++) {
    if (slot != 3 && next_random(3) == 0)
      continue;
    const uint32_t i = node->count++, count = next_random(5);
    node->slot[i] = (uint8_t)slot;
    node->child[i] = count ? (4096 + 40 * triangles) | count : 1024 + 80 * nodes;
    triangles += count, nodes += count == 0;
    for (int axis = 0; axis < 3; axis++) {
      const float a = any_coordinate(middle[axis], exponent[axis]), b = any_coordinate(middle[axis], exponent[axis]);
      node->box[i].min[axis] = a < b ? a : b;
      node->box[i].max[axis] = a < b ? b : a;
    }
  }
}

static void check_planes(const struct trax_wide8_node *written, const struct scene_node *node,
                         const struct scene_node *read, uint32_t i, int axis) {
  const float origin = written->origin[axis], min = node->box[i].min[axis], max = node->box[i].max[axis];
  const int scale = written->scale[axis];
  const uint32_t low = written->min[axis][node->slot[i]], high = written->max[axis][node->slot[i]];
  assert_true(compare(distance_of(low, scale), min, origin) <= 0);
  assert_true(low == 255 || compare(distance_of(low + 1, scale), min, origin) > 0);
  assert_true(compare(distance_of(high, scale), max, origin) >= 0);
  assert_true(high == 0 || compare(distance_of(high - 1, scale), max, origin) < 0);
  const float first = read->box[i].min[axis], last = read->box[i].max[axis];
  assert_true(first <= min && last >= max);
  assert_true(compare(distance_of(low, scale), first, origin) <= 0);
  assert_true(compare(distance_of(low, scale), scene_next_float(first, false), origin) > 0);
  assert_true(compare(distance_of(high, scale), last, origin) >= 0);
  assert_true(compare(distance_of(high, scale), scene_next_float(last, true), origin) < 0);
  const struct scene_box stored = CODE->box(written, &node->box[i]);
  assert_true(stored.min[axis] == first && stored.max[axis] == last);
}

static void test_planes(void **unused) {
  (void)unused;
  for (int round = 0; round < 20000; round++) {
    struct scene_node node, read;
    struct trax_wide8_node written, again;
    make_node(&node);
    CODE->write(&written, NULL, &node);
    CODE->read(&read, NULL, &written);
    assert_int_equal(read.count, node.count);
    assert_memory_equal(read.child, node.child, node.count * sizeof *node.child);
    assert_memory_equal(read.slot, node.slot, node.count);
    const struct scene_box whole = scene_box_around(&node);
    for (int axis = 0; axis < 3; axis++) {
      const int scale = written.scale[axis];
      assert_true(written.origin[axis] == whole.min[axis] && !signbit(written.origin[axis]) == !(whole.min[axis] < 0));
      assert_true(scale == 0 || compare(distance_of(255, scale - 1), whole.max[axis], whole.min[axis]) < 0);
      for (uint32_t i = 0; i < node.count; i++)
        check_planes(&written, &node, &read, i, axis);
    }
    CODE->write(&again, NULL, &read);
    assert_memory_equal(&again, &written, sizeof written);
  }
}

/* Bytes of a damaged file are read and written without traps, and never as what they are not. */
static void test_any_bytes(void **unused) {
  (void)unused;
  for (int round = 0; round < 20000; round++) {
    struct trax_wide8_node any, again;
    struct scene_node read;
    for (size_t i = 0; i < sizeof any; i++)
      ((unsigned char *)&any)[i] = (unsigned char)(next_random(8) ? next_random(256) : next_random(2) * 255);
    CODE->read(&read, NULL, &any);
    CODE->write(&again, NULL, &read);
    const struct scene_box box = {{-1, 0, 1e-40f}, {1, 1e18f, INFINITY}};
    (void)CODE->box(&any, &box);
    for (uint32_t i = 0; i < read.count; i++)
      assert_true(any.meta[read.slot[i]] != 0);
  }
}

/* --- trees --- */

enum { MOST_NODES = 400, ROOM = MOST_NODES + 2 * TRAX_SCENE_MAX_DEPTH };

/* Adds a subtree of at most `levels` inner nodes from its root to a leaf, the longest paths of them chains. */
static uint32_t add_subtree(struct scene_tree *tree, uint32_t levels, uint32_t chains, uint32_t depth) {
  const uint32_t index = tree->node_count++;
  assert_true(index < ROOM);
  struct scene_tree_node *node = &tree->nodes[index];
  if (levels == 0 || tree->node_count + 2 * levels + 2 > MOST_NODES) {
    *node = (struct scene_tree_node){.triangle_count = 1 + next_random(TRAX_SCENE_MAX_LEAF), .box = scene_empty_box()};
    for (int k = 0; k < 2; k++) {
      const float corner[3] = {(float)next_random(1000), (float)next_random(1000),
                               (float)next_random(next_random(9) + 1)};
      scene_box_add_point(&node->box, corner);
    }
    return index;
  }
  *node = (struct scene_tree_node){0};
  tree->inner_count++;
  tree->max_depth = depth + 1 > tree->max_depth ? depth + 1 : tree->max_depth;
  const int first = next_random(2);
  for (int k = 0; k < 2; k++) {
    const bool is_long = k == first;
    const uint32_t below = is_long ? levels - 1 : next_random(chains) ? 0 : next_random(levels);
    const uint32_t child = add_subtree(tree, below, chains, depth + 1);
    tree->nodes[index].child[k] = child;
  }
  return index;
}

/* Counts the leaves below a wide node, and checks the node. */
static uint32_t check_wide(const struct scene_wide *wide, const struct scene_tree *tree, uint32_t number,
                           enum trax_node_layout layout, uint32_t above, unsigned char *seen) {
  const struct scene_wide_node *node = &wide->nodes[number];
  uint32_t leaves = 0, triangles = 0, next = UINT32_MAX;
  const bool eight = layout == TRAX_NODES_WIDE8;
  assert_in_range(node->count, eight && tree->node_count == 1 ? 1 : 2, trax_node_formats[layout].children);
  above += eight ? 1 : node->count - 1;
  assert_true(above <= wide->entries);
  for (uint32_t i = 0; i < node->count; i++) {
    const uint32_t child = node->child[i];
    assert_false(seen[child]);
    seen[child] = 1;
    triangles += tree->nodes[child].triangle_count;
    assert_true(!eight || i == 0 || node->slot[i] > node->slot[i - 1]);
    if (tree->nodes[child].triangle_count) {
      leaves++;
      continue;
    }
    const uint32_t below = wide->number[child];
    assert_true(below < wide->count && below != number);
    assert_true(!eight || next == UINT32_MAX || wide->position[below] == next);
    next = wide->position[below] + 1;
    leaves += check_wide(wide, tree, below, layout, above, seen);
  }
  assert_true(!eight || triangles <= 32);
  return leaves;
}

static void test_trees(void **unused) {
  (void)unused;
  struct scene_tree_node *nodes = malloc(ROOM * sizeof *nodes);
  assert_non_null(nodes);
  for (int round = 0; round < 3000; round++) {
    struct scene_tree tree = {.nodes = nodes};
    add_subtree(&tree, next_random(TRAX_SCENE_MAX_DEPTH + 1), 1 + next_random(20), 0);
    for (enum trax_node_layout layout = TRAX_NODES_WIDE4; layout <= TRAX_NODES_WIDE8; layout++) {
      unsigned char seen[ROOM] = {0};
      struct scene_wide wide;
      assert_true(scene_widen(&wide, &tree, layout));
      const uint32_t leaves = tree.node_count - tree.inner_count;
      const uint32_t most = tree.max_depth > TRAX_SCENE_DEFAULT_DEPTH ? tree.max_depth : TRAX_SCENE_DEFAULT_DEPTH;
      assert_true(wide.entries <= most);
      if (wide.count)
        assert_int_equal(check_wide(&wide, &tree, 0, layout, 0, seen), leaves);
      else
        assert_true(tree.node_count == 1 && layout != TRAX_NODES_WIDE8);
      scene_wide_release(&wide);
    }
  }
  free(nodes);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_planes), cmocka_unit_test(test_any_bytes),
                                     cmocka_unit_test(test_trees)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
