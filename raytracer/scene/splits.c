/* Whether triangles are split. */
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

bool scene_splits_suit(const struct trax_mesh *mesh, const struct scene_duplicates *duplicates) {
  struct scene_box bounds = scene_empty_box();
  double in_vain = 0;
  for (uint32_t i = 0; i < mesh->triangle_count; i++) {
    if (emits(mesh, &mesh->triangles[i]))
      return false;
    if (duplicates->first[i] != i)
      continue;
    const uint32_t *vertices = mesh->triangles[i].vertices;
    const float *a = mesh->vertices[vertices[0]], *b = mesh->vertices[vertices[1]], *c = mesh->vertices[vertices[2]];
    const struct scene_box box = scene_triangle_box(mesh, i);
    scene_box_add_box(&bounds, &box);
    in_vain += scene_half_area(box.min, box.max);
    for (int axis = 0; axis < 3; axis++) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      in_vain -= fabs(((double)b[u] - a[u]) * ((double)c[v] - a[v]) - ((double)b[v] - a[v]) * ((double)c[u] - a[u]));
    }
  }
  return in_vain > BOXES_IN_VAIN * scene_half_area(bounds.min, bounds.max);
}

trax_status scene_check_emitters(const struct trax_mesh *mesh, trax_error *error) {
  for (uint32_t i = 0; i < mesh->triangle_count; i++)
    if (emits(mesh, &mesh->triangles[i]))
      return trax_fail(error, "no splits where triangles emit light (material '%s')",
                       mesh->materials[mesh->triangles[i].material].name);
  return TRAX_OK;
}
