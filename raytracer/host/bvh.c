/* The tree: built by Embree, then renumbered depth first so that nothing depends on where or when its callbacks ran. */
#include "internal.h"

#include <embree3/rtcore.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Defaults; docs/raytracer.md tells how they were measured. */
enum { default_max_leaf = 4, default_max_depth = TRAX_SCENE_MAX_DEPTH };
static const float default_traversal_cost = 1, default_intersection_cost = 1;

/* One thread and one instruction set: the surface areas are rounded in the same way on every host. */
static const char device_options[] = "threads=1,isa=sse2,start_threads=0,set_affinity=0";

/* What the callbacks make; Embree's allocator owns it. */
struct built_node {
  uint32_t triangle_count; /* 0: an inner node */
  struct built_node *child[2];
  uint32_t triangles[];
};

struct build_context {
  const struct trax_build_options *options;
  bool failed; /* the builder made something we cannot represent */
};

static void *create_node(RTCThreadLocalAllocator allocator, unsigned int child_count, void *context) {
  if (child_count != 2)
    ((struct build_context *)context)->failed = true;
  struct built_node *node = rtcThreadLocalAlloc(allocator, sizeof *node, 16);
  *node = (struct built_node){0};
  return node;
}

static void set_children(void *node, void **children, unsigned int child_count, void *context) {
  (void)context;
  for (unsigned i = 0; i < child_count && i < 2; i++)
    ((struct built_node *)node)->child[i] = children[i];
}

/* The boxes are computed from the triangles when the file is laid out. */
static void ignore_bounds(void *node, const struct RTCBounds **bounds, unsigned int child_count, void *context) {
  (void)node, (void)bounds, (void)child_count, (void)context;
}

static void *create_leaf(RTCThreadLocalAllocator allocator, const struct RTCBuildPrimitive *primitives, size_t count,
                         void *context) {
  if (count == 0 || count > TRAX_SCENE_MAX_LEAF) {
    ((struct build_context *)context)->failed = true;
    count = 0;
  }
  struct built_node *leaf = rtcThreadLocalAlloc(allocator, sizeof *leaf + count * sizeof leaf->triangles[0], 16);
  *leaf = (struct built_node){.triangle_count = (uint32_t)count};
  for (size_t i = 0; i < count; i++) { /* insertion sort: the builder's order carries no meaning */
    size_t at = i;
    for (; at > 0 && leaf->triangles[at - 1] > primitives[i].primID; at--)
      leaf->triangles[at] = leaf->triangles[at - 1];
    leaf->triangles[at] = primitives[i].primID;
  }
  return leaf;
}

static bool on_progress(void *pointer, double fraction) {
  const struct trax_build_options *options = ((struct build_context *)pointer)->options;
  if (options->progress)
    options->progress(options->progress_context, "BVH", fraction);
  return !(options->interrupt && *options->interrupt);
}

/* Copies the subtree depth first; false when it is deeper than allowed or malformed. depth counts the inner nodes
   above. */
static bool number_nodes(struct scene_tree *tree, const struct built_node *built, unsigned depth, unsigned max_depth) {
  uint32_t index = tree->node_count++;
  struct scene_tree_node *node = &tree->nodes[index];
  node->triangle_count = built->triangle_count;
  if (built->triangle_count) {
    memcpy(node->triangles, built->triangles, built->triangle_count * sizeof built->triangles[0]);
    if (built->triangle_count > tree->max_leaf)
      tree->max_leaf = built->triangle_count;
    return true;
  }
  if (++depth > max_depth || !built->child[0] || !built->child[1])
    return false;
  if (depth > tree->max_depth)
    tree->max_depth = depth;
  tree->inner_count++;
  for (int i = 0; i < 2; i++) {
    node->child[i] = tree->node_count;
    if (!number_nodes(tree, built->child[i], depth, max_depth))
      return false;
  }
  return true;
}

static void fill_primitives(struct RTCBuildPrimitive *primitives, const struct trax_mesh *mesh) {
  for (uint32_t i = 0; i < mesh->triangle_count; i++) {
    struct scene_box box = scene_empty_box();
    for (int corner = 0; corner < 3; corner++)
      scene_box_add_point(&box, mesh->vertices[mesh->triangles[i].vertices[corner]]);
    primitives[i] = (struct RTCBuildPrimitive){.lower_x = box.min[0],
                                               .lower_y = box.min[1],
                                               .lower_z = box.min[2],
                                               .upper_x = box.max[0],
                                               .upper_y = box.max[1],
                                               .upper_z = box.max[2],
                                               .primID = i};
  }
}

static trax_status check_options(const struct trax_build_options *options, trax_error *error) {
  if (options->max_leaf > TRAX_SCENE_MAX_LEAF)
    return scene_fail(error, "the leaf size is at most %u triangles, not %u", TRAX_SCENE_MAX_LEAF, options->max_leaf);
  if (options->max_depth > TRAX_SCENE_MAX_DEPTH)
    return scene_fail(error, "the depth is at most %u nodes, not %u", TRAX_SCENE_MAX_DEPTH, options->max_depth);
  if (options->cache_lines > 4096) /* the search for the largest node is linear in it */
    return scene_fail(error, "nodes can be ordered for at most 4096 lines of cache, not %u", options->cache_lines);
  if (!(options->traversal_cost >= 0 && options->intersection_cost >= 0 && isfinite(options->traversal_cost) &&
        isfinite(options->intersection_cost)))
    return scene_fail(error, "costs are positive numbers");
  return TRAX_OK;
}

trax_status scene_build_tree(struct scene_tree *tree, const struct trax_mesh *mesh,
                             const struct trax_build_options *options, trax_error *error) {
  *tree = (struct scene_tree){0};
  trax_status result = check_options(options, error);
  if (result != TRAX_OK || mesh->triangle_count == 0)
    return result;
  unsigned max_depth = options->max_depth ? options->max_depth : default_max_depth;
  struct build_context context = {.options = options};

  size_t bytes = mesh->triangle_count * sizeof(struct RTCBuildPrimitive);
  struct RTCBuildPrimitive *primitives = aligned_alloc(_Alignof(struct RTCBuildPrimitive), bytes);
  /* A binary tree over n triangles has at most 2n - 1 nodes. */
  tree->nodes = malloc(2 * (size_t)mesh->triangle_count * sizeof *tree->nodes);
  RTCDevice device = rtcNewDevice(device_options);
  RTCBVH bvh = device ? rtcNewBVH(device) : NULL;
  if (!primitives || !tree->nodes)
    result = scene_out_of_memory(error, "BVH");
  else if (!bvh)
    result = scene_fail(error, "BVH: Embree cannot be started (error %d)", (int)rtcGetDeviceError(NULL));
  else {
    fill_primitives(primitives, mesh);
    struct RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality = RTC_BUILD_QUALITY_HIGH;
    arguments.maxBranchingFactor = 2;
    /* Embree counts the leaf's level too. */
    arguments.maxDepth = max_depth + 1;
    arguments.maxLeafSize = options->max_leaf ? options->max_leaf : default_max_leaf;
    arguments.traversalCost = options->traversal_cost > 0 ? options->traversal_cost : default_traversal_cost;
    arguments.intersectionCost =
        options->intersection_cost > 0 ? options->intersection_cost : default_intersection_cost;
    arguments.bvh = bvh;
    arguments.primitives = primitives;
    arguments.primitiveCount = arguments.primitiveArrayCapacity = mesh->triangle_count;
    arguments.createNode = create_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = ignore_bounds;
    arguments.createLeaf = create_leaf;
    arguments.buildProgress = on_progress;
    arguments.userPtr = &context;
    const struct built_node *root = rtcBuildBVH(&arguments);
    enum RTCError code = rtcGetDeviceError(device);
    if (options->interrupt && *options->interrupt)
      result = TRAX_INTERRUPTED;
    else if (code == RTC_ERROR_OUT_OF_MEMORY)
      result = scene_out_of_memory(error, "BVH");
    else if (!root || context.failed || !number_nodes(tree, root, 0, max_depth))
      result = scene_fail(error, "BVH: no tree of at most %u levels with at most %u triangles in a leaf (Embree: %d)",
                          max_depth, arguments.maxLeafSize, (int)code);
  }
  free(primitives);
  if (bvh)
    rtcReleaseBVH(bvh);
  if (device)
    rtcReleaseDevice(device);
  if (result != TRAX_OK)
    scene_tree_release(tree);
  return result;
}

void scene_tree_release(struct scene_tree *tree) {
  free(tree->nodes);
  *tree = (struct scene_tree){0};
}
