/* The device program's own functions, one by one: which pixel a slot is, what a ray hits. */
#include "meshes.h"

static _Bool exact; /* which hits the functions below are to find */
#define TRAX_EXACT_HITS exact

#include "../../raytracer/device/exact.h"

#include "../../raytracer/device/camera.h"
#include "../../raytracer/device/shade.h"
#include "../../raytracer/device/traverse.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* Every pixel has exactly one slot. */
static void test_slots_are_pixels(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  struct trax_view view = view_from(0, 0, 0, 0, 0, -1, 60, 0, 1, 0);
  struct trax_scene scene = scene_of(&mesh, NULL);
  unsigned char *seen = malloc(300 * 300);
  assert_non_null(seen);
  for (uint32_t width = 1; width <= 300; width += width < 12 ? 1 : width < 70 ? 7 : 43)
    for (uint32_t height = 1; height <= 300; height += height < 8 ? 1 : 29) {
      struct trax_frame frame;
      struct trax_frame_options options = {.width = width, .height = height, .samples = 1};
      trax_error error;
      assert_int_equal(trax_frame_init(&frame, &scene, &view, &options, &error), TRAX_OK);
      memset(seen, 0, 300 * 300);
      uint32_t found = 0;
      for (uint32_t slot = 0; slot < frame.params->slot_count; slot++) {
        struct pixel pixel;
        if (slot_pixel(frame.params, slot, &pixel)) {
          assert_int_equal(seen[pixel_y(pixel) * width + pixel_x(pixel)]++, 0);
          found++;
        }
      }
      assert_int_equal(found, width * height);
      trax_frame_release(&frame);
    }
  free(seen);
  trax_scene_release(&scene);
}

/* The division by multiplication, for all numbers of tiles across, at the ends of the rows of the tallest picture. */
static void test_slots_of_large_pictures(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  struct trax_view view = view_from(0, 0, 0, 0, 0, -1, 60, 0, 1, 0);
  struct trax_scene scene = scene_of(&mesh, NULL);
  const uint32_t side = 1u << TRAX_TILE_LOG2_SIDE;
  for (uint32_t width = 1; width <= TRAX_RENDER_MAX_SIDE; width += width % side == 1 ? side - 1 : 1) {
    struct trax_frame frame;
    struct trax_frame_options options = {.width = width, .height = TRAX_RENDER_MAX_SIDE, .samples = 1};
    trax_error error;
    assert_int_equal(trax_frame_init(&frame, &scene, &view, &options, &error), TRAX_OK);
    const struct trax_render_params *params = frame.params;
    uint32_t per_tile = 2 * params->tile_log2_side;
    for (uint32_t row = 1; row <= TRAX_RENDER_MAX_SIDE >> params->tile_log2_side; row += 61) {
      struct pixel pixel;
      uint32_t tile = row * params->tiles_across; /* the first of this row, and the last of the one above */
      slot_pixel(params, tile << per_tile, &pixel);
      assert_int_equal(pixel_x(pixel), 0);
      assert_int_equal(pixel_y(pixel), row << params->tile_log2_side);
      slot_pixel(params, (tile - 1) << per_tile, &pixel);
      assert_int_equal(pixel_x(pixel), (params->tiles_across - 1) << params->tile_log2_side);
      assert_int_equal(pixel_y(pixel), (row - 1) << params->tile_log2_side);
    }
    trax_frame_release(&frame);
  }
  trax_scene_release(&scene);
}

static bool shoot(const struct trax_scene *scene, const float from[3], const float to[3], struct hit *hit) {
  struct ray ray;
  const enum trax_node_layout layout = scene->header->node_layout;
  struct trax_ray_grid grid;
  memcpy(grid.origin, scene->grid.origin, sizeof grid.origin);
  memcpy(grid.cell, scene->grid.cell, sizeof grid.cell);
  float margin = 0x1p-16f; /* as frame.c has it for a scene of this size */
  const struct vector origin = load_vector(from);
  prepare_ray(&ray, layout, origin, minus(load_vector(to), origin), margin, &grid);
  *hit = (struct hit){0x7F000000, 0, 0, 0};
  bool nearest = trace_ray(layout, scene->bytes, scene->header->root, &ray, false, hit);
  struct hit any = {0x7F000000, 0, 0, 0};
  assert_int_equal(nearest, trace_ray(layout, scene->bytes, scene->header->root, &ray, true, &any));
  return nearest;
}

/* Every ray from within a closed surface hits, aimed exactly at vertices, at points of edges, or anywhere. */
static void test_no_ray_leaves_a_closed_surface(void **state) {
  struct trax_mesh mesh = {0};
  struct trax_scene scene = {0};
  mesh_sphere(&mesh, 1.5f, exact ? 3 : 4, 0);
  build(&scene, &mesh, &(struct trax_build_options){.nodes = *(const enum trax_node_layout *)*state});
  uint32_t seed = 7;
  struct hit hit;
  for (int i = 0; i < 40; i++) {
    float from[3] = {0, 0, 0};
    for (int c = 0; c < 3 && i > 0; c++)
      from[c] = i < 8 ? ldexpf(1, -i * 5) * (float)(c == i % 3) : 1.4f * random_unit(&seed) - 0.7f;
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
      assert_true(shoot(&scene, from, mesh.vertices[v], &hit));
    for (uint32_t t = 0; t < mesh.triangle_count; t++)
      for (int corner = 0; corner < 3; corner++) {
        const float *a = mesh.vertices[mesh.triangles[t].vertices[corner]];
        const float *b = mesh.vertices[mesh.triangles[t].vertices[(corner + 1) % 3]];
        float along = i & 1 ? 0.5f : random_unit(&seed), to[3];
        for (int c = 0; c < 3; c++)
          to[c] = a[c] + along * (b[c] - a[c]);
        assert_true(shoot(&scene, from, to, &hit));
      }
  }
  trax_scene_release(&scene);
  trax_mesh_release(&mesh);
}

/* The nearest of all hits, against every triangle tested in binary64. Rays that pass within 1e-5 of an edge are left
   out: there both answers are right. */
static void test_nearest_hit(void **state) {
  struct trax_mesh mesh = {0};
  mesh_soup(&mesh, 400, 99);
  struct trax_scene scene =
      scene_of(&mesh, &(struct trax_build_options){.nodes = *(const enum trax_node_layout *)*state});
  uint32_t seed = 3;
  unsigned hits = 0, misses = 0;
  const int rays = exact ? 5000 : 20000;
  for (int i = 0; i < rays; i++) {
    float from[3], to[3];
    for (int c = 0; c < 3; c++)
      from[c] = 4 * random_unit(&seed) - 2, to[c] = 2 * random_unit(&seed) - 1;
    if (i % 5 == 0) /* parallel to an axis */
      for (int c = 0; c < 3; c++)
        to[c] = c == i % 3 ? to[c] : from[c];
    double nearest = INFINITY, direction[3];
    bool doubtful = false;
    for (int c = 0; c < 3; c++)
      direction[c] = to[c] - from[c];
    for (uint32_t t = 0; t < scene.triangle_count; t++) {
      const struct trax_triangle *triangle = &scene.triangles[t];
      double e[3], f[3], s[3];
      for (int c = 0; c < 3; c++) {
        e[c] = (double)triangle->v1[c] - triangle->v0[c];
        f[c] = (double)triangle->v2[c] - triangle->v0[c];
        s[c] = (double)from[c] - triangle->v0[c];
      }
      double p[3], q[3], det = 0, u = 0, v = 0, distance = 0;
      for (int c = 0; c < 3; c++) {
        int c1 = (c + 1) % 3, c2 = (c + 2) % 3;
        p[c] = direction[c1] * f[c2] - direction[c2] * f[c1];
        q[c] = s[c1] * e[c2] - s[c2] * e[c1];
      }
      for (int c = 0; c < 3; c++)
        det += e[c] * p[c], u += s[c] * p[c], v += direction[c] * q[c], distance += f[c] * q[c];
      u /= det, v /= det, distance /= det;
      double inside = fmin(fmin(u, v), 1 - u - v);
      if (inside > -1e-4 && inside < 1e-4 && distance > -1e-4)
        doubtful = true;
      if (inside > 0 && distance > 0 && distance < nearest)
        nearest = distance;
    }
    if (doubtful)
      continue;
    struct hit hit;
    bool found = shoot(&scene, from, to, &hit);
    assert_int_equal(found, nearest < INFINITY);
    if (found)
      assert_true(fabs((double)bits_float(hit.distance_bits) - nearest) <= 1e-4 * (1 + nearest));
    hits += found, misses += !found;
  }
  assert_true((int)hits > rays / 10 && (int)misses > rays / 10);
  trax_scene_release(&scene);
}

/* The point that shadow rays start from is off the plane by enough: no ray that leads away from the plane meets the
   triangle again. */
static void test_shadow_rays_start_off_the_surface(void **state) {
  (void)state;
  uint32_t seed = 11;
  unsigned tested = 0;
  const int rays = exact ? 20000 : 200000;
  for (int i = 0; i < rays; i++) {
    struct trax_triangle triangle = {.material = 0};
    float *values = triangle.v0, offset = i % 4 == 0 ? 1000.0f : 0;
    float size = ldexpf(1, -(int)(6 * random_unit(&seed)));
    for (int c = 0; c < 9; c++)
      values[c] = offset + size * (2 * random_unit(&seed) - 1);
    float from[3], weight1 = 0.8f * random_unit(&seed), weight2 = (1 - weight1) * random_unit(&seed), to[3];
    struct hit hit = {0x7F000000, 0, 0, 0};
    for (int c = 0; c < 3; c++) {
      from[c] = offset + 4 * random_unit(&seed) - 2;
      to[c] = values[c] + weight1 * (values[3 + c] - values[c]) + weight2 * (values[6 + c] - values[c]);
    }
    struct ray ray;
    struct vector eye = load_vector(from), towards = minus(load_vector(to), eye);
    prepare_ray(&ray, TRAX_NODES_BINARY, eye, towards, 0, NULL);
    if (!hit_triangle(&ray.triangle, (const char *)&triangle, false, &hit))
      continue;
    struct surface surface;
    find_surface(&surface, &hit, eye, towards);

    /* Any way that leads away from the plane. */
    struct vector way = {2 * random_unit(&seed) - 1, 2 * random_unit(&seed) - 1, 2 * random_unit(&seed) - 1};
    if (dot(way, surface.normal) < 0)
      way.x = -way.x, way.y = -way.y, way.z = -way.z;
    prepare_ray(&ray, TRAX_NODES_BINARY, surface.start, way, 0, NULL);
    struct hit self = {0x7F000000, 0, 0, 0};
    assert_false(hit_triangle(&ray.triangle, (const char *)&triangle, true, &self));
    tested++;
  }
  assert_true((int)tested > rays / 4 * 3);
}

int main(void) {
  enum trax_node_layout layouts[TRAX_NODE_LAYOUTS];
  for (unsigned i = 0; i < TRAX_NODE_LAYOUTS; i++)
    layouts[i] = (enum trax_node_layout)i;
#define OF_LAYOUT(TEST, LAYOUT) {#TEST ", " #LAYOUT, TEST, NULL, NULL, &layouts[TRAX_NODES_##LAYOUT]}
  const struct CMUnitTest slots[] = {cmocka_unit_test(test_slots_are_pixels),
                                     cmocka_unit_test(test_slots_of_large_pictures)};
  const struct CMUnitTest tests[] = {
      OF_LAYOUT(test_no_ray_leaves_a_closed_surface, BINARY),          OF_LAYOUT(test_nearest_hit, BINARY),
      OF_LAYOUT(test_no_ray_leaves_a_closed_surface, QUANTISED),       OF_LAYOUT(test_nearest_hit, QUANTISED),
      OF_LAYOUT(test_no_ray_leaves_a_closed_surface, WIDE4),           OF_LAYOUT(test_nearest_hit, WIDE4),
      OF_LAYOUT(test_no_ray_leaves_a_closed_surface, WIDE4_QUANTISED), OF_LAYOUT(test_nearest_hit, WIDE4_QUANTISED),
      OF_LAYOUT(test_no_ray_leaves_a_closed_surface, WIDE8),           OF_LAYOUT(test_nearest_hit, WIDE8),
      cmocka_unit_test(test_shadow_rays_start_off_the_surface),
  };
  int failures = cmocka_run_group_tests_name("slots", slots, NULL, NULL);
  failures += cmocka_run_group_tests_name("hits in binary32", tests, NULL, NULL);
  exact = true;
  return failures + cmocka_run_group_tests_name("exact hits", tests, NULL, NULL);
}
