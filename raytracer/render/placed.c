#include "placed.h"

#include "render.h"

#include <string.h>

/* The instance that has the number: the last that begins at it or before. */
static const struct trax_instance *find_instance(const struct trax_scene *scene, uint32_t number) {
  uint32_t first = 0, end = scene->instance_count;
  while (end - first > 1) {
    const uint32_t middle = first + (end - first) / 2;
    if (scene->instances[middle].first_number <= number)
      first = middle;
    else
      end = middle;
  }
  return &scene->instances[first];
}

/* Operations have the order and precision of the device. */
static void place_corner(float corner[3], const struct trax_instance *instance) {
  const float x = corner[0], y = corner[1], z = corner[2];
  for (int row = 0; row < 3; row++) {
    const float *a = instance->to_world[row];
    corner[row] = a[0] * x + a[1] * y + a[2] * z + instance->origin[row];
  }
}

void trax_place(struct placed_triangle *out, const struct trax_scene *scene, uint32_t number) {
  *out = (struct placed_triangle){.stored = number};
  if (scene->instances) {
    out->instance = find_instance(scene, number);
    out->stored = scene->meshes[out->instance->mesh].first_triangle + number - out->instance->first_number;
    out->mirrored = out->instance->flags & TRAX_INSTANCE_MIRRORED;
  }
  out->triangle = scene->triangles[out->stored];
  if (!out->instance)
    return;
  place_corner(out->triangle.v0, out->instance);
  place_corner(out->triangle.v1, out->instance);
  place_corner(out->triangle.v2, out->instance);
  if (out->instance->material != TRAX_NO_MATERIAL)
    out->triangle.material = out->instance->material;
}

void trax_place_normals(double out[3][3], const struct trax_scene *scene, const struct placed_triangle *triangle) {
  for (int corner = 0; corner < 3; corner++) {
    const float *n = scene->normals[triangle->stored].corner[corner];
    for (int axis = 0; axis < 3; axis++) {
      out[corner][axis] = (double)n[axis];
      if (!triangle->instance)
        continue;
      const float(*m)[3] = triangle->instance->to_object;
      out[corner][axis] =
          (double)m[0][axis] * (double)n[0] + (double)m[1][axis] * (double)n[1] + (double)m[2][axis] * (double)n[2];
    }
  }
}

uint32_t trax_number_of_hit(const struct trax_scene *scene, uint32_t triangle, uint32_t instance) {
  const struct trax_scene_section *section = &scene->header->sections[TRAX_SCENE_TRIANGLES];
  const uint32_t number = (triangle - section->offset) / (uint32_t)sizeof(struct trax_triangle);
  if (triangle < section->offset || number >= section->count)
    return TRAX_NO_TRIANGLE;
  if (!scene->instances)
    return number;
  const struct trax_instance *at = (const struct trax_instance *)((const char *)scene->header + instance);
  if (at < scene->instances || at >= scene->instances + scene->instance_count ||
      ((const char *)at - (const char *)scene->instances) % sizeof *at != 0)
    return TRAX_NO_TRIANGLE;
  const struct trax_scene_mesh *mesh = &scene->meshes[at->mesh];
  if (number - mesh->first_triangle >= mesh->triangle_count) /* also of a number below the first */
    return TRAX_NO_TRIANGLE;
  return at->first_number + number - mesh->first_triangle;
}

uint32_t trax_source_of(const struct trax_scene *scene, uint32_t number) {
  if (!scene->instances)
    return scene->source_ids ? scene->source_ids[number] : number;
  const struct trax_instance *instance = find_instance(scene, number);
  const uint32_t stored = scene->meshes[instance->mesh].first_triangle + number - instance->first_number;
  return instance->first_source + (scene->source_ids ? scene->source_ids[stored] : number - instance->first_number);
}

struct double3 trax_to_object(const struct trax_instance *instance, struct double3 v) {
  if (!instance)
    return v;
  const struct double3 a = from(instance->to_world[0]), b = from(instance->to_world[1]),
                       c = from(instance->to_world[2]);
  const struct double3 bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const double determinant = dot(a, bc);
  return (struct double3){(bc.x * v.x + ca.x * v.y + ab.x * v.z) / determinant,
                          (bc.y * v.x + ca.y * v.y + ab.y * v.z) / determinant,
                          (bc.z * v.x + ca.z * v.y + ab.z * v.z) / determinant};
}
