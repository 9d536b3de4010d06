/* Triangles that a tree has in several leaves, each time with a box around a part of it. */
#include "internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_CORNERS = 64 };

struct polygon {
  unsigned count;
  double corner[MOST_CORNERS][3];
};

/* A polygon keeps at most MOST_CORNERS corners. */
static void clip(struct polygon *out, const struct polygon *in, int axis, double sign, double plane) {
  out->count = scene_clip_polygon(out->corner, MOST_CORNERS, in->corner, in->count, axis, sign, plane);
}

/* The test whether the boxes of its leaves cover a triangle. */

enum { MOST_COPIES = 1024, MOST_STEPS = 2048 };

struct cover {
  const struct scene_parts *parts;
  const uint32_t *copies; /* the triangle's numbers in the file, ascending */
  uint32_t count;
  double slack[3]; /* tolerance of boxes: more than the rounding errors here, less than those of any ray */
  unsigned steps;  /* of recursion */
};

/* Subtrees that are still to be tried. */
struct subtree {
  trax_scene_ref ref;
  uint32_t first, end; /* its triangles */
  struct scene_box box;
  const struct subtree *next;
};

/* Sets the range of triangles below a reference. */
static void set_range(struct subtree *subtree, const struct scene_parts *parts) {
  const struct trax_scene_section *sections = parts->scene->header->sections;
  const uint32_t count = TRAX_SCENE_REF_COUNT(subtree->ref);
  if (count) {
    subtree->first = (TRAX_SCENE_REF_OFFSET(subtree->ref) - sections[TRAX_SCENE_TRIANGLES].offset) /
                     (uint32_t)sizeof(struct trax_triangle);
    subtree->end = subtree->first + count;
    return;
  }
  const uint32_t node = (subtree->ref - sections[TRAX_SCENE_NODES].offset) / sections[TRAX_SCENE_NODES].record_size;
  subtree->first = parts->ranges[node].first;
  subtree->end = parts->ranges[node].end;
}

static void list_children(struct subtree below[TRAX_NODE_MOST_CHILDREN], const struct scene_parts *parts,
                          const struct subtree *parent) {
  const struct trax_scene_section *section = &parts->scene->header->sections[TRAX_SCENE_NODES];
  struct scene_node node;
  scene_node_of(&node, parts->scene, (parent->ref - section->offset) / section->record_size);
  for (uint32_t i = 0; i < node.count; i++) {
    below[i] = (struct subtree){
        .ref = node.child[i], .box = node.box[i], .next = i + 1 < node.count ? &below[i + 1] : parent->next};
    set_range(&below[i], parts);
  }
}

static bool has_copy(const struct cover *cover, uint32_t first, uint32_t end) {
  uint32_t low = 0, high = cover->count;
  while (low < high) {
    uint32_t middle = low + (high - low) / 2;
    if (cover->copies[middle] < first)
      low = middle + 1;
    else
      high = middle;
  }
  return low < cover->count && cover->copies[low] < end;
}

/* Whether the boxes of the subtrees cover the polygon. The part outside of the first subtree's box is left to the
   following ones, the part inside to those below it and then to the following ones. The recursion goes no deeper than
   the tree for each box that is left. */
static bool is_covered(struct cover *cover, const struct polygon *polygon, const struct subtree *list) {
  if (polygon->count == 0)
    return true;
  while (list && !has_copy(cover, list->first, list->end))
    list = list->next;
  if (!list || cover->steps == MOST_STEPS)
    return false;
  struct polygon *pieces = malloc(3 * sizeof *pieces); /* too large for the recursion's frames */
  if (!pieces)
    return false;
  struct polygon *inside = &pieces[0], *next = &pieces[1], *outside = &pieces[2];
  *inside = *polygon;
  bool covered = true;
  cover->steps++;
  for (int side = 0; side < 6 && covered && inside->count; side++) {
    const int axis = side >> 1;
    const double sign = side & 1 ? -1 : 1;
    const double plane = (double)(side & 1 ? list->box.max : list->box.min)[axis] - sign * cover->slack[axis];
    bool cut = false;
    for (unsigned i = 0; i < inside->count; i++)
      cut |= sign * (inside->corner[i][axis] - plane) < 0;
    if (!cut)
      continue;
    covered = inside->count + 2 <= MOST_CORNERS;
    clip(outside, inside, axis, -sign, plane);
    clip(next, inside, axis, sign, plane);
    covered = covered && is_covered(cover, outside, list->next);
    struct polygon *swap = inside;
    inside = next, next = swap;
  }
  if (covered && inside->count && !TRAX_SCENE_REF_COUNT(list->ref)) {
    struct subtree below[TRAX_NODE_MOST_CHILDREN];
    list_children(below, cover->parts, list);
    covered = is_covered(cover, inside, below);
  }
  free(pieces);
  cover->steps--;
  return covered;
}

static bool check_triangle(struct cover *cover, const struct trax_triangle *triangle) {
  const struct trax_scene *scene = cover->parts->scene;
  const bool quantised = trax_node_formats[scene->header->node_layout].quantised;
  const float *const corners[3] = {triangle->v0, triangle->v1, triangle->v2};
  struct polygon polygon = {.count = 3};
  struct subtree root = {.ref = scene->header->root};
  set_range(&root, cover->parts);
  for (int axis = 0; axis < 3; axis++) {
    const double origin = quantised ? scene->grid.origin[axis] : 0, cell = quantised ? scene->grid.cell[axis] : 1;
    const double low = scene->header->bounds_min[axis], high = scene->header->bounds_max[axis];
    for (int corner = 0; corner < 3; corner++)
      polygon.corner[corner][axis] = (corners[corner][axis] - origin) / cell;
    cover->slack[axis] = quantised ? 0x1p-20 : 0x1p-40 * fmax(fabs(low), fabs(high));
    root.box.min[axis] = -INFINITY, root.box.max[axis] = INFINITY;
  }
  return is_covered(cover, &polygon, &root);
}

/* Orders by vertices, then by place in the file. */
static int compare_copies(const void *a, const void *b) {
  const struct trax_triangle *left = *(const struct trax_triangle *const *)a,
                             *right = *(const struct trax_triangle *const *)b;
  const int order = memcmp(left, right, 9 * sizeof(float));
  return order ? order : left < right ? -1 : left > right;
}

trax_status scene_check_parts(const struct scene_parts *parts, uint32_t *bad, trax_error *error) {
  const struct trax_scene *scene = parts->scene;
  const struct trax_triangle **copies = malloc(scene->triangle_count * sizeof *copies);
  uint32_t *numbers = malloc(MOST_COPIES * sizeof *numbers);
  *bad = UINT32_MAX;
  if (!copies || !numbers) {
    free(copies), free(numbers);
    return scene_out_of_memory(error, "BVH");
  }
  for (uint32_t i = 0; i < scene->triangle_count; i++)
    copies[i] = &scene->triangles[i];
  qsort(copies, scene->triangle_count, sizeof *copies, compare_copies);
  for (uint32_t begin = 0, end; begin < scene->triangle_count && *bad == UINT32_MAX; begin = end) {
    uint32_t in_part = UINT32_MAX;
    bool whole = false;
    for (end = begin; end < scene->triangle_count && memcmp(copies[end], copies[begin], 9 * sizeof(float)) == 0;
         end++) {
      const uint32_t number = (uint32_t)(copies[end] - scene->triangles);
      if (end - begin < MOST_COPIES)
        numbers[end - begin] = number;
      if (parts->in_part[number])
        in_part = number;
      else
        whole = true;
    }
    if (whole || in_part == UINT32_MAX)
      continue;
    struct cover cover = {.parts = parts, .copies = numbers, .count = end - begin};
    if (cover.count == 1 || cover.count > MOST_COPIES || !check_triangle(&cover, copies[begin]))
      *bad = in_part;
  }
  free(copies), free(numbers);
  return TRAX_OK;
}
