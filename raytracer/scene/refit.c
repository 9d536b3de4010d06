/* The tree of an earlier scene file around the triangles of a mesh that has moved since: topology, leaves and the order
   of nodes stay, boxes are new (docs/motion.md). */
#include "internal.h"

#include <stdlib.h>
#include <string.h>

#define NOWHERE UINT32_MAX

struct refit {
  struct scene_tree *tree;
  const struct trax_mesh *mesh;
  const struct trax_scene *base;
  const char *name;  /* of the base */
  uint32_t *moved;   /* [triangles of the base]: the mesh's triangle; NOWHERE: it has no area now */
  uint32_t *kept;    /* [nodes of the base]: triangles below it that are still there */
  uint32_t *numbers; /* [nodes of the tree]: an inner node's number in the base */
};

/* --- triangles --- */

/* The mesh's triangle of this number in its files, or NOWHERE. The numbers rise. */
static uint32_t find_triangle(const struct trax_mesh *mesh, uint32_t source_id) {
  uint32_t low = 0, high = mesh->triangle_count;
  while (low < high) {
    const uint32_t middle = low + (high - low) / 2;
    if (mesh->triangles[middle].source_id < source_id)
      low = middle + 1;
    else
      high = middle;
  }
  return low < mesh->triangle_count && mesh->triangles[low].source_id == source_id ? low : NOWHERE;
}

static trax_status find_triangles(struct refit *refit, unsigned char *seen, trax_error *error) {
  const struct trax_mesh *mesh = refit->mesh;
  for (uint32_t i = 0; i < refit->base->triangle_count; i++) {
    const uint32_t triangle = find_triangle(mesh, refit->base->source_ids[i]);
    refit->moved[i] = triangle;
    if (triangle == NOWHERE)
      continue;
    if (seen[triangle])
      return trax_fail(error, "%s: triangle %u is in several leaves; build a tree to refit with --splits=1",
                       refit->name, refit->base->source_ids[i]);
    seen[triangle] = 1;
  }
  for (uint32_t i = 0; i < mesh->triangle_count; i++)
    if (!seen[i])
      return trax_fail(error,
                       "%s: it has no triangle %u of the mesh, because that was not there or had no area; its tree "
                       "cannot be refitted to the mesh",
                       refit->name, mesh->triangles[i].source_id);
  return TRAX_OK;
}

/* --- nodes --- */

static uint32_t leaf_of(const struct refit *refit, trax_scene_ref ref) {
  return (TRAX_SCENE_REF_OFFSET(ref) - refit->base->header->sections[TRAX_SCENE_TRIANGLES].offset) /
         (uint32_t)sizeof(struct trax_triangle);
}

static uint32_t node_of(const struct refit *refit, trax_scene_ref ref) {
  const struct trax_scene_header *header = refit->base->header;
  return (ref - header->sections[TRAX_SCENE_NODES].offset) / trax_node_formats[header->node_layout].bytes;
}

static void children_of(trax_scene_ref children[2], const struct refit *refit, uint32_t number) {
  struct scene_node node;
  scene_node_of(&node, refit->base, number);
  memcpy(children, node.child, 2 * sizeof *children);
}

/* Recursion, here and below, is bounded by the depth of the base. */
static uint32_t count_kept(struct refit *refit, trax_scene_ref ref) {
  uint32_t count = 0;
  for (uint32_t i = 0; i < TRAX_SCENE_REF_COUNT(ref); i++)
    count += refit->moved[leaf_of(refit, ref) + i] != NOWHERE;
  if (TRAX_SCENE_REF_COUNT(ref))
    return count;
  trax_scene_ref children[2];
  children_of(children, refit, node_of(refit, ref));
  for (int i = 0; i < 2; i++)
    count += count_kept(refit, children[i]);
  return refit->kept[node_of(refit, ref)] = count;
}

static bool is_empty(const struct refit *refit, trax_scene_ref ref) {
  if (!TRAX_SCENE_REF_COUNT(ref))
    return refit->kept[node_of(refit, ref)] == 0;
  for (uint32_t i = 0; i < TRAX_SCENE_REF_COUNT(ref); i++)
    if (refit->moved[leaf_of(refit, ref) + i] != NOWHERE)
      return false;
  return true;
}

static void fill_leaf(struct scene_tree_node *leaf, const struct refit *refit, trax_scene_ref ref) {
  struct scene_tree *tree = refit->tree;
  *leaf = (struct scene_tree_node){.triangle_count = 0};
  leaf->box = scene_empty_box();
  for (uint32_t i = 0; i < TRAX_SCENE_REF_COUNT(ref); i++) {
    const uint32_t triangle = refit->moved[leaf_of(refit, ref) + i];
    if (triangle == NOWHERE)
      continue;
    const struct scene_box box = scene_triangle_box(refit->mesh, triangle);
    scene_box_add_box(&leaf->box, &box);
    leaf->triangles[leaf->triangle_count++] = triangle;
  }
  scene_box_add_box(&tree->bounds, &leaf->box);
  tree->ref_count += leaf->triangle_count;
  if (leaf->triangle_count > tree->max_leaf)
    tree->max_leaf = leaf->triangle_count;
}

/* Appends a subtree depth first. A node with one child left gives way to it. */
static void add_subtree(struct refit *refit, trax_scene_ref ref, unsigned depth) {
  struct scene_tree *tree = refit->tree;
  trax_scene_ref children[2];
  while (!TRAX_SCENE_REF_COUNT(ref)) {
    children_of(children, refit, node_of(refit, ref));
    const bool empty[2] = {is_empty(refit, children[0]), is_empty(refit, children[1])};
    if (!empty[0] && !empty[1])
      break;
    ref = children[empty[0]];
  }
  const uint32_t place = tree->node_count++;
  if (TRAX_SCENE_REF_COUNT(ref)) {
    fill_leaf(&tree->nodes[place], refit, ref);
    return;
  }
  refit->numbers[place] = node_of(refit, ref);
  tree->inner_count++;
  if (depth + 1 > tree->max_depth)
    tree->max_depth = depth + 1;
  tree->nodes[place].triangle_count = 0;
  for (int i = 0; i < 2; i++) {
    tree->nodes[place].child[i] = tree->node_count;
    add_subtree(refit, children[i], depth + 1);
  }
}

/* The nodes' order in the base without the nodes that gave way. The root is first, whichever it is. */
static void find_positions(uint32_t *positions, struct refit *refit) {
  const struct scene_tree *tree = refit->tree;
  const uint32_t count = refit->base->node_count;
  uint32_t *ranks = refit->kept, next = 0;
  for (uint32_t i = 0; i < count; i++)
    ranks[i] = NOWHERE;
  refit->numbers[0] = 0;
  for (uint32_t i = 0; i < tree->node_count; i++)
    if (tree->nodes[i].triangle_count == 0)
      ranks[refit->numbers[i]] = i;
  for (uint32_t i = 0; i < count; i++)
    if (ranks[i] != NOWHERE)
      positions[ranks[i]] = next++;
}

static trax_status check_base(const struct refit *refit, const struct trax_build_options *options, trax_error *error) {
  if (!refit->base->source_ids || !refit->base->node_count)
    return trax_fail(error, "%s: a scene %s has nothing to refit", refit->name,
                     refit->base->source_ids ? "without nodes" : "without the triangles' numbers");
  if (refit->base->instance_count)
    return trax_fail(error, "%s: a scene with instances has no tree to refit (--flatten)", refit->name);
  if (trax_node_formats[refit->base->header->node_layout].children > 2)
    return trax_fail(error, "%s: only binary and quantised nodes are refitted; its nodes are %s", refit->name,
                     trax_node_formats[refit->base->header->node_layout].name);
  if (!options->choose_nodes && options->nodes != refit->base->header->node_layout)
    return trax_fail(error, "%s: its nodes are %s; a tree that is refitted keeps its layout", refit->name,
                     trax_node_formats[refit->base->header->node_layout].name);
  return TRAX_OK;
}

trax_status scene_refit_tree(struct scene_tree *tree, uint32_t **positions, const struct trax_mesh *mesh,
                             const struct trax_build_options *options, trax_error *error) {
  struct refit refit = {.tree = tree, .mesh = mesh, .base = options->refit, .name = options->refit_name};
  *tree = (struct scene_tree){.bounds = scene_empty_box()};
  *positions = NULL;
  if (check_base(&refit, options, error) != TRAX_OK)
    return TRAX_ERROR;
  const size_t nodes = 2 * (size_t)refit.base->triangle_count; /* more than a binary tree has */
  unsigned char *seen = calloc(mesh->triangle_count + (size_t)1, 1);
  refit.moved = malloc((refit.base->triangle_count + (size_t)1) * sizeof *refit.moved);
  refit.kept = calloc(refit.base->node_count + (size_t)1, sizeof *refit.kept);
  refit.numbers = malloc(nodes * sizeof *refit.numbers);
  tree->nodes = malloc(nodes * sizeof *tree->nodes);
  *positions = calloc(nodes, sizeof **positions);
  trax_status result = seen && refit.moved && refit.kept && refit.numbers && tree->nodes && *positions
                           ? find_triangles(&refit, seen, error)
                           : scene_out_of_memory(error, "BVH");
  if (result == TRAX_OK) {
    count_kept(&refit, refit.base->header->root);
    add_subtree(&refit, refit.base->header->root, 0);
    find_positions(*positions, &refit);
  } else {
    scene_tree_release(tree);
    free(*positions);
    *positions = NULL;
  }
  free(seen);
  free(refit.moved);
  free(refit.kept);
  free(refit.numbers);
  return result;
}
