/* The boxes of a tree of another builder, and the parts of triangles that they make (docs/own-tree.md). */
#include "own_tree.h"

#include <inttypes.h>
#include <math.h>

enum { PLANES = 6 };

trax_status scene_read_row_box(struct scene_box *box, const struct scene_tree_reading *reading, uint64_t node,
                               trax_error *error) {
  for (unsigned plane = 0; plane < PLANES; plane++)
    (plane < 3 ? box->min : box->max)[plane % 3] = scene_npy_float(&reading->boxes, node * PLANES + plane);
  for (int axis = 0; axis < 3; axis++)
    if (!(box->min[axis] <= box->max[axis]) || !isfinite(box->min[axis]) || !isfinite(box->max[axis]))
      return trax_fail(error, "%s: node %" PRIu64 ": its box is from %g to %g on axis %d", reading->boxes.path, node,
                       (double)box->min[axis], (double)box->max[axis], axis);
  return TRAX_OK;
}

bool scene_box_contains(const struct scene_box *outer, const struct scene_box *inner) {
  for (int axis = 0; axis < 3; axis++)
    if (inner->min[axis] < outer->min[axis] || inner->max[axis] > outer->max[axis])
      return false;
  return true;
}

static struct scene_box triangle_box(const struct trax_mesh *mesh, uint32_t triangle, const float *corners[3]) {
  struct scene_box box = scene_empty_box();
  for (int corner = 0; corner < 3; corner++) {
    corners[corner] = mesh->vertices[mesh->triangles[triangle].vertices[corner]];
    scene_box_add_point(&box, corners[corner]);
  }
  return box;
}

/* Adds the part of the triangle that is in the leaf to its box. */
static trax_status add_part(struct scene_tree_node *leaf, const struct scene_tree_reading *reading, uint64_t node,
                            uint32_t triangle, trax_error *error) {
  const float *corners[3];
  struct scene_box part = triangle_box(reading->mesh, triangle, corners), box;
  if (reading->has_boxes) {
    if (scene_read_row_box(&box, reading, node, error) != TRAX_OK)
      return TRAX_ERROR;
    if (!scene_box_contains(&box, &part)) {
      if (reading->copies[triangle] == 1)
        return trax_fail(error,
                         "%s: node %" PRIu64 ": triangle %" PRIu32 ", which no other leaf has, is not within its box",
                         reading->boxes.path, node, triangle);
      for (int axis = 0; axis < 3; axis++)
        if (part.min[axis] > box.max[axis] || part.max[axis] < box.min[axis])
          return trax_fail(error, "%s: node %" PRIu64 ": triangle %" PRIu32 " is not in its box", reading->boxes.path,
                           node, triangle);
      const struct scene_box whole = part;
      part = scene_clip_triangle(corners, &box);
      for (int axis = 0; axis < 3; axis++) { /* it was rounded outwards, even beyond the triangle */
        part.min[axis] = fmaxf(part.min[axis], whole.min[axis]);
        part.max[axis] = fminf(part.max[axis], whole.max[axis]);
      }
    }
  }
  scene_box_add_box(&leaf->box, &part);
  return TRAX_OK;
}

trax_status scene_find_leaf_boxes(struct scene_tree_reading *reading, trax_error *error) {
  struct scene_tree *tree = reading->tree;
  tree->bounds = scene_empty_box();
  for (uint32_t i = 0; i < tree->node_count; i++)
    for (uint32_t t = 0; t < tree->nodes[i].triangle_count; t++) {
      const float *corners[3];
      const struct scene_box whole = triangle_box(reading->mesh, tree->nodes[i].triangles[t], corners);
      scene_box_add_box(&tree->bounds, &whole);
      if (add_part(&tree->nodes[i], reading, reading->rows[i], tree->nodes[i].triangles[t], error) != TRAX_OK)
        return TRAX_ERROR;
    }
  return TRAX_OK;
}
