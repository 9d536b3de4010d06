/* The grid of quantised planes: its choice, and whether it suits a tree. */
#include "layouts.h"

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

struct scene_box scene_box_in_cells(const struct trax_scene_grid *grid, const struct scene_box *box) {
  struct scene_box result;
  for (int axis = 0; axis < 3; axis++) {
    const double origin = grid->origin[axis], cell = grid->cell[axis];
    result.min[axis] = cell_below((box->min[axis] - origin) / cell);
    result.max[axis] = cell_above((box->max[axis] - origin) / cell);
  }
  return result;
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
  const struct scene_box cells = scene_box_in_cells(grid, box);
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
