#define _GNU_SOURCE /* mkstemps */
#include "cases.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* --- rays --- */

static void add_ray(struct setup *setup, const float origin[3], const float direction[3]) {
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

static void aim(struct setup *setup, const float from[3], const float at[3]) {
  add_ray(setup, from, (float[]){at[0] - from[0], at[1] - from[1], at[2] - from[2]});
}

static float any(struct setup *setup) { /* in [-1, 1) */
  return 2 * random_unit(&setup->seed) - 1;
}

static uint32_t one_of(struct setup *setup, uint32_t count) {
  return (uint32_t)((double)random_unit(&setup->seed) * count);
}

/* A vertex, a point of an edge, or one inside, of a triangle by chance. */
static void random_target(struct setup *setup, float at[3]) {
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

/* From near `centre`, within `radius` of it along each axis, at targets on the mesh. */
static void aim_from_within(struct setup *setup, const float centre[3], float radius, uint32_t rays) {
  for (uint32_t i = 0; i < rays; i++) {
    float from[3], at[3];
    for (int axis = 0; axis < 3; axis++)
      from[axis] = i % 8 == 0 ? centre[axis] : centre[axis] + radius * any(setup);
    random_target(setup, at);
    aim(setup, from, at);
  }
}

/* --- surfaces --- */

static void triangle_at(struct setup *setup, const float a[3], const float b[3], const float c[3]) {
  uint32_t first = mesh_vertex(&setup->mesh, a[0], a[1], a[2]);
  mesh_vertex(&setup->mesh, b[0], b[1], b[2]);
  mesh_vertex(&setup->mesh, c[0], c[1], c[2]);
  mesh_triangle(&setup->mesh, first, first + 1, first + 2, 0);
}

struct globe {
  float centre[3], radius, roughness;
};

/* Of the point (i, j, k) of an octahedron's surface; the same numbers give the same bits. */
static void globe_point(const struct globe *globe, const int place[3], float point[3]) {
  float length = sqrtf((float)(place[0] * place[0] + place[1] * place[1] + place[2] * place[2]));
  uint32_t seed = (uint32_t)place[0] * 73856093u ^ (uint32_t)place[1] * 19349663u ^ (uint32_t)place[2] * 83492791u;
  random_unit(&seed);
  float radius = globe->radius * (1 + globe->roughness * random_unit(&seed)) / length;
  for (int axis = 0; axis < 3; axis++)
    point[axis] = globe->centre[axis] + radius * (float)place[axis];
}

/* A closed surface of 8 n^2 triangles, seen from whose centre each is in front of no other; with roughness the radius
   of each vertex varies by as much. */
static void add_globe(struct setup *setup, int n, const struct globe *globe) {
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

static const float nowhere[3];

static void globe_with_rays(struct setup *setup, int n, float x, float y, float z, float radius, float roughness,
                            uint32_t rays) {
  struct globe globe = {{x, y, z}, radius, roughness};
  add_globe(setup, n, &globe);
  aim_from_within(setup, globe.centre, 0.4f * radius, rays);
}

static void make_globe(struct setup *setup, uint32_t rays) {
  globe_with_rays(setup, 12, 0, 0, 0, 1.5f, 0, rays);
}

static void make_rough_globe(struct setup *setup, uint32_t rays) {
  globe_with_rays(setup, 112, 0, 0, 0, 3, 0.2f, rays);
}

static void make_offset(struct setup *setup, uint32_t rays) {
  globe_with_rays(setup, 12, 1e7f, -1e7f, 1e7f, 64, 0, rays);
}

static void make_small_scale(struct setup *setup, uint32_t rays) {
  globe_with_rays(setup, 12, 0, 0, 0, 0x1p-60f, 0.1f, rays);
}

static void make_large_scale(struct setup *setup, uint32_t rays) {
  globe_with_rays(setup, 12, 0, 0, 0, 0x1p60f, 0.1f, rays);
}

static void make_subnormal_coordinates(struct setup *setup, uint32_t rays) {
  globe_with_rays(setup, 12, 0, 0, 0, 0x1p-137f, 0.1f, rays);
}

static void make_far_origins(struct setup *setup, uint32_t rays) {
  add_globe(setup, 12, &(struct globe){{0, 0, 0}, 1, 0});
  for (uint32_t i = 0; i < rays; i++) {
    float from[3] = {1e6f * any(setup), 1e6f * any(setup), 1e6f}, at[3];
    random_target(setup, at);
    aim(setup, from, at);
  }
}

static void make_origins_on_surfaces(struct setup *setup, uint32_t rays) {
  add_globe(setup, 6, &(struct globe){{0, 0, 0}, 1, 0});
  for (uint32_t i = 0; i < rays; i++) {
    float from[3], at[3];
    random_target(setup, from);
    random_target(setup, at);
    aim(setup, from, at);
  }
}

/* --- directions --- */

static void scale_directions(struct setup *setup, float factor) {
  for (uint32_t i = 0; i < setup->ray_count; i++)
    for (int axis = 0; axis < 3; axis++)
      setup->rays[i].direction[axis] *= factor;
}

static void make_short_directions(struct setup *setup, uint32_t rays) {
  make_globe(setup, rays);
  scale_directions(setup, 1e-20f);
}

static void make_long_directions(struct setup *setup, uint32_t rays) {
  make_globe(setup, rays);
  scale_directions(setup, 1e20f);
}

static void make_subnormal_directions(struct setup *setup, uint32_t rays) {
  make_globe(setup, rays);
  scale_directions(setup, 0x1p-140f);
}

static void make_longest_directions(struct setup *setup, uint32_t rays) {
  make_globe(setup, rays);
  scale_directions(setup, 0x1p125f);
}

static void make_subnormal_components(struct setup *setup, uint32_t rays) {
  add_globe(setup, 12, &(struct globe){{0, 0, 0}, 1.5f, 0});
  for (uint32_t i = 0; i < rays; i++) {
    float from[3] = {0.5f * any(setup), 0.5f * any(setup), 0.5f * any(setup)}, direction[3];
    for (int axis = 0; axis < 3; axis++)
      direction[axis] = axis == (int)(i % 3) ? any(setup) : 1e-38f * any(setup) * random_unit(&setup->seed);
    add_ray(setup, from, direction);
  }
}

/* A room of 2 x 2 x 2 with boxes whose planes go on where others' end: a grid of 0.5. */
static void add_blocks(struct setup *setup) {
  mesh_box(&setup->mesh, (float[]){-1, -1, -1}, (float[]){1, 1, 1}, 0);
  mesh_box(&setup->mesh, (float[]){-0.5f, -1, -0.5f}, (float[]){0, 0, 0}, 0);
  mesh_box(&setup->mesh, (float[]){0, 0, 0}, (float[]){0.5f, 0.5f, 0.5f}, 0);
  mesh_box(&setup->mesh, (float[]){0.5f, -0.5f, -1}, (float[]){0.5f, 0.5f, 0.5f}, 0); /* flat */
}

static void axis_parallel(struct setup *setup, uint32_t rays, float zero) {
  add_blocks(setup);
  for (uint32_t i = 0; i < rays; i++) {
    float from[3], direction[3] = {zero, zero, zero};
    for (int axis = 0; axis < 3; axis++)
      from[axis] = one_of(setup, 3) ? 0.25f * (float)((int)one_of(setup, 7) - 3) : 0.99f * any(setup);
    direction[i % 3] = i & 4 ? -1 : 1;
    add_ray(setup, from, direction);
  }
}

static void make_axis_parallel(struct setup *setup, uint32_t rays) {
  axis_parallel(setup, rays, 0);
}

static void make_axis_parallel_negative(struct setup *setup, uint32_t rays) {
  axis_parallel(setup, rays, -0.0f);
}

/* Origins on planes of boxes, ways within the planes or not. */
static void make_box_planes(struct setup *setup, uint32_t rays) {
  add_blocks(setup);
  for (uint32_t i = 0; i < rays; i++) {
    float from[3], direction[3];
    for (int axis = 0; axis < 3; axis++) {
      from[axis] = 0.98f * any(setup);
      direction[axis] = any(setup);
    }
    uint32_t axis = i % 3;
    from[axis] = 0.5f * (float)((int)one_of(setup, 3) - 1);
    if (i & 8)
      direction[axis] = i & 16 ? -0.0f : 0;
    add_ray(setup, from, direction);
  }
}

/* Squares parallel to the axes: boxes without thickness. Half of the rays run in their planes or across them at right
   angles. */
static void make_flat_boxes(struct setup *setup, uint32_t rays) {
  for (int axis = 0; axis < 3; axis++)
    for (int i = -4; i <= 4; i++) {
      float corner[4][3];
      for (int c = 0; c < 4; c++) {
        corner[c][axis] = 0.25f * (float)i;
        corner[c][(axis + 1) % 3] = c == 1 || c == 2 ? 1 : -1;
        corner[c][(axis + 2) % 3] = c >= 2 ? 1 : -1;
      }
      triangle_at(setup, corner[0], corner[1], corner[2]);
      triangle_at(setup, corner[0], corner[2], corner[3]);
    }
  for (uint32_t i = 0; i < rays; i++) {
    float from[3] = {0.9f * any(setup), 0.9f * any(setup), 0.9f * any(setup)};
    float direction[3] = {any(setup), any(setup), any(setup)};
    if (i & 1) {
      direction[i / 2 % 3] = 0;
      from[i / 2 % 3] = 0.25f * (float)((int)one_of(setup, 7) - 3);
      if (i & 16)
        direction[(i / 2 + 1) % 3] = -0.0f;
    }
    add_ray(setup, from, direction);
  }
}

/* Rays in the planes of triangles at any angle: x + y + z = 0, on a grid of powers of two, so exactly. */
static void make_rays_in_planes(struct setup *setup, uint32_t rays) {
  for (int i = 0; i < 16; i++) {
    float shift = (float)(i - 8) * 0x1p-6f;
    float corner[3][3] = {{1 + shift, -1, 0}, {-1, 1 + shift, 0}, {0, -1 + shift, 1}};
    triangle_at(setup, corner[0], corner[1], corner[2]);
  }
  for (uint32_t i = 0; i < rays; i++) {
    float a = 0x1p-10f * (float)one_of(setup, 1024), b = 0x1p-10f * (float)one_of(setup, 1024);
    float from[3] = {a, b, -a - b};
    float x = 0x1p-8f * (float)((int)one_of(setup, 512) - 256), y = 0x1p-8f * (float)((int)one_of(setup, 512) - 256);
    add_ray(setup, from, (float[]){x, y, -x - y});
  }
}

/* --- shapes --- */

static void make_needles(struct setup *setup, uint32_t rays) {
  for (int i = 0; i < 300; i++) {
    float base[3], tip[3], side[3];
    for (int axis = 0; axis < 3; axis++) {
      base[axis] = any(setup);
      tip[axis] = base[axis] + any(setup);
      side[axis] = base[axis] + 1e-8f * any(setup) + 0x1p-23f * base[axis] * (float)(int)one_of(setup, 2);
    }
    triangle_at(setup, base, tip, side);
  }
  for (uint32_t i = 0; i < rays; i++) {
    float from[3] = {3 * any(setup), 3 * any(setup), 3 * any(setup)}, at[3];
    random_target(setup, at);
    aim(setup, from, at);
  }
}

/* A closed tube, 10^8 times as long as it is wide. */
static void make_tube(struct setup *setup, uint32_t rays) {
  enum { RINGS = 40 };
  const float width = 2e-8f, profile[3][2] = {{1, 0}, {-0.5f, 0.75f}, {-0.5f, -1}};
  float ring[RINGS + 1][3][3];
  for (int r = 0; r <= RINGS; r++)
    for (int p = 0; p < 3; p++) {
      ring[r][p][0] = -1 + 2 * (float)r / RINGS;
      ring[r][p][1] = width * profile[p][0], ring[r][p][2] = width * profile[p][1];
    }
  for (int r = 0; r < RINGS; r++)
    for (int p = 0; p < 3; p++) {
      triangle_at(setup, ring[r][p], ring[r][(p + 1) % 3], ring[r + 1][p]);
      triangle_at(setup, ring[r + 1][p], ring[r][(p + 1) % 3], ring[r + 1][(p + 1) % 3]);
    }
  triangle_at(setup, ring[0][0], ring[0][1], ring[0][2]);
  triangle_at(setup, ring[RINGS][0], ring[RINGS][1], ring[RINGS][2]);
  for (uint32_t i = 0; i < rays; i++) {
    float from[3] = {0.95f * any(setup), 0.2f * width * any(setup), 0.2f * width * any(setup)};
    float direction[3] = {any(setup), any(setup), any(setup)};
    if (i & 1)
      direction[0] *= i & 2 ? 1e7f : 1e9f;
    add_ray(setup, from, direction);
  }
}

static void make_tiny_details(struct setup *setup, uint32_t rays) {
  for (int i = 0; i < 60; i++) {
    struct globe globe = {{1e-4f * any(setup), 1e-4f * any(setup), 1e-4f * any(setup)}, 1e-6f, 0.2f};
    add_globe(setup, 2, &globe);
  }
  uint32_t rocks = setup->mesh.triangle_count;
  add_globe(setup, 8, &(struct globe){{0, 0, 0}, 1e6f, 0.1f});
  for (uint32_t i = 0; i < rays; i++) {
    float from[3], at[3];
    float distance = i % 3 == 0 ? 1e-4f : i % 3 == 1 ? 1 : 1e5f;
    for (int axis = 0; axis < 3; axis++) {
      from[axis] = distance * any(setup);
      at[axis] = setup->mesh.vertices[3 * one_of(setup, rocks)][axis];
    }
    aim(setup, from, at);
  }
}

/* A bowl of seats 200 across with a globe of 0.1 on the field. */
static void make_stadium(struct setup *setup, uint32_t rays) {
  float top[3] = {0, 0, 0};
  for (int row = 0; row < 12; row++)
    for (int seat = 0; seat < 40; seat++) {
      float angle = (float)seat * 0.157f, radius = 60 + 3 * (float)row;
      float x = radius * cosf(angle), z = radius * sinf(angle), y = 1.5f * (float)row;
      mesh_box(&setup->mesh, (float[]){x, y, z}, (float[]){x + 0.5f, y + 0.4f, z + 0.5f}, 0);
    }
  mesh_box(&setup->mesh, (float[]){-100, -50, -100}, (float[]){100, 50, 100}, 0);
  mesh_box(&setup->mesh, (float[]){-100, -50, -100}, (float[]){100, -0.1f, 100}, 0);
  uint32_t before = setup->mesh.triangle_count;
  add_globe(setup, 16, &(struct globe){{0.3f, 0, 0.2f}, 0.1f, 0.1f});
  for (uint32_t i = 0; i < rays; i++) {
    float from[3] = {60 * any(setup), 5 + 20 * random_unit(&setup->seed), 60 * any(setup)}, at[3];
    uint32_t triangle = i & 1 ? before + one_of(setup, setup->mesh.triangle_count - before) : one_of(setup, before);
    memcpy(at, setup->mesh.vertices[setup->mesh.triangles[triangle].vertices[i % 3]], sizeof at);
    if (i & 4)
      for (int axis = 0; axis < 3; axis++)
        at[axis] += 0.01f * any(setup);
    aim(setup, i & 8 ? top : from, at);
  }
}

static void make_soup(struct setup *setup, uint32_t rays) {
  mesh_soup(&setup->mesh, 1000, 5);
  for (uint32_t i = 0; i < rays; i++) {
    float from[3] = {2 * any(setup), 2 * any(setup), 2 * any(setup)}, at[3];
    random_target(setup, at);
    aim(setup, from, at);
  }
}

/* A ground that rays meet at an angle of a millionth. */
static void make_grazing_ground(struct setup *setup, uint32_t rays) {
  for (int i = -16; i < 16; i++)
    for (int j = -4; j < 4; j++) {
      float x = (float)i, z = (float)j;
      float a[3] = {x, 0, z}, b[3] = {x + 1, 0, z}, c[3] = {x, 0, z + 1}, d[3] = {x + 1, 0, z + 1};
      triangle_at(setup, a, b, c);
      triangle_at(setup, b, d, c);
    }
  for (uint32_t i = 0; i < rays; i++) {
    float from[3] = {-15, 2e-5f * random_unit(&setup->seed), 3 * any(setup)};
    add_ray(setup, from, (float[]){1, -1e-6f, 0.1f * any(setup)});
  }
}

static void make_one_triangle(struct setup *setup, uint32_t rays) {
  triangle_at(setup, (float[]){0, 0, 0}, (float[]){1, 0, 0}, (float[]){0, 1, 0});
  for (uint32_t i = 0; i < rays; i++) {
    float from[3] = {any(setup), any(setup), any(setup)}, at[3];
    random_target(setup, at);
    if (i & 1)
      at[0] += 0.5f * any(setup), at[1] += 0.5f * any(setup);
    aim(setup, from, at);
  }
}

static void make_nothing(struct setup *setup, uint32_t rays) {
  for (uint32_t i = 0; i < rays; i++)
    add_ray(setup, nowhere, (float[]){any(setup), any(setup), 1});
}

/* Points, lines, and triangles whose area vanishes in binary32, on the inside of a closed surface. */
static void make_degenerate(struct setup *setup, uint32_t rays) {
  make_globe(setup, rays);
  uint32_t vertices = setup->mesh.vertex_count;
  for (uint32_t i = 0; i < 200; i++) {
    uint32_t a = one_of(setup, vertices), b = one_of(setup, vertices);
    mesh_triangle(&setup->mesh, a, i & 1 ? a : b, i & 2 ? a : b, 0);
    float at[3], near_by[3];
    random_target(setup, at);
    for (int axis = 0; axis < 3; axis++) {
      at[axis] *= 0.5f;
      near_by[axis] = nextafterf(at[axis], 9);
    }
    triangle_at(setup, at, near_by, setup->mesh.vertices[a]);
  }
}

/* Triangles of 10^-21 in a scene of 1, seen from there and from afar: determinants beyond binary32's range. Along an
   axis afar is as exact as near by: there the determinants are subnormal, and what they are multiplied with is not. */
static void make_vanishing_determinants(struct setup *setup, uint32_t rays) {
  add_globe(setup, 3, &(struct globe){{0, 0, 0}, 1, 0});
  add_globe(setup, 3, &(struct globe){{0, 0, 0}, 1e-21f, 0});
  add_globe(setup, 3, &(struct globe){{0, 0, 0}, 1e-19f, 0});
  add_globe(setup, 3, &(struct globe){{0, 0, 0}, 1e-23f, 0});
  for (uint32_t i = 0; i < rays; i++) {
    float distance = i % 3 == 0 ? 0.5f : i % 3 == 1 ? 3e-21f : 2e-22f, at[3];
    float from[3] = {distance * any(setup), distance * any(setup), distance * any(setup)};
    random_target(setup, at);
    if (i % 4 == 0) {
      for (int axis = 0; axis < 3; axis++)
        at[axis] = from[axis] = 1e-19f * any(setup);
      from[i / 4 % 3] = -0.5f;
    }
    aim(setup, from, at);
  }
}

/* --- the same place twice --- */

static void duplicates(struct setup *setup, uint32_t rays) {
  add_globe(setup, 5, &(struct globe){{0, 0, 0}, 1, 0.1f});
  uint32_t once = setup->mesh.triangle_count;
  for (uint32_t copy = 0; copy < 6; copy++)
    for (uint32_t i = 0; i < once; i++) {
      const uint32_t *v = setup->mesh.triangles[(i * 7 + copy) % once].vertices;
      mesh_triangle(&setup->mesh, v[0], v[1], v[2], 0);
    }
  for (uint32_t i = 0; i < rays; i++) {
    float from[3] = {0.3f * any(setup), 0.3f * any(setup), 0.3f * any(setup)};
    add_ray(setup, from, (float[]){any(setup), any(setup), any(setup)});
  }
}

static void make_duplicates(struct setup *setup, uint32_t rays) {
  duplicates(setup, rays);
}

/* Traversed the other way round. */
static void make_duplicates_turned(struct setup *setup, uint32_t rays) {
  duplicates(setup, rays);
  setup->turned = true;
}

static void make_duplicates_alone(struct setup *setup, uint32_t rays) {
  duplicates(setup, rays);
  setup->build.max_leaf = 1;
  setup->build.traversal_cost = 3;
}

/* Squares one behind the other, so many units in the last place apart, at right angles to no axis. */
static void layers(struct setup *setup, uint32_t rays, int apart) {
  for (int layer = 0; layer < 12; layer++) {
    float corner[4][3];
    for (int c = 0; c < 4; c++) {
      corner[c][0] = c == 1 || c == 2 ? 1 : -1;
      corner[c][1] = c >= 2 ? 1 : -1;
      corner[c][2] = 1.5f + (float)(apart * layer) * 0x1p-23f;
    }
    triangle_at(setup, corner[0], corner[1], corner[2]);
    triangle_at(setup, corner[0], corner[2], corner[3]);
  }
  for (uint32_t i = 0; i < rays; i++) {
    float from[3] = {any(setup), any(setup), i & 1 ? 0 : 3}, at[3] = {0.9f * any(setup), 0.9f * any(setup), 1.5f};
    aim(setup, from, at);
  }
}

static void make_layers_1(struct setup *setup, uint32_t rays) {
  layers(setup, rays, 1);
}
static void make_layers_2(struct setup *setup, uint32_t rays) {
  layers(setup, rays, 2);
}
static void make_layers_3(struct setup *setup, uint32_t rays) {
  layers(setup, rays, 3);
}
static void make_layers_4(struct setup *setup, uint32_t rays) {
  layers(setup, rays, 4);
}

/* --- depth --- */

/* Triangles each a little smaller than the one before, down through 179 octaves: surface areas alone lead to a tree
   far deeper than allowed, which is far deeper than the device's stack. */
static void make_deep(struct setup *setup, uint32_t rays) {
  for (int i = 0; i < 5000; i++) {
    float size = exp2f(59 - 0.0358f * (float)i);
    triangle_at(setup, (float[]){size, 0, 0}, (float[]){0, size, 0}, (float[]){0, 0, size});
  }
  setup->build.max_depth = TRAX_SCENE_MAX_DEPTH;
  for (uint32_t i = 0; i < rays; i++) {
    float size = exp2f(30 + 28 * any(setup));
    float at[3] = {0.3f * size, 0.3f * size, 0.3f * size};
    float from[3] = {size * (1 + any(setup)), size * (2 + any(setup)), size * (2 + any(setup))};
    aim(setup, from, at);
  }
}

/* The triangle at `turned` fills the other half of its box: half of the rays go down through all nodes, miss
   everything, and must find it on the way back, when a short stack has lost it. */
static void chain(struct setup *setup, uint32_t rays, uint32_t turned) {
  chain_scene(&setup->premade);
  struct trax_triangle *triangle = (struct trax_triangle *)setup->premade.triangles + turned;
  const float z = triangle->v0[2];
  *triangle = (struct trax_triangle){{3, 3, z}, {-1, 3, z}, {3, -1, z}, 0};
  for (uint32_t i = 0; i < rays; i++) {
    float from[3] = {any(setup), any(setup), i & 1 ? 5 : -80}, at[3] = {2 * any(setup), 2 * any(setup), -20};
    if (i & 2)
      for (int axis = 0; axis < 2; axis++)
        from[axis] = 2.2f + 0.5f * any(setup), at[axis] = from[axis];
    aim(setup, from, at);
  }
}

static void make_chain(struct setup *setup, uint32_t rays) {
  chain(setup, rays, 5);
}
static void make_chain_below(struct setup *setup, uint32_t rays) {
  chain(setup, rays, 40);
}

/* --- vertices that are no points --- */

static void fail(const char *what) {
  fprintf(stderr, "render-extreme: error: nonfinite: %s\n", what);
  exit(1);
}

/* A closed surface with further triangles that have a NaN, an infinity or 10^20 in a vertex: the importer refuses them,
   naming their count and the first, and leaves them out if asked to. */
static void make_nonfinite(struct setup *setup, uint32_t rays) {
  static const char *const bad[] = {"nan", "inf", "-inf", "1e20", "-nan"};
  struct setup good = {0};
  add_globe(&good, 4, &(struct globe){{0, 0, 0}, 1, 0});
  char path[] = "/tmp/render-extreme-XXXXXX.ply";
  int descriptor = mkstemps(path, 4);
  FILE *file = descriptor >= 0 ? fdopen(descriptor, "w") : NULL;
  if (!file)
    fail("no temporary file");
  const uint32_t count = good.mesh.triangle_count, bad_count = sizeof bad / sizeof *bad;
  fprintf(file,
          "ply\nformat ascii 1.0\nelement vertex %u\nproperty float x\nproperty float y\nproperty float z\n"
          "element face %u\nproperty list uchar int vertex_indices\nend_header\n",
          3 * count + bad_count, count + bad_count);
  for (uint32_t i = 0; i < 3 * count; i++)
    fprintf(file, "%.9g %.9g %.9g\n", (double)good.mesh.vertices[i][0], (double)good.mesh.vertices[i][1],
            (double)good.mesh.vertices[i][2]);
  for (uint32_t i = 0; i < bad_count; i++)
    fprintf(file, "%s %s 0\n", i & 1 ? "0" : bad[i], i & 1 ? bad[i] : "0");
  for (uint32_t i = 0; i < count; i++) {
    if (i >= 7 && i < 7 + bad_count) /* the first of them is number 7 */
      fprintf(file, "3 0 1 %u\n", 3 * count + i - 7);
    fprintf(file, "3 %u %u %u\n", 3 * i, 3 * i + 1, 3 * i + 2);
  }
  fclose(file);

  const char *const paths[] = {path};
  struct trax_import_options options = {.in_process = true};
  struct trax_import_report report;
  trax_error error;
  if (trax_mesh_import(&setup->mesh, paths, 1, &options, &report, &error) != TRAX_ERROR)
    fail("imported");
  if (!strstr(error.message, "5 of 133 triangles") || !strstr(error.message, "the first is triangle 7 "))
    fail(error.message);
  options.drop_nonfinite = true;
  if (trax_mesh_import(&setup->mesh, paths, 1, &options, &report, &error) != TRAX_OK)
    fail(error.message);
  if (report.nonfinite != bad_count || setup->mesh.triangle_count != count)
    fail("not all of them are left out");
  unlink(path);
  setup_release(&good);
  aim_from_within(setup, nowhere, 0.4f, rays);
}

/* --- shadows --- */

/* Rays from around at a globe; the light low over its horizon: half of the points are within a degree of the border
   between day and night. */
static void grazing_globe(struct setup *setup, uint32_t rays, float offset) {
  add_globe(setup, 20, &(struct globe){{offset, offset, offset}, 1, 0});
  setup->light[0] = offset + 50, setup->light[1] = setup->light[2] = offset;
  for (uint32_t i = 0; i < rays; i++) {
    float normal[3] = {i & 1 ? 0.02f + 0.02f * any(setup) : random_unit(&setup->seed), any(setup), any(setup)};
    float length = sqrtf(normal[1] * normal[1] + normal[2] * normal[2]), from[3], at[3];
    if (length < 0.01f)
      continue;
    for (int axis = 0; axis < 3; axis++) {
      if (i & 1 && axis > 0)
        normal[axis] /= length;
      at[axis] = offset + 0.99f * normal[axis];
      from[axis] = offset + 3 * normal[axis] + 2 * any(setup);
    }
    if (i & 2) { /* seen as flatly as it is lit: from along the surface */
      float turn = any(setup) > 0 ? 3.0f : -3.0f;
      for (int axis = 0; axis < 3; axis++)
        at[axis] = offset + 0.999f * normal[axis];
      from[0] = at[0];
      from[1] = at[1] - turn * normal[2];
      from[2] = at[2] + turn * normal[1];
    }
    aim(setup, from, at);
  }
}

static void make_grazing_globe(struct setup *setup, uint32_t rays) {
  grazing_globe(setup, rays, 0);
}

static void make_grazing_globe_away(struct setup *setup, uint32_t rays) {
  grazing_globe(setup, rays, 1000);
}

/* At edges and corners of a room, exactly and close by, from inside. */
static void corners(struct setup *setup, uint32_t rays) {
  mesh_box(&setup->mesh, (float[]){-2, -1, -3}, (float[]){2, 1, 3}, 0);
  const float half[3] = {2, 1, 3};
  for (uint32_t i = 0; i < rays; i++) {
    float from[3], at[3];
    for (int axis = 0; axis < 3; axis++) {
      from[axis] = 0.9f * half[axis] * any(setup);
      at[axis] = half[axis] * (i >> axis & 1 ? 1.0f : -1.0f);
    }
    uint32_t free = i % 3; /* along this edge; every sixth into the corner */
    if (i % 6 != 0)
      at[free] = half[free] * any(setup);
    if (i & 8) /* beside it */
      at[(free + 1) % 3] *= 1 - exp2f(-10 - 14 * random_unit(&setup->seed));
    aim(setup, from, at);
  }
}

static void make_corners_dark(struct setup *setup, uint32_t rays) {
  corners(setup, rays);
  setup->light[0] = 5, setup->light[1] = 4, setup->light[2] = 7;
}

static void make_corners_lit(struct setup *setup, uint32_t rays) {
  corners(setup, rays);
  setup->light[0] = 0.3f, setup->light[1] = 0.4f, setup->light[2] = -0.2f;
}

/* A light on a vertex of a room, and in the planes of its walls. */
static void make_light_on_surface(struct setup *setup, uint32_t rays) {
  corners(setup, rays);
  setup->light[0] = 2, setup->light[1] = 1, setup->light[2] = 3;
}

/* --- pictures: the rays are those of the pixels --- */

static void picture(struct setup *setup, uint32_t width, uint32_t height, struct trax_view view) {
  setup->view = view;
  setup->width = width, setup->height = height;
  memcpy(setup->light, view.light, sizeof setup->light);
}

static void make_picture_empty(struct setup *setup, uint32_t rays) {
  (void)rays;
  picture(setup, 24, 16, view_from(0, 0, 0, 0, 0, -1, 60, 0, 1, 0));
}

static void make_picture_room(struct setup *setup, uint32_t width, uint32_t height) {
  add_blocks(setup);
  picture(setup, width, height, view_from(-0.7f, 0.6f, 0.8f, 0.6f, -0.6f, -1, 70, 0.3f, 0.8f, 0.7f));
}

static void make_picture_1x1(struct setup *setup, uint32_t rays) {
  (void)rays;
  make_picture_room(setup, 1, 1);
}

static void make_picture_1xN(struct setup *setup, uint32_t rays) {
  (void)rays;
  make_picture_room(setup, 1, 333);
}

static void make_picture_Nx1(struct setup *setup, uint32_t rays) {
  (void)rays;
  make_picture_room(setup, 333, 1);
}

static void make_picture_small(struct setup *setup, uint32_t rays) {
  (void)rays;
  make_picture_room(setup, 5, 3);
}

static void make_picture_hardware(struct setup *setup, uint32_t rays) {
  (void)rays;
  make_picture_room(setup, 24, 16);
}

/* The room at 10^7, where floats are a unit apart: it is 128 of them wide. */
static void make_picture_offset(struct setup *setup, uint32_t rays) {
  (void)rays;
  add_blocks(setup);
  mesh_transform(&setup->mesh, 64, 1e7f, -1e7f, 1e7f);
  picture(setup, 48, 36,
          view_from(1e7f - 45, -1e7f + 38, 1e7f + 51, 0.6f, -0.6f, -1, 70, 1e7f + 19, -1e7f + 51, 1e7f + 45));
}

static void make_picture_within(struct setup *setup, uint32_t rays) {
  (void)rays;
  add_globe(setup, 6, &(struct globe){{0, 0, 0}, 1, 0});
  add_globe(setup, 6, &(struct globe){{0, 0, 0}, 0x1p-20f, 0}); /* the eye is in it, on a plane of its box */
  picture(setup, 48, 32, view_from(0, 0, 0, 1, 1, -1, 100, 0, 0.1f, 0));
}

static void make_picture_on_vertex(struct setup *setup, uint32_t rays) {
  (void)rays;
  add_globe(setup, 6, &(struct globe){{0, 0, 0}, 1, 0});
  mesh_box(&setup->mesh, (float[]){-0.5f, -0.5f, -0.5f}, (float[]){0, 0, 0}, 0);
  picture(setup, 48, 32, view_from(0, 0, 0, 1, 0, 0, 120, 0, 0.4f, 0));
}

const struct extreme_case extreme_cases[] = {
    {"closed-globe", "edges and vertices of a closed surface, from inside", make_globe, CASE_CLOSED},
    {"closed-100k", "the same, 100,352 triangles of a rough surface", make_rough_globe, CASE_CLOSED | CASE_MANY_RAYS},
    {"axis-plus-zero", "parallel to an axis, other components +0", make_axis_parallel, CASE_CLOSED},
    {"axis-minus-zero", "parallel to an axis, other components -0", make_axis_parallel_negative, CASE_CLOSED},
    {"on-box-planes", "origins on planes of boxes, half of the ways within them", make_box_planes, CASE_CLOSED},
    {"flat-boxes", "boxes without thickness, half of the rays in their planes", make_flat_boxes, 0},
    {"in-planes", "rays in the planes of triangles", make_rays_in_planes, 0},
    {"needles", "triangles 10^8 times as long as wide", make_needles, 0},
    {"closed-tube", "inside a closed tube 10^8 times as long as wide", make_tube, CASE_CLOSED | CASE_BELOW_ROUNDING},
    {"tiny-details", "rocks of 10^-6 in a scene of 10^6", make_tiny_details, CASE_CLOSED},
    {"offset", "a closed surface of 64 at 10^7 from the origin", make_offset, CASE_CLOSED},
    {"scale-small", "the unit is 2^-60", make_small_scale, CASE_CLOSED},
    {"scale-large", "the unit is 2^60", make_large_scale, CASE_CLOSED},
    {"subnormal-vertices", "coordinates of some 2^10 units of 2^-149", make_subnormal_coordinates, CASE_CLOSED},
    {"subnormal-components", "direction components below 2^-126", make_subnormal_components, CASE_CLOSED},
    {"directions-10^-20", "directions of length 10^-20", make_short_directions, CASE_CLOSED},
    {"directions-10^20", "directions of length 10^20", make_long_directions, CASE_CLOSED},
    {"directions-least", "directions of length 2^-140", make_subnormal_directions, CASE_CLOSED},
    {"directions-greatest", "directions of length 2^125", make_longest_directions, CASE_CLOSED},
    {"far-origins", "rays from 10^6 times a globe's size away", make_far_origins, 0},
    {"origins-on-surface", "rays that start on edges and vertices", make_origins_on_surfaces, 0},
    {"grazing-ground", "a ground met at an angle of 10^-6", make_grazing_ground, 0},
    {"stadium", "a globe of 0.1 in a stadium of 200", make_stadium, CASE_CLOSED},
    {"soup", "random triangles of sizes 1 to 2^-8", make_soup, 0},
    {"one-triangle", "a scene of one triangle", make_one_triangle, 0},
    {"empty", "a scene of no triangle", make_nothing, 0},
    {"degenerate", "points, lines and slivers in a closed surface", make_degenerate, CASE_CLOSED},
    {"vanishing", "triangles of 10^-21 in a scene of 1", make_vanishing_determinants, CASE_CLOSED},
    {"nonfinite", "NaN and infinity in vertices, left out when asked for", make_nonfinite, CASE_CLOSED},
    {"duplicates", "every triangle seven times", make_duplicates, CASE_CLOSED | CASE_DUPLICATES},
    {"duplicates-alone", "the same, one triangle a leaf", make_duplicates_alone, CASE_CLOSED | CASE_DUPLICATES},
    {"duplicates-turned", "the same, children in the other order", make_duplicates_turned,
     CASE_CLOSED | CASE_DUPLICATES},
    {"layers-1", "layers 1 ulp apart", make_layers_1, 0},
    {"layers-2", "layers 2 ulp apart", make_layers_2, 0},
    {"layers-3", "layers 3 ulp apart", make_layers_3, 0},
    {"layers-4", "layers 4 ulp apart", make_layers_4, 0},
    {"deep", "5,000 triangles through 179 octaves: depth beyond the stack", make_deep, CASE_DEPTH},
    {"deepest", "a chain of as many nodes as there may be", make_chain, CASE_DEPTH},
    {"deepest-below", "the same, what is hit is among the lower half", make_chain_below, CASE_DEPTH},
    {"grazing-shadows", "a globe of 3,200 triangles in grazing light", make_grazing_globe, CASE_SHADOWS},
    {"grazing-shadows-away", "the same, 1000 radii from the origin", make_grazing_globe_away, CASE_SHADOWS},
    {"corners-dark", "edges and corners of a room, light outside", make_corners_dark, CASE_CLOSED | CASE_SHADOWS},
    {"corners-lit", "edges and corners of a room, light inside", make_corners_lit, CASE_CLOSED | CASE_SHADOWS},
    {"light-on-surface", "the light on a corner of the room", make_light_on_surface, CASE_CLOSED | CASE_SHADOWS},
    {"picture-empty", "a picture of nothing", make_picture_empty, 0},
    {"picture-1x1", "one pixel", make_picture_1x1, CASE_CLOSED},
    {"picture-1xN", "1 x 333 pixels", make_picture_1xN, CASE_CLOSED},
    {"picture-Nx1", "333 x 1 pixels", make_picture_Nx1, CASE_CLOSED},
    {"picture-few", "15 pixels, more threads", make_picture_small, CASE_CLOSED},
    {"picture-hardware", "saturated hardware, 12 machines", make_picture_hardware, CASE_CLOSED | CASE_HARDWARE},
    {"picture-offset", "a room of 128 at 10^7 from the origin", make_picture_offset, CASE_CLOSED | CASE_BELOW_ROUNDING},
    {"eye-within", "the eye inside of geometry", make_picture_within, CASE_CLOSED},
    {"eye-on-vertex", "the eye on a vertex", make_picture_on_vertex, CASE_CLOSED},
};
const unsigned extreme_case_count = sizeof extreme_cases / sizeof *extreme_cases;

void setup_release(struct setup *setup) {
  trax_mesh_release(&setup->mesh);
  free(setup->premade.bytes);
  free(setup->rays);
  memset(setup, 0, sizeof *setup);
}
