/* The layouts of nodes (scene_format.h): from boxes to records and back. */
#include "internal.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

const struct trax_node_format trax_node_formats[TRAX_NODE_LAYOUTS] = {
    [TRAX_NODES_BINARY] = {"binary", sizeof(struct trax_bvh_node), 2, offsetof(struct trax_bvh_node, child), false, 8},
    [TRAX_NODES_QUANTISED] = {"quantised", sizeof(struct trax_quantised_node), 2,
                              offsetof(struct trax_quantised_node, child), true, 0},
};

bool trax_node_layout_choose(const char *name, struct trax_build_options *build) {
  build->choose_nodes = strcmp(name, "auto") == 0;
  for (unsigned i = 0; i < TRAX_NODE_LAYOUTS; i++)
    if (strcmp(name, trax_node_formats[i].name) == 0) {
      build->nodes = (enum trax_node_layout)i;
      return true;
    }
  return build->choose_nodes;
}

/* Cells are at least 2^-40 of the greatest coordinate, so that rays in their units are floats however flat the scene
   is, and have eight significant bits, so that binary64 has every plane. */
struct trax_scene_grid trax_scene_grid_of(const float bounds_min[3], const float bounds_max[3]) {
  double greatest = 0;
  for (int axis = 0; axis < 3; axis++)
    greatest = fmax(greatest, fmax(fabs((double)bounds_min[axis]), fabs((double)bounds_max[axis])));
  struct trax_scene_grid grid;
  for (int axis = 0; axis < 3; axis++) {
    const double extent = (double)bounds_max[axis] - bounds_min[axis];
    const double least = fmax(fmax(extent / (TRAX_GRID_LAST - 1), 0x1p-40 * greatest), 0x1p-149);
    const int exponent = ilogb(least) - 7 < -149 ? -149 : ilogb(least) - 7;
    grid.origin[axis] = bounds_min[axis];
    grid.cell[axis] = (float)ldexp(ceil(ldexp(least, -exponent)), exponent);
  }
  return grid;
}

struct scene_box scene_box_in_cells(const struct trax_scene_grid *grid, const struct scene_box *box) {
  struct scene_box result;
  for (int axis = 0; axis < 3; axis++) {
    const double origin = grid->origin[axis], cell = grid->cell[axis];
    result.min[axis] = (float)floor((box->min[axis] - origin) / cell);
    result.max[axis] = (float)ceil((box->max[axis] - origin) / cell);
  }
  return result;
}

/* A box grows by a cell on each axis, on average. Where it doubles a box in size, counted in sums of edges, a ray that
   comes near visits what it would have passed by. */
#define MOST_GROWN_BOXES 0.1

bool scene_grid_suits(const struct scene_tree *tree) {
  const struct trax_scene_grid grid = trax_scene_grid_of(tree->bounds.min, tree->bounds.max);
  const double growth = (double)grid.cell[0] + grid.cell[1] + grid.cell[2];
  uint32_t leaves = 0, grown = 0;
  for (uint32_t i = 0; i < tree->node_count; i++) {
    const struct scene_tree_node *node = &tree->nodes[i];
    if (node->triangle_count == 0)
      continue;
    double size = 0;
    for (int axis = 0; axis < 3; axis++)
      size += (double)node->box.max[axis] - node->box.min[axis];
    leaves++;
    grown += growth > size;
  }
  return grown <= MOST_GROWN_BOXES * leaves;
}

void scene_node_write(void *node, enum trax_node_layout layout, const struct trax_scene_grid *grid,
                      const struct scene_box boxes[], const trax_scene_ref children[]) {
  if (layout == TRAX_NODES_BINARY) {
    struct trax_bvh_node *out = node;
    for (int i = 0; i < 2; i++) {
      memcpy(out->box[i].min, boxes[i].min, sizeof boxes[i].min);
      memcpy(out->box[i].max, boxes[i].max, sizeof boxes[i].max);
      out->child[i] = children[i];
    }
    return;
  }
  struct trax_quantised_node *out = node;
  for (int i = 0; i < 2; i++) {
    const struct scene_box cells = scene_box_in_cells(grid, &boxes[i]);
    for (int axis = 0; axis < 3; axis++) {
      out->box[i].min[axis] = (uint16_t)cells.min[axis];
      out->box[i].max[axis] = (uint16_t)cells.max[axis];
    }
    out->child[i] = children[i];
  }
}

void scene_node_boxes(struct scene_box boxes[], trax_scene_ref children[], const struct trax_scene *scene,
                      uint32_t number) {
  const enum trax_node_layout layout = scene->header->node_layout;
  if (layout == TRAX_NODES_BINARY) {
    const struct trax_bvh_node *node = (const struct trax_bvh_node *)scene->nodes + number;
    for (int i = 0; i < 2; i++) {
      memcpy(boxes[i].min, node->box[i].min, sizeof boxes[i].min);
      memcpy(boxes[i].max, node->box[i].max, sizeof boxes[i].max);
      children[i] = node->child[i];
    }
    return;
  }
  const struct trax_quantised_node *node = (const struct trax_quantised_node *)scene->nodes + number;
  for (int i = 0; i < 2; i++) {
    for (int axis = 0; axis < 3; axis++) {
      boxes[i].min[axis] = node->box[i].min[axis];
      boxes[i].max[axis] = node->box[i].max[axis];
    }
    children[i] = node->child[i];
  }
}

void trax_node_read(struct trax_node_children *children, const struct trax_scene *scene, uint32_t number) {
  const struct trax_node_format *format = &trax_node_formats[scene->header->node_layout];
  struct scene_box boxes[TRAX_MAX_WIDTH] = {{{0}, {0}}};
  scene_node_boxes(boxes, children->child, scene, number);
  children->count = 0;
  for (uint32_t i = 0; i < format->width && children->child[i]; i++, children->count++)
    for (int axis = 0; axis < 3; axis++) {
      const double origin = format->quantised ? scene->grid.origin[axis] : 0;
      const double cell = format->quantised ? scene->grid.cell[axis] : 1;
      children->min[i][axis] = origin + boxes[i].min[axis] * cell;
      children->max[i][axis] = origin + boxes[i].max[axis] * cell;
    }
}
