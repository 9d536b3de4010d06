/* The exact picture: single triangles by hand, pictures against all triangles and Embree's; layers and their errors. */
#include "meshes.h"

#include "exact.h"
#include "layers.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static bool shoot(struct double3 origin, struct double3 direction, struct exact_hit *hit) {
  static const struct trax_triangle triangle = {{1, 0, -4}, {5, 0, -4}, {1, 8, -4}, 0};
  return exact_triangle(&triangle, origin, direction, hit);
}

static void test_a_triangle(void **state) {
  (void)state;
  struct exact_hit hit;
  const struct double3 ahead = {0, 0, -2};
  assert_true(shoot((struct double3){2, 2, 0}, ahead, &hit));
  assert_true(hit.distance == 2 && hit.u == 0.25 && hit.v == 0.25);
  assert_true(shoot((struct double3){2, 2, -8}, (struct double3){0, 0, 2}, &hit)); /* from behind */
  assert_true(hit.distance == 2 && hit.u == 0.25 && hit.v == 0.25);
  assert_true(shoot((struct double3){0, 1, 0}, (struct double3){1, 0, -2}, &hit)); /* slanting */
  assert_true(hit.distance == 2 && hit.u == 0.25 && hit.v == 0.125);
  assert_true(shoot((struct double3){1, 0, 0}, ahead, &hit)); /* a vertex */
  assert_true(hit.u == 0 && hit.v == 0);
  assert_true(shoot((struct double3){3, 4, 0}, ahead, &hit)); /* the middle of an edge */
  assert_true(hit.u == 0.5 && hit.v == 0.5);
  assert_true(shoot((struct double3){1, 4, 0}, ahead, &hit));
  assert_false(shoot((struct double3){1 - 0x1p-50, 4, 0}, ahead, &hit));
  assert_false(shoot((struct double3){3 + 0x1p-50, 4, 0}, ahead, &hit));
  assert_false(shoot((struct double3){2, -0x1p-50, 0}, ahead, &hit));
  assert_false(shoot((struct double3){2, 2, 0}, (struct double3){0, 0, 2}, &hit));  /* behind the origin */
  assert_false(shoot((struct double3){2, 2, -4}, ahead, &hit));                     /* at the origin */
  assert_false(shoot((struct double3){0, 2, -4}, (struct double3){1, 0, 0}, &hit)); /* in its plane */
}

/* The edges' values cancel to their last bits: a small triangle far away, met where its weights are 1/4 and 1/2. */
static void test_a_small_triangle(void **state) {
  (void)state;
  const float x = 4091.3701f, y = 1234.567f, z = -3210.987f, small = 0x1p-8f;
  const struct trax_triangle triangle = {{x, y, z}, {x + small, y, z}, {x, y + small, z - small}, 0};
  for (int k = 1; k < 40; k++) {
    const struct double3 target = {x + 0.25 * small, y + 0.5 * small, z - 0.5 * small},
                         origin = {k * 0x1.2345p-3, k * -0x1.789p-5, k * 0x1.05fp-1}; /* no direction is rounded */
    struct exact_hit hit;
    assert_true(exact_triangle(&triangle, origin, minus(target, origin), &hit));
    assert_true(fabs(hit.distance - 1) < 0x1p-32 && fabs(hit.u - 0.25) < 0x1p-32 && fabs(hit.v - 0.5) < 0x1p-32);
  }
}

static struct trax_frame frame_of(const struct trax_scene *scene, const struct trax_view *view, uint32_t width,
                                  uint32_t height, uint32_t samples) {
  const struct trax_frame_options options = {
      .width = width, .height = height, .samples = samples, .shadows = true, .ambient = 0.1f, .background = 0xFF102030};
  struct trax_frame frame;
  trax_error error;
  assert_int_equal(trax_frame_init(&frame, scene, view, &options, &error), TRAX_OK);
  return frame;
}

static struct trax_picture exact_of(const struct trax_frame *frame) {
  struct trax_picture exact;
  struct trax_render_run run = {.exactly = true, .layers = true};
  trax_error error;
  assert_int_equal(trax_render_embree(&exact, frame, &run, &error), TRAX_OK);
  return exact;
}

static void release(struct trax_picture *picture, struct trax_frame *frame, struct trax_scene *scene) {
  trax_picture_release(picture);
  trax_frame_release(frame);
  trax_scene_release(scene);
}

/* The nearest of all triangles, one by one. */
static void test_against_all_triangles(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  mesh_soup(&mesh, 500, 7);
  struct trax_scene scene = scene_of(&mesh, NULL);
  struct trax_view view = view_from(0.3f, 0.5f, 2.6f, -0.1f, -0.2f, -1, 45, 1.5f, 2, 2);
  struct trax_frame frame = frame_of(&scene, &view, 48, 27, 1);
  struct trax_picture exact = exact_of(&frame), finished = exact_of(&frame);
  trax_layers_finish(&finished, &frame, 3);
  uint32_t hits = 0;
  size_t i = 0;
  for (uint32_t y = 0; y < 27; y++)
    for (uint32_t x = 0; x < 48; x++, i++) {
      float direction[3];
      for (int axis = 0; axis < 3; axis++)
        direction[axis] = frame.params->corner[axis] + ((float)x + 0.5f) * frame.params->step_x[axis] +
                          ((float)y + 0.5f) * frame.params->step_y[axis];
      struct exact_hit nearest = {.triangle = TRAX_NO_TRIANGLE, .distance = INFINITY}, hit;
      for (uint32_t triangle = 0; triangle < scene.triangle_count; triangle++)
        if (exact_triangle(&scene.triangles[triangle], from(frame.params->eye), from(direction), &hit) &&
            hit.distance < nearest.distance)
          nearest = hit, nearest.triangle = triangle;
      const struct trax_layers *layers = &finished.layers[i];
      assert_int_equal(exact.layers[i].triangle, nearest.triangle);
      if (nearest.triangle == TRAX_NO_TRIANGLE) {
        assert_true(layers->triangle == 0 && layers->depth == 0 && layers->normal[0] == 0);
        continue;
      }
      hits++;
      const struct trax_triangle *triangle = &scene.triangles[nearest.triangle];
      const struct double3 way = from(direction), normal = from(layers->normal),
                           e = minus(from(triangle->v1), from(triangle->v0)),
                           f = minus(from(triangle->v2), from(triangle->v0));
      const double distance = nearest.distance * sqrt(dot(way, way)) / 8;
      assert_int_equal(layers->triangle, scene.source_ids[nearest.triangle] + 1);
      assert_true(fabs(layers->depth - distance) < 1e-6 * distance);
      assert_true(fabs(dot(normal, normal) - 1) < 1e-6 && dot(normal, way) < 0);
      assert_true(fabs(dot(normal, e)) < 1e-6 * sqrt(dot(e, e)) && fabs(dot(normal, f)) < 1e-6 * sqrt(dot(f, f)));
    }
  assert_in_range(hits, 150, 48 * 27 - 150);
  trax_picture_release(&finished);
  release(&exact, &frame, &scene);
}

static bool has_first_bits(const struct trax_triangle *triangle, const struct trax_triangle *other) {
  uint32_t words[9], other_words[9];
  memcpy(words, triangle, sizeof words);
  memcpy(other_words, other, sizeof other_words);
  for (int i = 0; i < 9; i++)
    if (words[i] != other_words[i])
      return words[i] < other_words[i];
  return false;
}

/* All triangles lie in one plane, over one another: the one of the first bits is seen, whatever the rounding. */
static void test_one_plane(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  uint32_t seed = 11, covered = 0;
  for (int i = 0; i < 20; i++) {
    uint32_t corner[3];
    for (int k = 0; k < 3; k++)
      corner[k] = mesh_vertex(&mesh, 2 * random_unit(&seed) - 1, 2 * random_unit(&seed) - 1, -0.7f);
    mesh_triangle(&mesh, corner[0], corner[1], corner[2], 0);
  }
  mesh_material(&mesh, 1, 1, 1);
  struct trax_scene scene = scene_of(&mesh, NULL);
  struct trax_view view = view_from(0.3f, 0.5f, 2.6f, -0.1f, -0.2f, -1, 45, 1.5f, 2, 2);
  struct trax_frame frame = frame_of(&scene, &view, 48, 27, 1);
  struct trax_picture exact = exact_of(&frame);
  for (uint32_t y = 0, i = 0; y < 27; y++)
    for (uint32_t x = 0; x < 48; x++, i++) {
      float direction[3];
      for (int axis = 0; axis < 3; axis++)
        direction[axis] = frame.params->corner[axis] + ((float)x + 0.5f) * frame.params->step_x[axis] +
                          ((float)y + 0.5f) * frame.params->step_y[axis];
      uint32_t first = TRAX_NO_TRIANGLE, hits = 0;
      struct exact_hit hit;
      for (uint32_t triangle = 0; triangle < scene.triangle_count; triangle++)
        if (exact_triangle(&scene.triangles[triangle], from(frame.params->eye), from(direction), &hit)) {
          hits++;
          if (first == TRAX_NO_TRIANGLE || has_first_bits(&scene.triangles[triangle], &scene.triangles[first]))
            first = triangle;
        }
      assert_int_equal(exact.layers[i].triangle, first);
      covered += hits > 1;
    }
  assert_in_range(covered, 100, 48 * 27);
  release(&exact, &frame, &scene);
}

/* No ray leaves a closed surface; within a convex one no light is blocked. */
static void test_no_gaps(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  mesh_sphere(&mesh, 3, 5, 0);
  struct trax_scene scene = scene_of(&mesh, NULL);
  struct trax_view view = view_from(0, 0, 0, 1, 0, 0, 90, 0, 0.5f, 0);
  struct trax_frame frame = frame_of(&scene, &view, 256, 256, 1);
  struct trax_picture exact = exact_of(&frame);
  for (size_t i = 0; i < 256 * 256; i++) {
    assert_int_not_equal(exact.layers[i].triangle, TRAX_NO_TRIANGLE);
    assert_int_equal(exact.layers[i].shadow, TRAX_SHADOW_LIT);
  }
  release(&exact, &frame, &scene);
}

/* Embree's hits in binary32 lead to the same picture but for a few rays. */
static void test_against_embree(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  mesh_soup(&mesh, 3000, 3);
  struct trax_scene scene = scene_of(&mesh, NULL);
  struct trax_view view = view_from(0.3f, 0.5f, 2.6f, -0.1f, -0.2f, -1, 45, 1.5f, 2, 2);
  struct trax_frame frame = frame_of(&scene, &view, 160, 90, 3);
  struct trax_picture exact = exact_of(&frame);
  struct trax_picture picture;
  struct trax_render_run run = {0};
  trax_error error;
  assert_int_equal(trax_render_embree(&picture, &frame, &run, &error), TRAX_OK);
  unsigned different = 0;
  for (size_t i = 0; i < 160 * 90; i++)
    for (int channel = 0; channel < 3; channel++)
      different += fabs(255 * sqrt((double)exact.radiance[3 * i + (size_t)channel]) -
                        (picture.pixels[i] >> 8 * channel & 255)) > 0.501;
  assert_in_range(different, 0, 20);
  trax_picture_release(&picture);
  release(&exact, &frame, &scene);
}

/* Two triangles that face the eye, the second 1 % farther away and twice as large, and a third in the second's plane.
 */
static void test_kinds_of_wrong_hits(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  static const float corners[3][2] = {{-1, -1}, {1, -1}, {0, 1}};
  static const struct {
    float z, size;
  } layers[3] = {{-1, 0.2f}, {-1.01f, 0.4f}, {-1.01f, 0.8f}};
  const uint32_t material = mesh_material(&mesh, 0.5f, 0.5f, 0.5f);
  for (int layer = 0; layer < 3; layer++) {
    uint32_t vertices[3];
    for (int corner = 0; corner < 3; corner++)
      vertices[corner] = mesh_vertex(&mesh, layers[layer].size * corners[corner][0],
                                     layers[layer].size * corners[corner][1], layers[layer].z);
    mesh_triangle(&mesh, vertices[0], vertices[1], vertices[2], material);
  }
  struct trax_scene scene = scene_of(&mesh, NULL);
  struct trax_view view = view_from(0, 0, 0, 0, 0, -1, 90, 0, 0, 0.5f);
  struct trax_frame frame = frame_of(&scene, &view, 32, 32, 1);
  struct trax_picture exact = exact_of(&frame), picture = exact_of(&frame);
  trax_layers_finish(&exact, &frame, 0);
  trax_layers_finish(&picture, &frame, 0);
  struct trax_layers_difference errors;
  trax_layers_compare(&errors, &picture, &exact);
  assert_int_equal(errors.missed + errors.grown + errors.other + errors.tied + errors.shadow + errors.wrong, 0);

  struct trax_layers *middle = &picture.layers[16 * 32 + 16], *beside = middle + 3, *corner = picture.layers;
  const struct trax_layers right = *middle;
  assert_true(right.triangle == 1 && beside->triangle > 1 && corner->triangle == 0);
  assert_true(right.depth < beside->depth * 0.995f);
  *corner = *beside;
  trax_layers_compare(&errors, &picture, &exact);
  assert_true(errors.grown == 1 && errors.wrong == 1 && errors.missed + errors.other + errors.tied == 0);
  *corner = exact.layers[0];
  *middle = exact.layers[0];
  trax_layers_compare(&errors, &picture, &exact);
  assert_true(errors.missed == 1 && errors.wrong == 1 && errors.grown + errors.other + errors.tied == 0);
  *middle = *beside;
  trax_layers_compare(&errors, &picture, &exact);
  assert_true(errors.other == 1 && errors.wrong == 1 && errors.missed + errors.grown + errors.tied == 0);
  *middle = right;
  beside->triangle = 5 - beside->triangle; /* the other one of this plane */
  beside->depth *= 1 + 0x1p-20f;
  middle->shadow ^= TRAX_SHADOW_LIT ^ TRAX_SHADOW_BLOCKED;
  trax_layers_compare(&errors, &picture, &exact);
  assert_true(errors.tied == 1 && errors.shadow == 1 && errors.wrong == 0);
  beside->depth *= 1 + 0x1p-18f;
  trax_layers_compare(&errors, &picture, &exact);
  assert_true(errors.tied == 0 && errors.other == 1);
  trax_picture_release(&picture);
  release(&exact, &frame, &scene);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_a_triangle),
                                     cmocka_unit_test(test_a_small_triangle),
                                     cmocka_unit_test(test_against_all_triangles),
                                     cmocka_unit_test(test_one_plane),
                                     cmocka_unit_test(test_no_gaps),
                                     cmocka_unit_test(test_against_embree),
                                     cmocka_unit_test(test_kinds_of_wrong_hits)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
