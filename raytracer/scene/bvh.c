/* The tree: built (sah.c), improved (reinsert.c), then numbered (numbering.c). */
#include "built_tree.h"
#include "sah.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Defaults; docs/results/raytracer.md has what was measured. */
enum { default_max_leaf = 4, default_max_depth = TRAX_SCENE_DEFAULT_DEPTH };
static const float default_traversal_cost = 1; /* relative to a triangle's */

/* Deep enough for all trees by surface areas. Subtrees that are too deep for the device are rebuilt afterwards. */
#define BUILDER_DEPTH 1000

/* Fills in all triangles, or with duplicates only the first at each place. Returns their number. */
static uint32_t fill_primitives(struct sah_prim *primitives, const struct trax_mesh *mesh,
                                const struct scene_duplicates *duplicates) {
  uint32_t count = 0;
  for (uint32_t i = 0; i < mesh->triangle_count; i++) {
    if (duplicates && duplicates->first[i] != i)
      continue;
    const struct scene_box box = scene_triangle_box(mesh, i);
    primitives[count] = (struct sah_prim){.triangle = i};
    memcpy(primitives[count].min, box.min, sizeof box.min);
    memcpy(primitives[count++].max, box.max, sizeof box.max);
  }
  return count;
}

static struct scene_box bounds_of(const struct sah_prim *primitives, uint32_t count) {
  struct scene_box bounds = scene_empty_box();
  for (uint32_t i = 0; i < count; i++) {
    scene_box_add_point(&bounds, primitives[i].min);
    scene_box_add_point(&bounds, primitives[i].max);
  }
  return bounds;
}

/* --- improving what was built --- */

/* A subtree to be linked. */
struct linking {
  struct scene_links *links;
  struct built_node **of; /* of each link */
  struct scene_crew *crew;
  struct built_node *built;
  uint32_t index, parent; /* of its root */
};

enum { LEAST_OF_LINKING = 4096 }; /* nodes that are left to another thread */

static void link_task(struct scene_worker *worker, void *pointer);

/* Links are in the order of the tree, depth first. The boxes of large subtrees come afterwards: other threads may be in
   them. */
static void link_built(const struct linking *linking) {
  const struct built_node *built = linking->built;
  struct scene_link *nodes = linking->links->nodes, *link = &nodes[linking->index];
  linking->of[linking->index] = linking->built;
  *link =
      (struct scene_link){built->box, built->below, linking->parent, {SCENE_NO_LINK, SCENE_NO_LINK}, built->height, 0};
  if (built->triangle_count)
    return;
  link->child[0] = linking->index + 1;
  link->child[1] = link->child[0] + built->child[0]->nodes;
  for (int i = 0; i < 2; i++) {
    struct linking below = *linking, *task = NULL;
    below.built = built->child[i], below.index = link->child[i], below.parent = linking->index;
    if (i == 0 && below.built->nodes >= LEAST_OF_LINKING && (task = malloc(sizeof *task))) {
      *task = below;
      if (scene_crew_add(linking->crew, link_task, task))
        continue;
      free(task);
    }
    link_built(&below);
  }
  if (built->nodes < LEAST_OF_LINKING)
    link->box = scene_join_boxes(&nodes[link->child[0]].box, &nodes[link->child[1]].box);
}

static void link_task(struct scene_worker *worker, void *pointer) {
  (void)worker;
  link_built(pointer);
  free(pointer);
}

static void link_first(struct scene_worker *worker, void *pointer) {
  (void)worker;
  link_built(pointer);
}

static void bound_large(const struct linking *linking, uint32_t index) {
  struct scene_link *nodes = linking->links->nodes, *link = &nodes[index];
  if (linking->of[index]->nodes < LEAST_OF_LINKING)
    return;
  for (int i = 0; i < 2; i++)
    bound_large(linking, link->child[i]);
  link->box = scene_join_boxes(&nodes[link->child[0]].box, &nodes[link->child[1]].box);
}

/* Improves the tree and numbers its nodes. */
static trax_status improve(struct scene_numbering *numbering, struct built_node *root, struct scene_crew *crew,
                           const struct trax_build_options *options, trax_error *error) {
  struct scene_links links = {.nodes = scene_allocate(root->nodes * sizeof *links.nodes),
                              .count = root->nodes,
                              .max_depth = numbering->max_depth};
  struct built_node **of = malloc(root->nodes * sizeof(struct built_node *));
  trax_status result = links.nodes && of ? TRAX_OK : scene_out_of_memory(error, "BVH");
  if (result == TRAX_OK) {
    struct linking all = {&links, of, crew, root, 0, SCENE_NO_LINK};
    scene_crew_run(crew, link_first, &all);
    bound_large(&all, 0);
    result = scene_reinsert(&links, options->passes, crew, options, error);
  }
  if (result == TRAX_OK && !scene_number_links(numbering, &links, of))
    result = scene_out_of_memory(error, "BVH");
  free(links.nodes);
  free(of);
  return result;
}

static trax_status make_tree(struct scene_tree *tree, struct built_node *root, const struct trax_mesh *mesh,
                             const struct scene_duplicates *duplicates, unsigned max_depth, unsigned max_leaf,
                             struct scene_crew *crew, const struct trax_build_options *options, trax_error *error) {
  struct scene_numbering numbering = {tree, mesh, duplicates, max_depth, max_leaf, NULL};
  if (!scene_measure_built(&numbering, root) || scene_least_height(mesh->triangle_count, max_leaf) > max_depth)
    return trax_fail(error, "BVH: there is no tree of at most %u levels with at most %u triangles in a leaf", max_depth,
                     max_leaf);
  numbering.triangles = malloc(root->below * sizeof *numbering.triangles);
  /* A binary tree over n triangles has at most 2n - 1 nodes. */
  tree->nodes = malloc(2 * (size_t)root->below * sizeof *tree->nodes);
  trax_status result = TRAX_OK;
  if (!numbering.triangles || !tree->nodes)
    result = scene_out_of_memory(error, "BVH");
  else if (options->passes && !root->triangle_count && root->height <= max_depth) /* else subtrees are rebuilt */
    result = improve(&numbering, root, crew, options, error);
  else if (!scene_number_built(&numbering, root))
    result = scene_out_of_memory(error, "BVH");
  free(numbering.triangles);
  return result == TRAX_OK && scene_is_interrupted(options->interrupt) ? TRAX_INTERRUPTED : result;
}

static trax_status check_options(const struct trax_build_options *options, trax_error *error) {
  if (options->max_leaf > TRAX_SCENE_MAX_LEAF)
    return trax_fail(error, "the leaf size is at most %u triangles, not %u", TRAX_SCENE_MAX_LEAF, options->max_leaf);
  if (options->max_depth > TRAX_SCENE_MAX_DEPTH)
    return trax_fail(error, "the depth is at most %u nodes, not %u", TRAX_SCENE_MAX_DEPTH, options->max_depth);
  if (options->passes > TRAX_SCENE_MAX_PASSES)
    return trax_fail(error, "the tree is improved in at most %u passes, not %u", TRAX_SCENE_MAX_PASSES,
                     options->passes);
  if (options->cache_lines > 4096) /* the search for the largest node is linear in it */
    return trax_fail(error, "nodes can be ordered for at most 4096 lines of cache, not %u", options->cache_lines);
  if (!(options->traversal_cost >= 0 && isfinite(options->traversal_cost)))
    return trax_fail(error, "the cost of a node is a positive number");
  if (!(options->crease_degrees >= 0 && options->crease_degrees <= 180))
    return trax_fail(error, "the crease is an angle up to 180 degrees, not %g", (double)options->crease_degrees);
  if (!(options->splits == 0 || (options->splits >= 1 && options->splits <= TRAX_SCENE_MAX_SPLITS)))
    return trax_fail(error, "splits make room for 1 to %g times the triangles, not %g", (double)TRAX_SCENE_MAX_SPLITS,
                     (double)options->splits);
  return TRAX_OK;
}

/* Decides about splits. Finds the duplicates if that depends on them. */
static trax_status choose_splits(float *factor, struct scene_duplicates *duplicates, const struct trax_mesh *mesh,
                                 const struct trax_build_options *options, trax_error *error) {
  *factor = options->choose_splits ? 0 : options->splits;
  if (options->choose_splits ? !scene_splits_may_suit(mesh) : *factor <= 1)
    return TRAX_OK;
  if (!options->choose_splits && scene_check_emitters(mesh, error) != TRAX_OK)
    return TRAX_ERROR;
  bool suit = false;
  trax_status result = scene_find_duplicates(duplicates, mesh, error);
  if (result == TRAX_OK && options->choose_splits) {
    result = scene_splits_suit(&suit, mesh, duplicates, error);
    *factor = suit ? TRAX_DEFAULT_SPLITS : 0;
  }
  return result;
}

/* Looks for duplicates while the tree is built, as nothing needs them before. */
struct looking {
  const struct trax_mesh *mesh;
  bool unique;
};

static void look_for_duplicates(struct scene_worker *worker, void *pointer) {
  (void)worker;
  struct looking *looking = pointer;
  struct scene_duplicates duplicates;
  looking->unique = scene_find_duplicates(&duplicates, looking->mesh, NULL) == TRAX_OK && !duplicates.any;
  scene_duplicates_release(&duplicates);
}

trax_status scene_build_tree(struct scene_tree *tree, const struct trax_mesh *mesh,
                             const struct trax_build_options *options, trax_error *error) {
  *tree = (struct scene_tree){0};
  trax_status result = check_options(options, error);
  if (result != TRAX_OK || (mesh->triangle_count == 0 && !options->tree_nodes))
    return result;
  if (options->tree_nodes) {
    result = scene_read_tree(tree, mesh, options, error);
    if (result != TRAX_OK)
      scene_tree_release(tree);
    return result;
  }
  float factor;
  struct scene_duplicates duplicates = {0};
  result = choose_splits(&factor, &duplicates, mesh, options, error);
  if (result != TRAX_OK) {
    scene_duplicates_release(&duplicates);
    return result;
  }
  const bool splits = factor > 1, looked = duplicates.first;
  tree->unique = looked && !duplicates.any;
  if (!splits)
    scene_duplicates_release(&duplicates);
  struct trax_build_options chosen = *options; /* with the choices made */
  chosen.splits = factor;
  options = &chosen;
  unsigned max_depth = options->max_depth ? options->max_depth : default_max_depth;
  const size_t capacity = splits ? (size_t)(factor * (double)mesh->triangle_count) : mesh->triangle_count;
  struct sah_prim *primitives = aligned_alloc(_Alignof(struct sah_prim), capacity * sizeof *primitives);
  struct scene_crew *crew = scene_crew_new(options->threads);
  if (!primitives || !crew)
    result = scene_out_of_memory(error, "BVH");
  else {
    const uint32_t count = fill_primitives(primitives, mesh, splits ? &duplicates : NULL);
    tree->bounds = bounds_of(primitives, count);
    tree->split = splits;
    const struct sah_arguments arguments = {.options = options,
                                            .mesh = mesh,
                                            .prims = primitives,
                                            .count = count,
                                            .capacity = splits ? capacity : count,
                                            .max_depth = BUILDER_DEPTH,
                                            .max_leaf = options->max_leaf ? options->max_leaf : default_max_leaf,
                                            .traversal_cost = options->traversal_cost > 0 ? options->traversal_cost
                                                                                          : default_traversal_cost};
    struct looking looking = {mesh, tree->unique};
    if (!looked)
      scene_crew_add(crew, look_for_duplicates, &looking);
    struct built_node *root = scene_build_sah(&arguments, crew);
    tree->unique = looking.unique;
    free(primitives);
    primitives = NULL;
    if (scene_is_interrupted(options->interrupt))
      result = TRAX_INTERRUPTED;
    else if (!root)
      result = scene_out_of_memory(error, "BVH");
    else
      result =
          make_tree(tree, root, mesh, splits ? &duplicates : NULL, max_depth, arguments.max_leaf, crew, options, error);
  }
  free(primitives);
  scene_duplicates_release(&duplicates);
  scene_crew_release(crew);
  if (result != TRAX_OK)
    scene_tree_release(tree);
  return result;
}

void scene_tree_release(struct scene_tree *tree) {
  free(tree->nodes);
  *tree = (struct scene_tree){0};
}
