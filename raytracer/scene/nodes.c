/* The layouts of nodes (scene_format.h): from boxes to records and back. */
#include "internal.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

const struct trax_node_format trax_node_formats[TRAX_NODE_LAYOUTS] = {
    [TRAX_NODES_BINARY] = {"binary", sizeof(struct trax_bvh_node), 2, false, sizeof(float)},
    [TRAX_NODES_QUANTISED] = {"quantised", sizeof(struct trax_quantised_node), 2, true, sizeof(uint16_t)},
    [TRAX_NODES_WIDE4] = {"wide4", sizeof(struct trax_wide4_node), 4, false, sizeof(float)},
    [TRAX_NODES_WIDE4_QUANTISED] = {"wide4-quantised", sizeof(struct trax_wide4_quantised_node), 4, true,
                                    sizeof(uint16_t)},
    [TRAX_NODES_WIDE8] = {"wide8", sizeof(struct trax_wide8_node), 8, false, sizeof(uint8_t)},
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

/* floor and ceil without a call where a 32-bit integer has the result, as all cells of a scene do. */
static inline float cell_below(double place) {
  return place >= 0 && place < INT32_MAX ? (float)(int32_t)place : (float)floor(place);
}

static inline float cell_above(double place) {
  if (!(place >= 0 && place < INT32_MAX))
    return (float)ceil(place);
  const int32_t whole = (int32_t)place;
  return (float)(whole + (whole < place));
}

/* Rounded outwards. */
static struct scene_box box_in_cells(const struct trax_scene_grid *grid, const struct scene_box *box) {
  struct scene_box result;
  for (int axis = 0; axis < 3; axis++) {
    const double origin = grid->origin[axis], cell = grid->cell[axis];
    result.min[axis] = cell_below((box->min[axis] - origin) / cell);
    result.max[axis] = cell_above((box->max[axis] - origin) / cell);
  }
  return result;
}

struct scene_box scene_box_as_stored(enum trax_node_layout layout, const struct trax_scene_grid *grid,
                                     const struct scene_box *box) {
  return trax_node_formats[layout].quantised ? box_in_cells(grid, box) : *box;
}

/* A view may show a small part of the scene. So in every part with more than a sixteenth of the leaves, the growth of
   visits is limited: the expected visits of lines that enter its box, relative to those with exact boxes. The growth
   over the whole scene says little, because small parts are rarely hit. */
#define LEAST_PART 16
#define MOST_GROWTH 2

struct visits {
  double exact, on_grid; /* by the surface-area heuristic, with exact boxes and with those on the grid */
  uint32_t leaves;
};

/* False if a part's visits grow by more. Recursion is bounded by the tree's depth, at most TRAX_SCENE_MAX_DEPTH. */
static bool count_visits(struct visits *visits, struct scene_box *box, const struct scene_tree *tree,
                         const struct trax_scene_grid *grid, uint32_t least_leaves, uint32_t index) {
  const struct scene_tree_node *node = &tree->nodes[index];
  *visits = (struct visits){.leaves = node->triangle_count > 0};
  *box = node->triangle_count ? node->box : scene_empty_box();
  bool suits = true;
  for (int i = 0; i < 2 && node->triangle_count == 0 && suits; i++) {
    struct visits below;
    struct scene_box part;
    suits = count_visits(&below, &part, tree, grid, least_leaves, node->child[i]);
    scene_box_add_box(box, &part);
    visits->exact += below.exact, visits->on_grid += below.on_grid, visits->leaves += below.leaves;
  }
  const struct scene_box cells = box_in_cells(grid, box);
  const double x = ((double)cells.max[0] - cells.min[0]) * grid->cell[0];
  const double y = ((double)cells.max[1] - cells.min[1]) * grid->cell[1];
  const double z = ((double)cells.max[2] - cells.min[2]) * grid->cell[2];
  const double tests = node->triangle_count ? node->triangle_count : 1;
  visits->exact += tests * scene_half_area(box->min, box->max);
  visits->on_grid += tests * (x * y + y * z + z * x);
  return suits && (visits->leaves < least_leaves || visits->on_grid <= MOST_GROWTH * visits->exact);
}

bool scene_grid_suits(const struct scene_tree *tree) {
  const struct trax_scene_grid grid = trax_scene_grid_of(tree->bounds.min, tree->bounds.max);
  struct visits visits;
  struct scene_box box;
  return count_visits(&visits, &box, tree, &grid, (tree->node_count - tree->inner_count) / LEAST_PART + 1, 0);
}

/* --- records --- */

static void write_plane(unsigned char *to, uint32_t bytes, float plane) {
  if (bytes == sizeof plane) {
    memcpy(to, &plane, sizeof plane);
    return;
  }
  const uint16_t number = (uint16_t)plane;
  memcpy(to, &number, sizeof number);
}

static float read_plane(const unsigned char *from, uint32_t bytes) {
  uint16_t number;
  float plane;
  if (bytes == sizeof plane) {
    memcpy(&plane, from, sizeof plane);
    return plane;
  }
  memcpy(&number, from, sizeof number);
  return number;
}

struct scene_box scene_box_around(const struct scene_node *node) {
  struct scene_box box = scene_empty_box();
  for (uint32_t i = 0; i < node->count; i++)
    scene_box_add_box(&box, &node->box[i]);
  return box;
}

void scene_node_write(void *bytes, enum trax_node_layout layout, const struct scene_node *node) {
  const struct trax_node_format *format = &trax_node_formats[layout];
  if (layout == TRAX_NODES_WIDE8) {
    scene_wide8_write(bytes, node);
    return;
  }
  const struct scene_box whole = scene_box_around(node);
  const struct scene_box inside_out = {{whole.max[0], whole.max[1], whole.max[2]},
                                       {whole.min[0], whole.min[1], whole.min[2]}};
  memset(bytes, 0, format->bytes);
  for (uint32_t i = 0; i < format->children; i++) {
    const struct scene_box *box = i < node->count ? &node->box[i] : &inside_out;
    unsigned char *plane = (unsigned char *)bytes + trax_node_box(format, i);
    for (int axis = 0; axis < 3; axis++, plane += format->plane_bytes) {
      write_plane(plane, format->plane_bytes, box->min[axis]);
      write_plane(plane + 3 * format->plane_bytes, format->plane_bytes, box->max[axis]);
    }
    if (i < node->count)
      memcpy((unsigned char *)bytes + trax_node_child(format, i), &node->child[i], sizeof *node->child);
  }
}

void scene_node_read(struct scene_node *node, enum trax_node_layout layout, const void *bytes) {
  const struct trax_node_format *format = &trax_node_formats[layout];
  if (layout == TRAX_NODES_WIDE8) {
    scene_wide8_read(node, bytes);
    return;
  }
  node->count = 0;
  for (uint32_t i = 0; i < format->children; i++) {
    const unsigned char *plane = (const unsigned char *)bytes + trax_node_box(format, i);
    for (int axis = 0; axis < 3; axis++, plane += format->plane_bytes) {
      node->box[i].min[axis] = read_plane(plane, format->plane_bytes);
      node->box[i].max[axis] = read_plane(plane + 3 * format->plane_bytes, format->plane_bytes);
    }
    memcpy(&node->child[i], (const unsigned char *)bytes + trax_node_child(format, i), sizeof *node->child);
    if (!node->child[i])
      break;
    node->count++;
  }
}

void scene_node_of(struct scene_node *node, const struct trax_scene *scene, uint32_t number) {
  const enum trax_node_layout layout = scene->header->node_layout;
  scene_node_read(node, layout, (const unsigned char *)scene->nodes + (size_t)number * trax_node_formats[layout].bytes);
}

struct scene_box scene_box_in_node(const struct trax_scene *scene, uint32_t number, const struct scene_box *box) {
  return scene->header->node_layout == TRAX_NODES_WIDE8
             ? scene_wide8_box((const struct trax_wide8_node *)scene->nodes + number, box)
             : *box;
}

uint32_t scene_stack_entries(enum trax_node_layout layout, uint32_t above, uint32_t children, uint32_t *most) {
  const uint32_t here = above + (layout == TRAX_NODES_WIDE8 ? 1 : children - 1);
  *most = here > *most ? here : *most;
  return here;
}

void trax_node_read(struct trax_node_children *children, const struct trax_scene *scene, uint32_t number) {
  const struct trax_node_format *format = &trax_node_formats[scene->header->node_layout];
  struct scene_node node;
  scene_node_of(&node, scene, number);
  children->count = node.count;
  memcpy(children->child, node.child, sizeof children->child);
  for (int axis = 0; axis < 3; axis++) {
    const double origin = format->quantised ? scene->grid.origin[axis] : 0;
    const double cell = format->quantised ? scene->grid.cell[axis] : 1;
    for (uint32_t i = 0; i < node.count; i++) {
      children->min[i][axis] = origin + node.box[i].min[axis] * cell;
      children->max[i][axis] = origin + node.box[i].max[axis] * cell;
    }
    children->cell[axis] = format->quantised ? cell : 0;
    if (scene->header->node_layout == TRAX_NODES_WIDE8)
      children->cell[axis] = scene_wide8_cell((const struct trax_wide8_node *)scene->nodes + number, axis);
  }
}
