/* The layouts of nodes (scene_format.h): from boxes to records and back. */
#include "internal.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define FORMAT(NAME, STRUCT, WIDTH, PLANE_BYTES, FIRST_BOX, RESERVED)                                                  \
  {.name = (NAME),                                                                                                     \
   .bytes = sizeof(struct STRUCT),                                                                                     \
   .width = (WIDTH),                                                                                                   \
   .quantised = (PLANE_BYTES) != sizeof(float),                                                                        \
   .reserved_bytes = (RESERVED),                                                                                       \
   .first_box = (FIRST_BOX),                                                                                           \
   .plane_bytes = (PLANE_BYTES)}

const struct trax_node_format trax_node_formats[TRAX_NODE_LAYOUTS] = {
    [TRAX_NODES_BINARY] = FORMAT("binary", trax_bvh_node, 2, 4, 0, 8),
    [TRAX_NODES_QUANTISED] = FORMAT("quantised", trax_quantised_node, 2, 2, 0, 0),
    [TRAX_NODES_WIDE] = FORMAT("wide", trax_wide_node, 4, 4, 0, 16),
    [TRAX_NODES_WIDE_QUANTISED] = FORMAT("wide-quantised", trax_wide_quantised_node, 4, 2, 0, 0),
    [TRAX_NODES_WIDE_QUANTISED8] = FORMAT("wide-quantised8", trax_wide_quantised8_node, 4, 1, 12, 12),
    [TRAX_NODES_QUANTISED8] = FORMAT("quantised8", trax_quantised8_node, 2, 1, 12, 0),
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

/* Rounded outwards to multiples of `finest` cells. */
static struct scene_box box_in_cells(const struct trax_scene_grid *grid, const struct scene_box *box, double finest) {
  struct scene_box result;
  for (int axis = 0; axis < 3; axis++) {
    const double origin = grid->origin[axis], cell = grid->cell[axis];
    result.min[axis] = (float)(floor((box->min[axis] - origin) / cell / finest) * finest);
    result.max[axis] = (float)(ceil((box->max[axis] - origin) / cell / finest) * finest);
  }
  return result;
}

struct scene_box scene_box_as_stored(enum trax_node_layout layout, const struct trax_scene_grid *grid,
                                     const struct scene_box *box) {
  const struct trax_node_format *format = &trax_node_formats[layout];
  return !format->quantised ? *box : box_in_cells(grid, box, format->plane_bytes == 1 ? (double)TRAX_FINEST_CELL : 1);
}

/* A view may show a small part of the scene, so every part counts that holds more than a sixteenth of the leaves: lines
   that enter its box visit so many nodes and triangles, in multiples of its exact tree's, at most. Over the whole
   scene the growth says nothing: what is small is hardly ever hit. */
#define LEAST_PART 16
#define MOST_GROWTH 2

struct visits {
  double exact, on_grid; /* by the surface-area heuristic, with exact boxes and with those on the grid */
  uint32_t leaves;
};

/* False: a part's visits grow by more. Recursion is bounded by the tree's depth, at most TRAX_SCENE_MAX_DEPTH. */
static bool count_visits(struct visits *visits, struct scene_box *box, const struct scene_tree *tree,
                         const struct trax_scene_grid *grid, uint32_t least_leaves, uint32_t index) {
  const struct scene_tree_node *node = &tree->nodes[index];
  *visits = (struct visits){.leaves = node->triangle_count > 0};
  *box = node->triangle_count ? node->box : scene_empty_box();
  bool suits = true;
  for (int i = 0; i < 2 && node->triangle_count == 0 && suits; i++) { /* it is not widened yet */
    struct visits below;
    struct scene_box part;
    suits = count_visits(&below, &part, tree, grid, least_leaves, node->child[i]);
    scene_box_add_box(box, &part);
    visits->exact += below.exact, visits->on_grid += below.on_grid, visits->leaves += below.leaves;
  }
  const struct scene_box cells = box_in_cells(grid, box, 1);
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

/* One axis of a node's frame. Of layouts that have none planes are where their numbers say. */
struct axis_frame {
  float first, step;
};

#define FRAME_BITS 0x47800000u /* of 65536.0f: the word's upper bits */
#define FRAME_GREATEST 9       /* e, for the whole grid */

static struct axis_frame frame_of(uint32_t word) {
  float biased;
  memcpy(&biased, &word, sizeof biased);
  return (struct axis_frame){biased - TRAX_FRAME_BIAS, ldexpf(1, (int)(word & 511) - TRAX_FRAME_EXPONENT)};
}

/* As scene_format.h says; both in cells, within the grid. Every e leaves a p of low or less. */
static uint32_t frame_around(float low, float high) {
  for (int exponent = TRAX_FRAME_LEAST;; exponent++) {
    const uint32_t rest = (uint32_t)(exponent + TRAX_FRAME_EXPONENT);
    const double fours = fmin(floor(((double)TRAX_FRAME_BIAS - 65536 + low - rest / 128.0) / 4), (1 << 14) - 1);
    const uint32_t word = FRAME_BITS | (uint32_t)fours << 9 | rest;
    const struct axis_frame frame = frame_of(word);
    if (high - frame.first <= 255 * frame.step)
      return word;
  }
}

static void read_frames(struct axis_frame frames[3], const struct trax_node_format *format, const unsigned char *node) {
  for (int axis = 0; axis < 3; axis++) {
    uint32_t word;
    memcpy(&word, node + sizeof word * (size_t)axis, sizeof word);
    frames[axis] = format->plane_bytes == 1 ? frame_of(word) : (struct axis_frame){0, 1};
  }
}

static void write_plane(unsigned char *to, uint32_t bytes, float number) {
  if (bytes == sizeof number) {
    memcpy(to, &number, sizeof number);
    return;
  }
  for (uint32_t i = 0; i < bytes; i++)
    to[i] = (unsigned char)((uint32_t)number >> 8 * i);
}

static float read_plane(const unsigned char *from, uint32_t bytes) {
  float number;
  if (bytes == sizeof number)
    memcpy(&number, from, sizeof number);
  else
    number = (float)(bytes == 1 ? from[0] : from[0] | from[1] << 8);
  return number;
}

bool scene_node_has_frame(const struct trax_scene *scene, uint32_t number) {
  const struct trax_node_format *format = &trax_node_formats[scene->header->node_layout];
  bool good = true;
  for (int axis = 0; axis < 3 && format->plane_bytes == 1; axis++) {
    uint32_t word;
    memcpy(&word, (const unsigned char *)scene->nodes + (size_t)number * format->bytes + sizeof word * (size_t)axis,
           sizeof word);
    const int exponent = (int)(word & 511) - TRAX_FRAME_EXPONENT;
    good = good && word >> 23 == FRAME_BITS >> 23 && exponent >= TRAX_FRAME_LEAST && exponent <= FRAME_GREATEST;
  }
  return good;
}

struct scene_box scene_box_in_frame(const struct trax_scene *scene, uint32_t number, const struct scene_box *box) {
  const struct trax_node_format *format = &trax_node_formats[scene->header->node_layout];
  if (format->plane_bytes != 1)
    return *box;
  struct axis_frame frames[3];
  struct scene_box result;
  read_frames(frames, format, (const unsigned char *)scene->nodes + (size_t)number * format->bytes);
  for (int axis = 0; axis < 3; axis++) {
    const struct axis_frame *frame = &frames[axis];
    result.min[axis] = frame->first + floorf((box->min[axis] - frame->first) / frame->step) * frame->step;
    result.max[axis] = frame->first + ceilf((box->max[axis] - frame->first) / frame->step) * frame->step;
  }
  return result;
}

static void read_node(struct scene_box boxes[], trax_scene_ref children[], const struct trax_node_format *format,
                      const unsigned char *node) {
  struct axis_frame frames[3];
  read_frames(frames, format, node);
  for (uint32_t i = 0; i < format->width; i++) {
    const unsigned char *plane = node + trax_node_box(format, i);
    for (int side = 0; side < 2; side++)
      for (int axis = 0; axis < 3; axis++, plane += format->plane_bytes)
        (side ? boxes[i].max : boxes[i].min)[axis] =
            frames[axis].first + read_plane(plane, format->plane_bytes) * frames[axis].step;
    memcpy(&children[i], node + trax_node_child(format, i), sizeof *children);
  }
}

struct scene_box scene_box_around(enum trax_node_layout layout, const struct scene_box boxes[], uint32_t count) {
  struct scene_box box = boxes[0];
  for (uint32_t i = 1; i < count; i++)
    scene_box_add_box(&box, &boxes[i]);
  for (int axis = 0; axis < 3 && trax_node_formats[layout].quantised; axis++) {
    box.min[axis] = fmaxf(box.min[axis], 0);
    box.max[axis] = fminf(box.max[axis], TRAX_GRID_LAST);
  }
  return box;
}

struct scene_box scene_box_inside_out(const struct scene_box *box) {
  struct scene_box result;
  memcpy(result.min, box->max, sizeof result.min);
  memcpy(result.max, box->min, sizeof result.max);
  return result;
}

static void write_box(unsigned char *plane, const struct trax_node_format *format, const struct axis_frame frames[3],
                      const struct scene_box *box) {
  for (int side = 0; side < 2; side++)
    for (int axis = 0; axis < 3; axis++, plane += format->plane_bytes) {
      float number = side ? box->max[axis] : box->min[axis];
      if (format->plane_bytes == 1) {
        number = (number - frames[axis].first) / frames[axis].step;
        number = side ? ceilf(number) : floorf(number);
      }
      write_plane(plane, format->plane_bytes, number);
    }
}

void scene_node_write(void *node, enum trax_node_layout layout, const struct scene_box boxes[],
                      const trax_scene_ref children[], uint32_t count, struct scene_box *box) {
  const struct trax_node_format *format = &trax_node_formats[layout];
  unsigned char *bytes = node;
  struct axis_frame frames[3];
  if (format->plane_bytes == 1) {
    const struct scene_box all = scene_box_around(layout, boxes, count);
    for (int axis = 0; axis < 3; axis++) {
      const uint32_t word = frame_around(all.min[axis], all.max[axis]);
      memcpy(bytes + sizeof word * (size_t)axis, &word, sizeof word);
    }
  }
  read_frames(frames, format, bytes);
  for (uint32_t i = 0; i < count; i++) {
    write_box(bytes + trax_node_box(format, i), format, frames, &boxes[i]);
    memcpy(bytes + trax_node_child(format, i), &children[i], sizeof *children);
  }
  struct scene_box stored[TRAX_MAX_WIDTH];
  trax_scene_ref same[TRAX_MAX_WIDTH];
  read_node(stored, same, format, bytes);
  *box = scene_box_around(layout, stored, count);
  const struct scene_box none = scene_box_inside_out(box);
  for (uint32_t i = count; i < format->width; i++)
    write_box(bytes + trax_node_box(format, i), format, frames, &none);
}

uint32_t scene_node_boxes(struct scene_box boxes[], trax_scene_ref children[], const struct trax_scene *scene,
                          uint32_t number) {
  const struct trax_node_format *format = &trax_node_formats[scene->header->node_layout];
  read_node(boxes, children, format, (const unsigned char *)scene->nodes + (size_t)number * format->bytes);
  uint32_t count = 0;
  while (count < format->width && children[count])
    count++;
  return count;
}

void trax_node_read(struct trax_node_children *children, const struct trax_scene *scene, uint32_t number) {
  const struct trax_node_format *format = &trax_node_formats[scene->header->node_layout];
  struct scene_box boxes[TRAX_MAX_WIDTH] = {{{0}, {0}}};
  children->count = scene_node_boxes(boxes, children->child, scene, number);
  for (uint32_t i = 0; i < children->count; i++)
    for (int axis = 0; axis < 3; axis++) {
      const double origin = format->quantised ? scene->grid.origin[axis] : 0;
      const double cell = format->quantised ? scene->grid.cell[axis] : 1;
      children->min[i][axis] = origin + boxes[i].min[axis] * cell;
      children->max[i][axis] = origin + boxes[i].max[axis] * cell;
    }
}
