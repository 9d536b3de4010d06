/* Parts of cases: rays, and surfaces to aim them at. */
#include "setup.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void setup_release(struct setup *setup) {
  trax_mesh_release(&setup->mesh);
  free(setup->premade.bytes);
  free(setup->rays);
  memset(setup, 0, sizeof *setup);
}

/* --- rays --- */

void add_ray(struct setup *setup, const float origin[3], const float direction[3]) {
  if (direction[0] == 0 && direction[1] == 0 && direction[2] == 0)
    return;
  if (setup->ray_count == setup->ray_capacity) {
    setup->ray_capacity = setup->ray_capacity ? 2 * setup->ray_capacity : 1024;
    setup->rays = realloc(setup->rays, setup->ray_capacity * sizeof *setup->rays);
    if (!setup->rays)
      abort();
  }
  struct query_ray *ray = &setup->rays[setup->ray_count++];
  memcpy(ray->origin, origin, sizeof ray->origin);
  memcpy(ray->direction, direction, sizeof ray->direction);
}

void aim(struct setup *setup, const float from[3], const float at[3]) {
  add_ray(setup, from, (float[]){at[0] - from[0], at[1] - from[1], at[2] - from[2]});
}

float any(struct setup *setup) {
  return 2 * random_unit(&setup->seed) - 1;
}

uint32_t one_of(struct setup *setup, uint32_t count) {
  return (uint32_t)((double)random_unit(&setup->seed) * count);
}

void random_target(struct setup *setup, float at[3]) {
  const struct trax_mesh *mesh = &setup->mesh;
  const struct trax_mesh_triangle *triangle = &mesh->triangles[one_of(setup, mesh->triangle_count)];
  uint32_t kind = one_of(setup, 4);
  float w1 = kind == 0 ? 0 : kind == 1 ? 0.5f : random_unit(&setup->seed);
  float w2 = kind == 3 ? (1 - w1) * random_unit(&setup->seed) : 0;
  const float *a = mesh->vertices[triangle->vertices[0]], *b = mesh->vertices[triangle->vertices[1]],
              *c = mesh->vertices[triangle->vertices[2]];
  for (int axis = 0; axis < 3; axis++)
    at[axis] = a[axis] + w1 * (b[axis] - a[axis]) + w2 * (c[axis] - a[axis]);
}

void aim_from_within(struct setup *setup, const float centre[3], float radius, uint32_t rays) {
  for (uint32_t i = 0; i < rays; i++) {
    float from[3], at[3];
    for (int axis = 0; axis < 3; axis++)
      from[axis] = i % 8 == 0 ? centre[axis] : centre[axis] + radius * any(setup);
    random_target(setup, at);
    aim(setup, from, at);
  }
}

/* --- surfaces --- */

void triangle_at(struct setup *setup, const float a[3], const float b[3], const float c[3]) {
  uint32_t first = mesh_vertex(&setup->mesh, a[0], a[1], a[2]);
  mesh_vertex(&setup->mesh, b[0], b[1], b[2]);
  mesh_vertex(&setup->mesh, c[0], c[1], c[2]);
  mesh_triangle(&setup->mesh, first, first + 1, first + 2, 0);
}

/* Computes the point (i, j, k) of an octahedron's surface; the same numbers give the same bits. */
static void globe_point(const struct globe *globe, const int place[3], float point[3]) {
  float length = sqrtf((float)(place[0] * place[0] + place[1] * place[1] + place[2] * place[2]));
  uint32_t seed = (uint32_t)place[0] * 73856093u ^ (uint32_t)place[1] * 19349663u ^ (uint32_t)place[2] * 83492791u;
  random_unit(&seed);
  float radius = globe->radius * (1 + globe->roughness * random_unit(&seed)) / length;
  for (int axis = 0; axis < 3; axis++)
    point[axis] = globe->centre[axis] + radius * (float)place[axis];
}

void add_globe(struct setup *setup, int n, const struct globe *globe) {
  for (int octant = 0; octant < 8; octant++)
    for (int i = 0; i < n; i++)
      for (int j = 0; i + j < n; j++)
        for (int flipped = 0; flipped < 2 && i + j + flipped < n; flipped++) {
          int steps[2][3][2] = {{{0, 0}, {1, 0}, {0, 1}}, {{1, 0}, {1, 1}, {0, 1}}};
          float corner[3][3];
          for (int v = 0; v < 3; v++) {
            int x = i + steps[flipped][v][0], y = j + steps[flipped][v][1];
            int place[3] = {octant & 1 ? -x : x, octant & 2 ? -y : y, octant & 4 ? x + y - n : n - x - y};
            globe_point(globe, place, corner[v]);
          }
          triangle_at(setup, corner[0], corner[1], corner[2]);
        }
}

void add_blocks(struct setup *setup) {
  mesh_box(&setup->mesh, (float[]){-1, -1, -1}, (float[]){1, 1, 1}, 0);
  mesh_box(&setup->mesh, (float[]){-0.5f, -1, -0.5f}, (float[]){0, 0, 0}, 0);
  mesh_box(&setup->mesh, (float[]){0, 0, 0}, (float[]){0.5f, 0.5f, 0.5f}, 0);
  mesh_box(&setup->mesh, (float[]){0.5f, -0.5f, -1}, (float[]){0.5f, 0.5f, 0.5f}, 0); /* flat */
}
