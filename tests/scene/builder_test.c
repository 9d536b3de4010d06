/* The builder's trees are those of Embree's builder, which is asked for the same splits, and the improved ones those of
   an improver that moves one part after the other (plain_reinsert.c), for any number of threads. */
#include "../../raytracer/scene/built_tree.h"
#include "../../raytracer/scene/sah.h"
#include "plain_reinsert.h"
#include "support.h"

#include <math.h>
#include <rtcore.h>
#include <stdlib.h>
#include <string.h>

/* --- Embree --- */

static void *create_node(RTCThreadLocalAllocator allocator, unsigned int count, void *context) {
  (void)context;
  assert_int_equal(count, 2);
  struct built_node *node = rtcThreadLocalAlloc(allocator, sizeof *node, 16);
  *node = (struct built_node){0};
  return node;
}

static void set_children(void *node, void **children, unsigned int count, void *context) {
  (void)context;
  for (unsigned i = 0; i < count; i++)
    ((struct built_node *)node)->child[i] = children[i];
}

static void ignore_bounds(void *node, const struct RTCBounds **bounds, unsigned int count, void *context) {
  (void)node, (void)bounds, (void)count, (void)context;
}

static struct scene_box box_of(const struct RTCBuildPrimitive *primitive) {
  return (struct scene_box){{primitive->lower_x, primitive->lower_y, primitive->lower_z},
                            {primitive->upper_x, primitive->upper_y, primitive->upper_z}};
}

static int compare_numbers(const void *a, const void *b) {
  const uint32_t *left = a, *right = b;
  return *left < *right ? -1 : *left > *right;
}

static void *create_leaf(RTCThreadLocalAllocator allocator, const struct RTCBuildPrimitive *primitives, size_t count,
                         void *context) {
  (void)context;
  struct built_node *leaf = rtcThreadLocalAlloc(allocator, sizeof *leaf + count * sizeof leaf->triangles[0], 16);
  *leaf = (struct built_node){.box = scene_empty_box()};
  for (size_t i = 0; i < count; i++) {
    const struct scene_box part = box_of(&primitives[i]);
    scene_box_add_box(&leaf->box, &part);
    leaf->triangles[i] = primitives[i].primID;
  }
  qsort(leaf->triangles, count, sizeof leaf->triangles[0], compare_numbers);
  for (size_t i = 0; i < count; i++)
    if (leaf->triangle_count == 0 || leaf->triangles[leaf->triangle_count - 1] != leaf->triangles[i])
      leaf->triangles[leaf->triangle_count++] = leaf->triangles[i];
  return leaf;
}

static struct RTCBounds bounds_as(const struct scene_box *box) {
  return (struct RTCBounds){box->min[0], box->min[1], box->min[2], 0, box->max[0], box->max[1], box->max[2], 0};
}

static void split_primitive(const struct RTCBuildPrimitive *primitive, unsigned int axis, float position,
                            struct RTCBounds *left, struct RTCBounds *right, void *context) {
  const struct trax_mesh *mesh = context;
  const uint32_t *vertices = mesh->triangles[primitive->primID].vertices;
  const float *const corners[3] = {mesh->vertices[vertices[0]], mesh->vertices[vertices[1]],
                                   mesh->vertices[vertices[2]]};
  const struct scene_box box = box_of(primitive);
  struct scene_box parts[2];
  scene_split_triangle(corners, &box, (int)axis, position, parts);
  *left = bounds_as(&parts[0]);
  *right = bounds_as(&parts[1]);
}

static struct built_node *build_by_embree(RTCBVH bvh, const struct trax_mesh *mesh, size_t capacity, unsigned max_leaf,
                                          float cost) {
  struct RTCBuildPrimitive *primitives = aligned_alloc(32, capacity * sizeof *primitives);
  for (uint32_t i = 0; i < mesh->triangle_count; i++) {
    const struct scene_box box = scene_triangle_box(mesh, i);
    primitives[i] =
        (struct RTCBuildPrimitive){box.min[0], box.min[1], box.min[2], 0, box.max[0], box.max[1], box.max[2], i};
  }
  struct RTCBuildArguments arguments = rtcDefaultBuildArguments();
  arguments.buildQuality = RTC_BUILD_QUALITY_HIGH;
  arguments.maxBranchingFactor = 2;
  arguments.maxDepth = 1000;
  arguments.maxLeafSize = max_leaf;
  arguments.traversalCost = cost;
  arguments.intersectionCost = 1;
  arguments.bvh = bvh;
  arguments.primitives = primitives;
  arguments.primitiveCount = mesh->triangle_count;
  arguments.primitiveArrayCapacity = capacity;
  arguments.splitPrimitive = split_primitive;
  arguments.createNode = create_node;
  arguments.setNodeChildren = set_children;
  arguments.setNodeBounds = ignore_bounds;
  arguments.createLeaf = create_leaf;
  arguments.userPtr = (void *)(uintptr_t)mesh;
  struct built_node *root = rtcBuildBVH(&arguments);
  free(primitives);
  assert_non_null(root);
  return root;
}

/* --- ours --- */

static struct built_node *build(const struct trax_mesh *mesh, size_t capacity, unsigned max_leaf, float cost,
                                struct scene_crew *crew) {
  struct sah_prim *prims = aligned_alloc(32, capacity * sizeof *prims);
  for (uint32_t i = 0; i < mesh->triangle_count; i++) {
    const struct scene_box box = scene_triangle_box(mesh, i);
    prims[i] = (struct sah_prim){{box.min[0], box.min[1], box.min[2]}, 0, {box.max[0], box.max[1], box.max[2]}, i};
  }
  const struct trax_build_options options = {.passes = 0};
  const struct sah_arguments arguments = {&options, mesh, prims, mesh->triangle_count, capacity, 1000, max_leaf, cost};
  struct built_node *root = scene_build_sah(&arguments, crew);
  free(prims);
  assert_non_null(root);
  return root;
}

static uint32_t compare_trees(const struct built_node *ours, const struct built_node *theirs) {
  assert_int_equal(ours->triangle_count, theirs->triangle_count);
  if (ours->triangle_count == 0)
    return compare_trees(ours->child[0], theirs->child[0]) + compare_trees(ours->child[1], theirs->child[1]);
  assert_memory_equal(ours->triangles, theirs->triangles, ours->triangle_count * sizeof ours->triangles[0]);
  assert_memory_equal(&ours->box, &theirs->box, sizeof ours->box);
  return ours->triangle_count;
}

/* Boxes that are larger or smaller than others by up to 2^spread, oblique and in planes, on a grid of 1/steps, or not
   if that is 0. */
static void mesh_mixed(struct trax_mesh *mesh, unsigned count, unsigned spread, float steps, uint32_t seed) {
  *mesh = (struct trax_mesh){0};
  for (unsigned i = 0; i < count; i++) {
    float corners[3][3], middle[3];
    const float size = ldexpf(0.02f, (int)(random_unit(&seed) * (float)(spread + 1)));
    const int flat = (int)(random_unit(&seed) * 6), thin = (int)(random_unit(&seed) * 8);
    for (int axis = 0; axis < 3; axis++)
      middle[axis] = random_unit(&seed);
    for (int corner = 0; corner < 3; corner++)
      for (int axis = 0; axis < 3; axis++) {
        float *value = &corners[corner][axis];
        const float extent = axis == thin ? size / 1000 : size;
        *value = middle[axis] + (axis == flat ? 0 : (random_unit(&seed) - 0.5f) * extent);
        if (steps > 0)
          *value = roundf(*value * steps) / steps;
      }
    mesh_triangle(mesh, corners[0], corners[1], corners[2], 0);
  }
}

/* Long oblique triangles in the unit cube, and as many in a corner of it. The small ones have the least budgets, which
   they use up, since all of them overlap. */
static void mesh_slivers(struct trax_mesh *mesh, unsigned count, float corner, uint32_t seed) {
  *mesh = (struct trax_mesh){0};
  for (unsigned i = 0; i < 2 * count; i++) {
    float corners[3][3];
    for (int axis = 0; axis < 3; axis++) {
      const float size = i < count ? 1 : corner, from = random_unit(&seed), to = random_unit(&seed);
      corners[0][axis] = size * from;
      corners[1][axis] = size * to;
      corners[2][axis] = size * (to + 0.02f * random_unit(&seed));
    }
    mesh_triangle(mesh, corners[0], corners[1], corners[2], 0);
  }
}

static void test_same_as_embree(void **state) {
  (void)state;
  RTCDevice device = rtcNewDevice("threads=1,isa=sse2,start_threads=0,set_affinity=0");
  if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_VERSION_MAJOR) > 3) {
    rtcReleaseDevice(device);
    skip(); /* Embree 4.3 builds another tree of mesh 13; on Debian 12 all are compared with 3.13's */
  }
  RTCBVH bvh = rtcNewBVH(device);
  struct scene_crew *crews[] = {scene_crew_new(1), scene_crew_new(2), scene_crew_new(3)};
  assert_int_equal(scene_crew_size(crews[2]), 3);
  uint32_t split = 0;
  for (uint32_t seed = 1; seed <= 44; seed++) {
    struct trax_mesh mesh;
    const float steps[] = {0, 0, 4, 64, 1000}, factors[] = {1, 1.1f, 1.5f, 8}, costs[] = {1, 0.3f, 3};
    const unsigned counts[] = {1, 2, 7, 100, 1000, 1000, 3000};
    const bool slivers = seed > 40;
    if (slivers)
      mesh_slivers(&mesh, 800, 0.125f, seed);
    else
      mesh_mixed(&mesh, seed == 39 ? 12000 : counts[seed % 7], seed % 6, steps[seed % 5], seed);
    const size_t capacity = (size_t)((slivers ? 8 : factors[seed % 4]) * (float)mesh.triangle_count);
    const unsigned max_leaf = 1 + seed % 7;
    const struct built_node *theirs = build_by_embree(bvh, &mesh, capacity, max_leaf, costs[seed % 3]);
    for (int i = 0; i < 3; i++) {
      const struct built_node *ours = build(&mesh, capacity, max_leaf, costs[seed % 3], crews[i]);
      const uint32_t leaves = compare_trees(ours, theirs);
      split += leaves - mesh.triangle_count;
    }
    trax_mesh_release(&mesh);
  }
  if (split < 30000)
    fail_msg("%u parts more than triangles", split);
  for (int i = 0; i < 3; i++)
    scene_crew_release(crews[i]);
  rtcReleaseBVH(bvh);
  rtcReleaseDevice(device);
}

/* --- parts --- */

/* Cuts one part after the other off the rest. */
static void cut(struct scene_box parts[SAH_SPATIAL_BINS], const float *const corners[3], const struct sah_prim *prim,
                int axis, const float *planes, int last) {
  struct scene_box rest, sides[2];
  memcpy(rest.min, prim->min, sizeof rest.min);
  memcpy(rest.max, prim->max, sizeof rest.max);
  for (int bin = 0; bin < last; bin++) {
    scene_split_triangle(corners, &rest, axis, planes[bin + 1], sides);
    parts[bin] = sides[0], rest = sides[1];
  }
  parts[last] = rest;
}

/* Triangles, and the parts of parts of them, between planes at random places, or at coordinates of a grid on which the
   corners are too: many crossings are halfway between two floats then. */
static void test_parts(void **state) {
  (void)state;
  uint32_t random = 1;
  for (uint32_t seed = 1; seed <= 60; seed++) {
    struct trax_mesh mesh;
    const float steps[] = {0, 64, 0, 1 << 21, 0, 1 << 22};
    mesh_mixed(&mesh, 500, 5, steps[seed % 6], seed);
    const struct sah sah = {.mesh = &mesh};
    for (uint32_t i = 0; i < mesh.triangle_count; i++) {
      struct scene_box box = scene_triangle_box(&mesh, i);
      const float *corners[3];
      for (int k = 0; k < 3; k++)
        corners[k] = mesh.vertices[mesh.triangles[i].vertices[k]];
      for (int generation = 0; generation < 4; generation++) {
        const int axis = (int)(random_unit(&random) * 3), last = 1 + (int)(random_unit(&random) * 15);
        const struct sah_prim prim = {{box.min[0], box.min[1], box.min[2]}, 5, {box.max[0], box.max[1], box.max[2]}, i};
        float planes[SAH_SPATIAL_BINS + 1];
        const float extent = box.max[axis] - box.min[axis];
        bool good = true;
        for (int k = 0; k <= last; k++) {
          planes[k] = box.min[axis] + (float)k * (extent / (float)(last + 1));
          if (steps[seed % 6] > 0)
            planes[k] = roundf(planes[k] * steps[seed % 6]) / steps[seed % 6];
          good &= k == 0 || (planes[k] > box.min[axis] && planes[k] < box.max[axis] && planes[k] > planes[k - 1]);
        }
        if (!good)
          break;
        struct scene_box found[SAH_SPATIAL_BINS], expected[SAH_SPATIAL_BINS];
        sah_find_parts(found, &sah, &prim, axis, planes, 0, last);
        cut(expected, corners, &prim, axis, planes, last);
        for (int bin = 0; bin <= last; bin++)
          for (int k = 0; k < 3; k++)
            if (found[bin].min[k] != expected[bin].min[k] || found[bin].max[k] != expected[bin].max[k])
              fail_msg("seed %u, triangle %u, part %d of %d, axis %d: %a to %a, not %a to %a", seed, i, bin, last, k,
                       found[bin].min[k], found[bin].max[k], expected[bin].min[k], expected[bin].max[k]);
        box = expected[(int)(random_unit(&random) * (float)(last + 1))];
      }
    }
    trax_mesh_release(&mesh);
  }
}

/* --- reinsertion --- */

static uint32_t link_node(struct scene_links *links, const struct built_node *built, uint32_t parent) {
  const uint32_t index = links->count++;
  struct scene_link *link = &links->nodes[index];
  *link = (struct scene_link){built->box, built->triangle_count, parent, {SCENE_NO_LINK, SCENE_NO_LINK}, 0, 0};
  if (built->triangle_count)
    return index;
  link->box = scene_empty_box();
  for (int i = 0; i < 2; i++) {
    const uint32_t child = link->child[i] = link_node(links, built->child[i], index);
    const struct scene_link *below = &links->nodes[child];
    scene_box_add_box(&link->box, &below->box);
    link->triangles += below->triangles;
    link->height = below->height + 1 > link->height ? below->height + 1 : link->height;
  }
  return index;
}

static void test_same_as_one_by_one(void **state) {
  (void)state;
  struct scene_crew *crews[] = {scene_crew_new(1), scene_crew_new(2), scene_crew_new(3)};
  for (uint32_t seed = 1; seed <= 12; seed++) {
    struct trax_mesh mesh;
    trax_error error;
    const struct trax_build_options options = {.passes = 1 + seed % 2};
    mesh_mixed(&mesh, seed % 4 == 0 ? 4000 : 300 * seed, seed % 6, seed % 3 ? 0 : 32, seed);
    const int scales[] = {0, -68, 0, -38, 45}; /* areas beyond, and within, what the search computes in binary32 */
    for (uint32_t i = 0; i < 3 * mesh.vertex_count; i++)
      mesh.vertices[i / 3][i % 3] = ldexpf(mesh.vertices[i / 3][i % 3], scales[seed % 5]);
    const struct built_node *root = build(&mesh, mesh.triangle_count * 2, 4, 1, crews[0]);
    struct scene_links links[4];
    for (int i = 0; i < 4; i++) {
      links[i] = (struct scene_links){.nodes = aligned_alloc(64, 4 * mesh.triangle_count * sizeof *links[i].nodes)};
      links[i].root = link_node(&links[i], root, SCENE_NO_LINK);
      links[i].max_depth = links[i].nodes[0].height + (seed % 3 ? 0 : 2); /* some places are too deep */
      if (links[i].max_depth > TRAX_SCENE_MAX_DEPTH)
        links[i].max_depth = TRAX_SCENE_MAX_DEPTH;
    }
    assert_true(links[0].nodes[0].height <= links[0].max_depth);
    assert_true(plain_reinsert(&links[3], options.passes));
    for (int i = 0; i < 3; i++) {
      assert_int_equal(scene_reinsert(&links[i], options.passes, crews[i], &options, &error), TRAX_OK);
      assert_int_equal(links[i].root, links[3].root);
      for (uint32_t n = 0; n < links[3].count; n++)
        assert_memory_equal(links[i].nodes[n].child, links[3].nodes[n].child, sizeof links[3].nodes[n].child);
    }
    for (int i = 0; i < 4; i++)
      free(links[i].nodes);
    trax_mesh_release(&mesh);
  }
  for (int i = 0; i < 3; i++)
    scene_crew_release(crews[i]);
}

/* Values that are equal, or nearly so, as those of a grid's triangles are, in groups of any size. */
static void test_rank(void **state) {
  (void)state;
  enum { MOST = 5000 };
  static struct rank ranks[MOST];
  static uint64_t keys[2][MOST];
  static uint32_t numbers[2][MOST];
  uint64_t random = 1;
  for (uint32_t count = 0; count <= MOST; count = 3 * count + 1)
    for (int groups = 1; groups <= 1000; groups *= 10) {
      for (uint32_t i = 0; i < count; i++) {
        random = random * 6364136223846793005u + 1442695040888963407u;
        const double group = (double)((random >> 33) % (unsigned)groups), step = (double)(random >> 32 & 0xFFFFFFF);
        ranks[i] = (struct rank){random >> 40 & 1 ? group : group * (1 + step * 0x1p-51), i};
        memcpy(&keys[0][i], &ranks[i].value, sizeof ranks[i].value);
        numbers[0][i] = i;
      }
      struct scene_ranking records = {keys[0], numbers[0]}, room = {keys[1], numbers[1]};
      scene_rank(&records, &room, count);
      qsort(ranks, count, sizeof *ranks, compare_ranks);
      for (uint32_t i = 0; i < count; i++)
        assert_int_equal(records.numbers[i], ranks[i].number);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_parts), cmocka_unit_test(test_same_as_embree),
                                     cmocka_unit_test(test_rank), cmocka_unit_test(test_same_as_one_by_one)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
