/* The reference in binary64: single triangles by hand, pictures against Embree's, and what the program records. */
#include "meshes.h"

#include "exact.h"
#include "metrics.h"

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

static struct trax_exact exact_of(const struct trax_frame *frame) {
  struct trax_exact exact;
  struct trax_render_run run = {0};
  trax_error error;
  assert_int_equal(trax_render_exact(&exact, frame, true, &run, &error), TRAX_OK);
  return exact;
}

/* The nearest of all triangles, one by one. */
static void test_against_all_triangles(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  struct trax_scene scene = {0};
  mesh_soup(&mesh, 500, 7);
  build(&scene, &mesh, NULL);
  struct trax_view view = view_from(0.3f, 0.5f, 2.6f, -0.1f, -0.2f, -1, 45, 1.5f, 2, 2);
  struct trax_frame frame = frame_of(&scene, &view, 48, 27, 2);
  struct trax_exact exact = exact_of(&frame);
  uint32_t hits = 0;
  size_t i = 0;
  for (uint32_t y = 0; y < 27; y++)
    for (uint32_t x = 0; x < 48; x++)
      for (uint32_t sample = 0; sample < 2; sample++, i++) {
        const float column = (float)x + (sample ? 0x0.413FA9p0f : 0.5f),
                    row = (float)y + (sample ? 0x0.11E10Dp0f : 0.5f);
        float direction[3];
        for (int axis = 0; axis < 3; axis++)
          direction[axis] =
              frame.params->corner[axis] + column * frame.params->step_x[axis] + row * frame.params->step_y[axis];
        struct exact_hit nearest = {.triangle = TRAX_NO_TRIANGLE, .distance = INFINITY}, hit;
        for (uint32_t triangle = 0; triangle < scene.triangle_count; triangle++)
          if (exact_triangle(&scene.triangles[triangle], from(frame.params->eye), from(direction), &hit) &&
              hit.distance < nearest.distance)
            nearest = hit, nearest.triangle = triangle;
        assert_int_equal(exact.seen[i].triangle, nearest.triangle);
        hits += nearest.triangle != TRAX_NO_TRIANGLE;
        if (nearest.triangle != TRAX_NO_TRIANGLE)
          assert_true(exact.seen[i].distance == nearest.distance);
      }
  assert_in_range(hits, 300, 2 * 48 * 27 - 300);
  trax_exact_release(&exact);
  trax_frame_release(&frame);
  trax_scene_release(&scene);
  trax_mesh_release(&mesh);
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
  struct trax_scene scene = {0};
  uint32_t seed = 11, covered = 0;
  for (int i = 0; i < 20; i++) {
    uint32_t corner[3];
    for (int k = 0; k < 3; k++)
      corner[k] = mesh_vertex(&mesh, 2 * random_unit(&seed) - 1, 2 * random_unit(&seed) - 1, -0.7f);
    mesh_triangle(&mesh, corner[0], corner[1], corner[2], 0);
  }
  mesh_material(&mesh, 1, 1, 1);
  build(&scene, &mesh, NULL);
  struct trax_view view = view_from(0.3f, 0.5f, 2.6f, -0.1f, -0.2f, -1, 45, 1.5f, 2, 2);
  struct trax_frame frame = frame_of(&scene, &view, 48, 27, 1);
  struct trax_exact exact = exact_of(&frame);
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
      assert_int_equal(exact.seen[i].triangle, first);
      covered += hits > 1;
    }
  assert_in_range(covered, 100, 48 * 27);
  trax_exact_release(&exact);
  trax_frame_release(&frame);
  trax_scene_release(&scene);
  trax_mesh_release(&mesh);
}

/* From the inside of a closed surface no ray gets out; in a convex one no light is blocked. */
static void test_no_gaps(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  struct trax_scene scene = {0};
  mesh_sphere(&mesh, 3, 5, 0);
  build(&scene, &mesh, NULL);
  struct trax_view view = view_from(0, 0, 0, 1, 0, 0, 90, 0, 0.5f, 0);
  struct trax_frame frame = frame_of(&scene, &view, 256, 256, 1);
  struct trax_exact exact = exact_of(&frame);
  for (size_t i = 0; i < 256 * 256; i++) {
    assert_int_not_equal(exact.seen[i].triangle, TRAX_NO_TRIANGLE);
    assert_int_equal(exact.seen[i].shadow, TRAX_SHADOW_LIT);
  }
  trax_exact_release(&exact);
  trax_frame_release(&frame);
  trax_scene_release(&scene);
  trax_mesh_release(&mesh);
}

/* Embree's hits in binary32 lead to the same picture but for a few rays. */
static void test_against_embree(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  struct trax_scene scene = {0};
  mesh_soup(&mesh, 3000, 3);
  build(&scene, &mesh, NULL);
  struct trax_view view = view_from(0.3f, 0.5f, 2.6f, -0.1f, -0.2f, -1, 45, 1.5f, 2, 2);
  struct trax_frame frame = frame_of(&scene, &view, 160, 90, 3);
  struct trax_exact exact = exact_of(&frame);
  struct trax_picture picture;
  struct trax_render_run run = {0};
  trax_error error;
  assert_int_equal(trax_render_embree(&picture, &frame, &run, &error), TRAX_OK);
  unsigned different = 0;
  for (size_t i = 0; i < 160 * 90; i++)
    for (int channel = 0; channel < 3; channel++)
      different += fabs(exact.channels[3 * i + (size_t)channel] - (picture.pixels[i] >> 8 * channel & 255)) > 0.501;
  assert_in_range(different, 0, 20);
  trax_picture_release(&picture);
  trax_exact_release(&exact);
  trax_frame_release(&frame);
  trax_scene_release(&scene);
  trax_mesh_release(&mesh);
}

/* Two triangles that face the eye, the second 1 % farther away and twice as large, and a third in the second's plane.
 */
static void test_kinds_of_wrong_hits(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  struct trax_scene scene = {0};
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
  build(&scene, &mesh, NULL);
  struct trax_view view = view_from(0, 0, 0, 0, 0, -1, 90, 0, 0, 0.5f);
  struct trax_frame frame = frame_of(&scene, &view, 32, 32, 1);
  struct trax_exact exact = exact_of(&frame);
  const uint32_t triangles = scene.header->sections[TRAX_SCENE_TRIANGLES].offset, bytes = sizeof(struct trax_triangle);
  struct trax_sample_record *recorded = calloc(32 * 32, sizeof *recorded);
  assert_non_null(recorded);
  uint32_t place[3] = {0}; /* of the layers, in the file */
  for (uint32_t i = 0; i < 3; i++)
    place[scene.triangles[i].v0[2] == -1                                         ? 0
          : scene.triangles[i].v1[0] == 0.4f || scene.triangles[i].v0[0] == 0.4f ? 1
                                                                                 : 2] = triangles + i * bytes;
  for (size_t i = 0; i < 32 * 32; i++)
    if (exact.seen[i].triangle != TRAX_NO_TRIANGLE)
      recorded[i] = (struct trax_sample_record){triangles + exact.seen[i].triangle * bytes, exact.seen[i].shadow};
  struct trax_hit_errors errors;
  trax_hit_errors(&errors, &exact, recorded, &frame);
  assert_int_equal(errors.samples, 1024);
  assert_int_equal(errors.missed + errors.grown + errors.other + errors.tied + errors.shadow + errors.wrong_pixels, 0);

  const size_t middle = 16 * 32 + 16, beside = 16 * 32 + 16 + 3, corner = 0; /* the nearest, the second, nothing */
  assert_int_equal(triangles + exact.seen[middle].triangle * bytes, place[0]);
  assert_int_equal(exact.seen[corner].triangle, TRAX_NO_TRIANGLE);
  recorded[corner].triangle = place[2];
  trax_hit_errors(&errors, &exact, recorded, &frame);
  assert_true(errors.grown == 1 && errors.wrong_pixels == 1 && errors.missed + errors.other + errors.tied == 0);
  recorded[corner].triangle = 0;
  recorded[middle].triangle = 0;
  trax_hit_errors(&errors, &exact, recorded, &frame);
  assert_true(errors.missed == 1 && errors.wrong_pixels == 1 && errors.grown + errors.other + errors.tied == 0);
  recorded[middle].triangle = place[1];
  trax_hit_errors(&errors, &exact, recorded, &frame);
  assert_true(errors.other == 1 && errors.wrong_pixels == 1 && errors.missed + errors.grown + errors.tied == 0);
  recorded[middle].triangle = place[0];
  const uint32_t right = triangles + exact.seen[beside].triangle * bytes;
  assert_true(right == place[1] || right == place[2]); /* whichever comes first in the file */
  recorded[beside].triangle = right == place[1] ? place[2] : place[1];
  recorded[middle].shadow ^= TRAX_SHADOW_LIT ^ TRAX_SHADOW_BLOCKED;
  trax_hit_errors(&errors, &exact, recorded, &frame);
  assert_true(errors.tied == 1 && errors.shadow == 1 && errors.wrong_pixels == 0);
  recorded[middle].triangle = triangles + 3 * bytes; /* no triangle of the scene */
  trax_hit_errors(&errors, &exact, recorded, &frame);
  assert_int_equal(errors.missed, 1);
  free(recorded);
  trax_exact_release(&exact);
  trax_frame_release(&frame);
  trax_scene_release(&scene);
  trax_mesh_release(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_a_triangle), cmocka_unit_test(test_a_small_triangle),
                                     cmocka_unit_test(test_against_all_triangles), cmocka_unit_test(test_one_plane),
                                     cmocka_unit_test(test_no_gaps), cmocka_unit_test(test_against_embree),
                                     cmocka_unit_test(test_kinds_of_wrong_hits)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
