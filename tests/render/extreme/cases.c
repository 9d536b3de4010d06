/* Cases of geometry: what is hit? */
#include "cases.h"
#include "temporary.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/* numbers: the radius. */
static void make_scaled_globe(struct setup *setup, uint32_t rays) {
  globe_with_rays(setup, 12, 0, 0, 0, (float)setup->numbers[0], 0.1f, rays);
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

/* numbers: the directions' length. */
static void make_scaled_directions(struct setup *setup, uint32_t rays) {
  make_globe(setup, rays);
  for (uint32_t i = 0; i < setup->ray_count; i++)
    for (int axis = 0; axis < 3; axis++)
      setup->rays[i].direction[axis] *= (float)setup->numbers[0];
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

/* numbers: the zero of the other components. */
static void make_axis_parallel(struct setup *setup, uint32_t rays) {
  const float zero = (float)setup->numbers[0];
  add_blocks(setup);
  for (uint32_t i = 0; i < rays; i++) {
    float from[3], direction[3] = {zero, zero, zero};
    for (int axis = 0; axis < 3; axis++)
      from[axis] = one_of(setup, 3) ? 0.25f * (float)((int)one_of(setup, 7) - 3) : 0.99f * any(setup);
    direction[i % 3] = i & 4 ? -1 : 1;
    add_ray(setup, from, direction);
  }
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

static void make_duplicates(struct setup *setup, uint32_t rays) {
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

/* Traversed the other way round. */
static void make_duplicates_turned(struct setup *setup, uint32_t rays) {
  make_duplicates(setup, rays);
  setup->turned = true;
}

static void make_duplicates_alone(struct setup *setup, uint32_t rays) {
  make_duplicates(setup, rays);
  setup->build.max_leaf = 1;
  setup->build.traversal_cost = 3;
}

/* Squares one behind the other. numbers: how many units in the last place they are apart. */
static void make_layers(struct setup *setup, uint32_t rays) {
  for (int layer = 0; layer < 12; layer++) {
    float corner[4][3];
    for (int c = 0; c < 4; c++) {
      corner[c][0] = c == 1 || c == 2 ? 1 : -1;
      corner[c][1] = c >= 2 ? 1 : -1;
      corner[c][2] = 1.5f + (float)setup->numbers[0] * (float)layer * 0x1p-23f;
    }
    triangle_at(setup, corner[0], corner[1], corner[2]);
    triangle_at(setup, corner[0], corner[2], corner[3]);
  }
  for (uint32_t i = 0; i < rays; i++) {
    float from[3] = {any(setup), any(setup), i & 1 ? 0 : 3}, at[3] = {0.9f * any(setup), 0.9f * any(setup), 1.5f};
    aim(setup, from, at);
  }
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
  for (uint32_t i = 0; i < (rays < 1000 ? rays / 4 : rays); i++) { /* each is tested with all triangles */
    float size = exp2f(30 + 28 * any(setup));
    float at[3] = {0.3f * size, 0.3f * size, 0.3f * size};
    float from[3] = {size * (1 + any(setup)), size * (2 + any(setup)), size * (2 + any(setup))};
    aim(setup, from, at);
  }
}

/* One triangle, whose number is given, fills the other half of its box: half of the rays go down through all nodes,
   miss everything, and must find it on the way back. */
static void make_chain(struct setup *setup, uint32_t rays) {
  chain_scene(&setup->premade);
  struct trax_triangle *triangle = (struct trax_triangle *)setup->premade.triangles + (uint32_t)setup->numbers[0];
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
  const char *path = test_path("nonfinite.ply");
  FILE *file = fopen(path, "w");
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
  struct trax_import_options options = {0};
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
  setup_release(&good);
  aim_from_within(setup, nowhere, 0.4f, rays);
}

static const struct extreme_case cases[] = {
    {"closed-globe", "edges and vertices of a closed surface, from inside", BY(make_globe), CASE_CLOSED},
    {"closed-100k", "the same, 100,352 triangles of a rough surface", BY(make_rough_globe),
     CASE_CLOSED | CASE_MANY_RAYS},
    {"axis-plus-zero", "parallel to an axis, other components +0", BY(make_axis_parallel), CASE_CLOSED},
    {"axis-minus-zero", "parallel to an axis, other components -0", BY(make_axis_parallel, -0.0), CASE_CLOSED},
    {"on-box-planes", "origins on planes of boxes, half of the ways within them", BY(make_box_planes), CASE_CLOSED},
    {"flat-boxes", "boxes without thickness, half of the rays in their planes", BY(make_flat_boxes), 0},
    {"in-planes", "rays in the planes of triangles", BY(make_rays_in_planes), 0},
    {"needles", "triangles 10^8 times as long as wide", BY(make_needles), 0},
    {"closed-tube", "inside a closed tube 10^8 times as long as wide", BY(make_tube), CASE_CLOSED},
    {"tiny-details", "rocks of 10^-6 in a scene of 10^6", BY(make_tiny_details), CASE_CLOSED},
    {"offset", "a closed surface of 64 at 10^7 from the origin", BY(make_offset), CASE_CLOSED},
    {"scale-small", "the unit is 2^-60", BY(make_scaled_globe, 0x1p-60), CASE_CLOSED},
    {"scale-large", "the unit is 2^60", BY(make_scaled_globe, 0x1p60), CASE_CLOSED},
    {"subnormal-vertices", "coordinates of some 2^10 units of 2^-149", BY(make_scaled_globe, 0x1p-137), CASE_CLOSED},
    {"subnormal-components", "direction components below 2^-126", BY(make_subnormal_components), CASE_CLOSED},
    {"directions-10^-20", "directions of length 10^-20", BY(make_scaled_directions, 1e-20), CASE_CLOSED},
    {"directions-10^20", "directions of length 10^20", BY(make_scaled_directions, 1e20), CASE_CLOSED},
    {"directions-least", "directions of length 2^-140", BY(make_scaled_directions, 0x1p-140), CASE_CLOSED},
    {"directions-greatest", "directions of length 2^125", BY(make_scaled_directions, 0x1p125), CASE_CLOSED},
    {"far-origins", "rays from 10^6 times a globe's size away", BY(make_far_origins), 0},
    {"origins-on-surface", "rays that start on edges and vertices", BY(make_origins_on_surfaces), 0},
    {"grazing-ground", "a ground met at an angle of 10^-6", BY(make_grazing_ground), 0},
    {"stadium", "a globe of 0.1 in a stadium of 200", BY(make_stadium), CASE_CLOSED},
    {"soup", "random triangles of sizes 1 to 2^-8", BY(make_soup), 0},
    {"one-triangle", "a scene of one triangle", BY(make_one_triangle), 0},
    {"empty", "a scene of no triangle", BY(make_nothing), 0},
    {"degenerate", "points, lines and slivers in a closed surface", BY(make_degenerate), CASE_CLOSED},
    {"vanishing", "triangles of 10^-21 in a scene of 1", BY(make_vanishing_determinants), CASE_CLOSED},
    {"nonfinite", "NaN and infinity in vertices, left out when asked for", BY(make_nonfinite), CASE_CLOSED},
    {"duplicates", "every triangle seven times", BY(make_duplicates), CASE_CLOSED | CASE_DUPLICATES},
    {"duplicates-alone", "the same, one triangle a leaf", BY(make_duplicates_alone), CASE_CLOSED | CASE_DUPLICATES},
    {"duplicates-turned", "the same, children in the other order", BY(make_duplicates_turned),
     CASE_CLOSED | CASE_DUPLICATES},
    {"layers-1", "layers 1 ulp apart", BY(make_layers, 1), 0},
    {"layers-2", "layers 2 ulp apart", BY(make_layers, 2), 0},
    {"layers-3", "layers 3 ulp apart", BY(make_layers, 3), 0},
    {"layers-4", "layers 4 ulp apart", BY(make_layers, 4), 0},
    {"deep", "5,000 triangles through 179 octaves: as deep a tree as there may be", BY(make_deep), 0},
    {"deepest", "a chain of as many nodes as there may be", BY(make_chain, 5), 0},
    {"deepest-below", "the same, what is hit is among the lower half", BY(make_chain, 40), 0},
};

const struct extreme_case *extreme_case(unsigned number) {
  const struct {
    const struct extreme_case *cases;
    unsigned count;
  } lists[] = {{cases, sizeof cases / sizeof *cases},
               {range_cases, range_case_count},
               {instance_cases, instance_case_count},
               {picture_cases, picture_case_count}};
  for (unsigned i = 0; i < sizeof lists / sizeof *lists; number -= lists[i++].count)
    if (number < lists[i].count)
      return &lists[i].cases[number];
  return NULL;
}
