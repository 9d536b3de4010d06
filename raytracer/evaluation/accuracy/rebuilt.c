/* A scene once more from its triangles, for comparisons of what it is stored as. */
#include "accuracy.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* To the nearest of 2^bits planes at equal distances, of which the first and the last are the scene's bounds. */
static float snapped(float value, float low, float high, unsigned bits) {
  const double last = ldexp(1, (int)bits) - 1, cell = ((double)high - low) / last;
  return cell > 0 ? (float)(low + cell * floor((value - low) / cell + 0.5)) : value;
}

/* Behind those that the mesh has so far. */
static void add_triangle(struct trax_mesh *mesh, const struct trax_scene *scene, uint32_t number, unsigned bits) {
  const struct trax_triangle *triangle = &scene->triangles[number];
  const float *corners[3] = {triangle->v0, triangle->v1, triangle->v2};
  const uint32_t to = mesh->triangle_count++, vertex = mesh->vertex_count;
  mesh->vertex_count += 3;
  for (uint32_t corner = 0; corner < 3; corner++)
    for (int axis = 0; axis < 3; axis++)
      mesh->vertices[vertex + corner][axis] =
          bits ? snapped(corners[corner][axis], scene->header->bounds_min[axis], scene->header->bounds_max[axis], bits)
               : corners[corner][axis];
  mesh->triangles[to] = (struct trax_mesh_triangle){
      .vertices = {vertex, vertex + 1, vertex + 2}, .material = triangle->material, .source_id = number};
  if (mesh->normals)
    memcpy(mesh->normals[to], scene->normals[number].corner, sizeof mesh->normals[to]);
}

/* Which triangles of the file are the first of their source id; from malloc, NULL if memory is out. */
static bool *first_ones(const struct trax_scene *scene) {
  uint32_t most = 0;
  for (uint32_t i = 0; i < scene->triangle_count && scene->source_ids; i++)
    most = scene->source_ids[i] > most ? scene->source_ids[i] : most;
  unsigned char *seen = calloc((size_t)most / 8 + 1, 1);
  bool *first = calloc((size_t)scene->triangle_count + 1, sizeof *first);
  for (uint32_t i = 0; i < scene->triangle_count && seen && first; i++) {
    if (!scene->source_ids) {
      first[i] = true;
      continue;
    }
    const uint32_t id = scene->source_ids[i];
    first[i] = !(seen[id / 8] >> id % 8 & 1);
    seen[id / 8] |= (unsigned char)(1 << id % 8);
  }
  if (!seen) {
    free(first);
    first = NULL;
  }
  free(seen);
  return first;
}

trax_status trax_scene_is_split(bool *split, const struct trax_scene *scene, trax_error *error) {
  bool *first = first_ones(scene);
  if (!first)
    return trax_fail(error, "out of memory for %u triangles", scene->triangle_count);
  *split = false;
  for (uint32_t i = 0; i < scene->triangle_count && !*split; i++)
    *split = !first[i];
  free(first);
  return TRAX_OK;
}

trax_status trax_scene_rebuild(struct trax_scene *rebuilt, const struct trax_scene *scene,
                               const struct trax_rebuild_options *how, const volatile int *interrupt,
                               trax_error *error) {
  const size_t count = scene->triangle_count;
  struct trax_mesh mesh = {.material_count = scene->material_count};
  bool *first = first_ones(scene);
  mesh.vertices = malloc((3 * count + 1) * sizeof *mesh.vertices);
  mesh.triangles = malloc((count + 1) * sizeof *mesh.triangles);
  mesh.materials = calloc((size_t)scene->material_count + 1, sizeof *mesh.materials);
  mesh.normals = scene->normals ? malloc(count * sizeof *mesh.normals) : NULL;
  trax_status status = TRAX_OK;
  if (!first || !mesh.vertices || !mesh.triangles || !mesh.materials || (scene->normals && !mesh.normals)) {
    status = trax_fail(error, "out of memory to build a scene of %zu triangles anew", count);
  } else {
    for (uint32_t i = 0; i < scene->material_count; i++)
      mesh.materials[i].surface = scene->materials[i];
    for (uint32_t i = 0; i < count; i++)
      if (first[i])
        add_triangle(&mesh, scene, i, how->vertex_bits);
    const struct trax_build_options options = {.nodes = how->nodes,
                                               .splits = how->split ? TRAX_DEFAULT_SPLITS : 0,
                                               .passes = TRAX_DEFAULT_PASSES,
                                               .allow_empty = true,
                                               .smooth = scene->normals != NULL,
                                               .interrupt = interrupt};
    status = trax_scene_build(rebuilt, &mesh, &options, error);
  }
  free(first);
  trax_mesh_release(&mesh);
  return status;
}
