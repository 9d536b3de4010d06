/* The decision whether triangles are split. */
#include "internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool trax_splits_choose(const char *text, struct trax_build_options *build) {
  char *end = NULL;
  build->choose_splits = text && strcmp(text, "auto") == 0;
  build->splits = 0;
  if (build->choose_splits)
    return true;
  const float factor = text ? strtof(text, &end) : TRAX_DEFAULT_SPLITS;
  if (text && (end == text || *end || !(factor >= 1 && factor <= TRAX_SCENE_MAX_SPLITS)))
    return false;
  build->splits = factor;
  return true;
}

static bool emits(const struct trax_mesh *mesh, const struct trax_mesh_triangle *triangle) {
  const float *emission = mesh->materials[triangle->material].surface.emission;
  return emission[0] > 0 || emission[1] > 0 || emission[2] > 0;
}

/* The number of boxes that a random line through the scene enters beyond those that it would enter if each box had the
   size of its triangle as seen along the axes. It is large if triangles are large and oblique. */
#define BOXES_IN_VAIN 2
/* Splits take these away where few triangles cause them, not where all do, as in a rough surface: this share of the
   triangles causes at least half. */
#define FEW 10

static double in_vain(const struct trax_mesh *mesh, uint32_t triangle, const struct scene_box *box) {
  const uint32_t *vertices = mesh->triangles[triangle].vertices;
  const float *a = mesh->vertices[vertices[0]], *b = mesh->vertices[vertices[1]], *c = mesh->vertices[vertices[2]];
  double area = scene_half_area(box->min, box->max);
  for (int axis = 0; axis < 3; axis++) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    area -= fabs(((double)b[u] - a[u]) * ((double)c[v] - a[v]) - ((double)b[v] - a[v]) * ((double)c[u] - a[u]));
  }
  return area;
}

bool scene_splits_may_suit(const struct trax_mesh *mesh) {
  struct scene_box bounds = scene_empty_box();
  double all = 0;
  for (uint32_t i = 0; i < mesh->triangle_count; i++) {
    if (emits(mesh, &mesh->triangles[i]))
      return false;
    const struct scene_box box = scene_triangle_box(mesh, i);
    scene_box_add_box(&bounds, &box);
    all += in_vain(mesh, i, &box);
  }
  return all > BOXES_IN_VAIN * scene_half_area(bounds.min, bounds.max);
}

static int compare_descending(const void *a, const void *b) {
  const double left = *(const double *)a, right = *(const double *)b;
  return (left < right) - (left > right);
}

trax_status scene_splits_suit(bool *suit, const struct trax_mesh *mesh, const struct scene_duplicates *duplicates,
                              trax_error *error) {
  struct scene_box bounds = scene_empty_box();
  double *areas = malloc(mesh->triangle_count * sizeof *areas), all = 0, of_few = 0;
  uint32_t count = 0;
  *suit = false;
  if (!areas)
    return scene_out_of_memory(error, "BVH");
  for (uint32_t i = 0; i < mesh->triangle_count; i++) {
    if (duplicates->first[i] != i)
      continue;
    const struct scene_box box = scene_triangle_box(mesh, i);
    scene_box_add_box(&bounds, &box);
    areas[count] = in_vain(mesh, i, &box);
    all += areas[count++];
  }
  if (all > BOXES_IN_VAIN * scene_half_area(bounds.min, bounds.max)) {
    qsort(areas, count, sizeof *areas, compare_descending);
    for (uint32_t i = 0; i < count / FEW + 1; i++)
      of_few += areas[i];
    *suit = 2 * of_few >= all;
  }
  free(areas);
  return TRAX_OK;
}

trax_status scene_check_emitters(const struct trax_mesh *mesh, trax_error *error) {
  for (uint32_t i = 0; i < mesh->triangle_count; i++)
    if (emits(mesh, &mesh->triangles[i]))
      return trax_fail(error, "no splits where triangles emit light (material '%s')",
                       mesh->materials[mesh->triangles[i].material].name);
  return TRAX_OK;
}
