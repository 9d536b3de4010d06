/* Checks the tree of a scene file: each node and triangle is in it once, and boxes are those of the triangles. */
#include "internal.h"

#include <stdlib.h>
#include <string.h>

struct checker {
  const char *name;
  trax_error *error;
  const struct trax_scene *view;
  uint32_t nodes_offset, nodes_size, triangles_offset, triangles_size;
  unsigned char *node_seen; /* one byte for each node */
  uint32_t nodes_left, next_triangle;
  uint32_t max_depth, max_leaf; /* found */
  struct scene_box bounds;      /* of all triangles */
  struct scene_range *ranges;   /* of each node */
  uint32_t *in_part;            /* of each triangle: the place of a box that does not contain it, or 0 */
  bool any_in_part;
};

static trax_status check_leaf(struct checker *checker, trax_scene_ref ref, struct scene_box *box) {
  const struct trax_scene *view = checker->view;
  uint32_t offset = TRAX_SCENE_REF_OFFSET(ref), count = TRAX_SCENE_REF_COUNT(ref);
  if (offset < checker->triangles_offset || offset - checker->triangles_offset >= checker->triangles_size ||
      (offset - checker->triangles_offset) % sizeof(struct trax_triangle) != 0)
    return trax_fail(checker->error, "%s: reference %08x is to no triangle", checker->name, ref);
  uint32_t first = (offset - checker->triangles_offset) / (uint32_t)sizeof(struct trax_triangle);
  if (count > view->triangle_count - first)
    return trax_fail(checker->error, "%s: reference %08x is to triangles behind the last", checker->name, ref);
  /* Leaf order is depth first: each of the file's triangles is in one leaf if every leaf begins where the one before
     ended. */
  if (first != checker->next_triangle)
    return trax_fail(checker->error, "%s: reference %08x is to triangle %u where %u is next", checker->name, ref, first,
                     checker->next_triangle);
  checker->next_triangle += count;
  if (count > checker->max_leaf)
    checker->max_leaf = count;
  for (uint32_t i = first; i < first + count; i++) {
    scene_box_add_point(box, view->triangles[i].v0);
    scene_box_add_point(box, view->triangles[i].v1);
    scene_box_add_point(box, view->triangles[i].v2);
  }
  return TRAX_OK;
}

static bool same_box(const struct scene_box *a, const struct scene_box *b) {
  for (int axis = 0; axis < 3; axis++)
    if (a->min[axis] != b->min[axis] || a->max[axis] != b->max[axis])
      return false;
  return true;
}

static bool box_within(const struct scene_box *inner, const struct scene_box *outer) {
  for (int axis = 0; axis < 3; axis++)
    if (!(inner->min[axis] >= outer->min[axis] && inner->max[axis] <= outer->max[axis]))
      return false;
  return true;
}

static struct scene_box as_stored(const struct checker *checker, const struct scene_box *box) {
  return scene_box_as_stored(checker->view->header->node_layout, &checker->view->grid, box);
}

/* Notes the triangles of a leaf that its box does not contain. Each must be in other leaves, too. `place`: of the box.
 */
static void note_parts(struct checker *checker, trax_scene_ref ref, const struct scene_box *stored, uint32_t place) {
  const uint32_t first =
      (TRAX_SCENE_REF_OFFSET(ref) - checker->triangles_offset) / (uint32_t)sizeof(struct trax_triangle);
  for (uint32_t i = first; i < first + TRAX_SCENE_REF_COUNT(ref); i++) {
    struct scene_box box = scene_empty_box();
    scene_box_add_point(&box, checker->view->triangles[i].v0);
    scene_box_add_point(&box, checker->view->triangles[i].v1);
    scene_box_add_point(&box, checker->view->triangles[i].v2);
    box = as_stored(checker, &box);
    if (!box_within(&box, stored)) {
      checker->in_part[i] = place + 1;
      checker->any_in_part = true;
    }
  }
}

static trax_status wrong_box(const struct checker *checker, uint32_t place) {
  return trax_fail(checker->error, "%s: node %u: box %u is not that of its triangles", checker->name, place / 2,
                   place % 2);
}

/* Checks the subtree below ref, with `depth` nodes above it. *box receives the box that must be stored for it; that of
   a leaf may be smaller. The recursion ends, because a node is entered once and the depth is limited. */
static trax_status check_subtree(struct checker *checker, trax_scene_ref ref, unsigned depth, struct scene_box *box) {
  if (TRAX_SCENE_REF_COUNT(ref)) {
    struct scene_box exact = scene_empty_box();
    trax_status result = check_leaf(checker, ref, &exact);
    scene_box_add_box(&checker->bounds, &exact);
    *box = as_stored(checker, &exact);
    return result;
  }
  const struct trax_node_format *format = &trax_node_formats[checker->view->header->node_layout];
  if (ref < checker->nodes_offset || ref - checker->nodes_offset >= checker->nodes_size ||
      (ref - checker->nodes_offset) % format->bytes != 0)
    return trax_fail(checker->error, "%s: reference %08x is to no node", checker->name, ref);
  uint32_t number = (ref - checker->nodes_offset) / format->bytes;
  if (checker->node_seen[number])
    return trax_fail(checker->error, "%s: node %u is referred to twice", checker->name, number);
  checker->node_seen[number] = 1;
  checker->nodes_left--;
  if (++depth > TRAX_SCENE_MAX_DEPTH)
    return trax_fail(checker->error, "%s: node %u is deeper than %u", checker->name, number, TRAX_SCENE_MAX_DEPTH);
  static const unsigned char zeros[sizeof(struct trax_bvh_node)];
  const uint32_t used = trax_node_child(format, 2);
  if (memcmp((const unsigned char *)checker->view->nodes + (size_t)number * format->bytes + used, zeros,
             format->bytes - used) != 0)
    return trax_fail(checker->error, "%s: node %u: reserved words are not zero", checker->name, number);
  struct scene_box boxes[2];
  trax_scene_ref children[2];
  scene_node_boxes(boxes, children, checker->view, number);
  if (!children[0] || !children[1])
    return trax_fail(checker->error, "%s: node %u: fewer than two children", checker->name, number);
  if (depth > checker->max_depth)
    checker->max_depth = depth;
  checker->ranges[number].first = checker->next_triangle;
  for (uint32_t i = 0; i < 2; i++) {
    struct scene_box expected = scene_empty_box();
    trax_status result = check_subtree(checker, children[i], depth, &expected);
    if (result != TRAX_OK)
      return result;
    if (!same_box(&boxes[i], &expected)) {
      if (!TRAX_SCENE_REF_COUNT(children[i]) || !box_within(&boxes[i], &expected))
        return wrong_box(checker, 2 * number + i);
      note_parts(checker, children[i], &boxes[i], 2 * number + i);
    }
  }
  *box = scene_box_around(boxes);
  checker->ranges[number].end = checker->next_triangle;
  return TRAX_OK;
}

/* With room for the notes of each node and triangle. */
static trax_status check_whole_tree(struct checker *checker) {
  struct scene_box root;
  trax_status result = check_subtree(checker, checker->view->header->root, 0, &root);
  if (result != TRAX_OK || !checker->any_in_part)
    return result;
  const struct scene_parts parts = {checker->view, checker->ranges, checker->in_part};
  uint32_t bad;
  result = scene_check_parts(&parts, &bad, checker->error);
  if (result == TRAX_OK && bad != UINT32_MAX)
    result = wrong_box(checker, checker->in_part[bad] - 1);
  return result;
}

static trax_status check_tree(struct checker *checker) {
  const struct trax_scene_header *header = checker->view->header;
  struct scene_box bounds = scene_empty_box();
  if (header->triangle_count == 0) {
    if (header->root != 0 || checker->view->node_count != 0)
      return trax_fail(checker->error, "%s: a tree without triangles", checker->name);
    bounds = (struct scene_box){0};
  } else {
    checker->nodes_left = checker->view->node_count;
    checker->bounds = bounds;
    checker->node_seen = calloc(checker->view->node_count + (size_t)1, 1);
    checker->ranges = calloc(checker->view->node_count + (size_t)1, sizeof *checker->ranges);
    checker->in_part = calloc(header->triangle_count, sizeof *checker->in_part);
    trax_status result = checker->node_seen && checker->ranges && checker->in_part
                             ? check_whole_tree(checker)
                             : scene_out_of_memory(checker->error, checker->name);
    free(checker->node_seen);
    free(checker->ranges);
    free(checker->in_part);
    if (result != TRAX_OK)
      return result;
    bounds = checker->bounds;
    if (checker->nodes_left != 0)
      return trax_fail(checker->error, "%s: %u nodes are not in the tree", checker->name, checker->nodes_left);
    if (checker->next_triangle != header->triangle_count)
      return trax_fail(checker->error, "%s: %u triangles are in no leaf", checker->name,
                       header->triangle_count - checker->next_triangle);
  }
  if (checker->max_depth != header->max_depth || checker->max_leaf != header->max_leaf)
    return trax_fail(checker->error, "%s: depth %u and leaves of %u, where its header says %u and %u", checker->name,
                     checker->max_depth, checker->max_leaf, header->max_depth, header->max_leaf);
  for (int axis = 0; axis < 3; axis++)
    if (header->bounds_min[axis] != bounds.min[axis] || header->bounds_max[axis] != bounds.max[axis])
      return trax_fail(checker->error, "%s: the bounds are not those of its triangles", checker->name);
  return TRAX_OK;
}

trax_status scene_check_tree(const struct trax_scene *view, const char *name, trax_error *error) {
  const struct trax_scene_section *sections = view->header->sections;
  struct checker checker = {.name = name,
                            .error = error,
                            .view = view,
                            .nodes_offset = sections[TRAX_SCENE_NODES].offset,
                            .nodes_size = sections[TRAX_SCENE_NODES].size,
                            .triangles_offset = sections[TRAX_SCENE_TRIANGLES].offset,
                            .triangles_size = sections[TRAX_SCENE_TRIANGLES].size};
  return check_tree(&checker);
}
