/* A scene once more from its triangles, for comparisons of what it is stored as. */
#include "accuracy.h"

#include "core/machine.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* To the nearest of 2^bits planes at equal distances, of which the first and the last are the scene's bounds. */
static float snapped(float value, float low, float high, unsigned bits) {
  const double last = ldexp(1, (int)bits) - 1, cell = ((double)high - low) / last;
  return cell > 0 ? (float)(low + cell * floor((value - low) / cell + 0.5)) : value;
}

static void copy_triangle(struct trax_mesh *mesh, const struct trax_scene *scene, uint32_t number, unsigned bits) {
  const struct trax_triangle *triangle = &scene->triangles[number];
  const float *corners[3] = {triangle->v0, triangle->v1, triangle->v2};
  for (uint32_t corner = 0; corner < 3; corner++)
    for (int axis = 0; axis < 3; axis++)
      mesh->vertices[3 * number + corner][axis] =
          bits ? snapped(corners[corner][axis], scene->header->bounds_min[axis], scene->header->bounds_max[axis], bits)
               : corners[corner][axis];
  mesh->triangles[number] = (struct trax_mesh_triangle){
      .vertices = {3 * number, 3 * number + 1, 3 * number + 2}, .material = triangle->material, .source_id = number};
  if (mesh->normals)
    memcpy(mesh->normals[number], scene->normals[number].corner, sizeof mesh->normals[number]);
}

trax_status trax_scene_rebuild(struct trax_scene *rebuilt, const struct trax_scene *scene, enum trax_node_layout nodes,
                               unsigned vertex_bits, const volatile int *interrupt, trax_error *error) {
  const uint32_t count = scene->triangle_count;
  struct trax_mesh mesh = {.vertex_count = 3 * count, .triangle_count = count, .material_count = scene->material_count};
  mesh.vertices = malloc(3 * (size_t)count * sizeof *mesh.vertices + 1);
  mesh.triangles = malloc(count * sizeof *mesh.triangles + 1);
  mesh.materials = calloc((size_t)scene->material_count + 1, sizeof *mesh.materials);
  mesh.normals = scene->normals ? malloc(count * sizeof *mesh.normals) : NULL;
  trax_status status = TRAX_OK;
  if (!mesh.vertices || !mesh.triangles || !mesh.materials || (scene->normals && !mesh.normals)) {
    status = trax_fail(error, "out of memory to build a scene of %u triangles anew", count);
  } else {
    for (uint32_t i = 0; i < scene->material_count; i++)
      mesh.materials[i].surface = scene->materials[i];
    for (uint32_t i = 0; i < count; i++)
      copy_triangle(&mesh, scene, i, vertex_bits);
    const struct trax_build_options options = {
        .nodes = nodes, .allow_empty = true, .smooth = scene->normals != NULL, .interrupt = interrupt};
    status = trax_scene_build(rebuilt, &mesh, &options, error);
  }
  trax_mesh_release(&mesh);
  return status;
}
