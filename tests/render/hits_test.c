/* Hits of rays: the device program natively against exact arithmetic and Embree, on scenes where many pixels have two
   right answers. A wrong answer is told from those, and holes are counted. */
#include "hits.h"
#include "meshes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void make_frame(struct trax_frame *frame, struct trax_scene *scene, const struct trax_view *view) {
  const struct trax_frame_options options = {
      .width = 97, .height = 61, .samples = 1, .shadows = true, .ambient = TRAX_DEFAULT_AMBIENT};
  trax_error error;
  memset(frame, 0, sizeof *frame);
  if (trax_frame_init(frame, scene, view, &options, &error) != TRAX_OK)
    fail_msg("%s", error.message);
}

enum finder { BY_TWIN, BY_EMBREE, WITHOUT_ERROR };

static void find(struct trax_hits *hits, const struct trax_frame *frame, enum finder finder) {
  struct trax_render_run run = {0};
  trax_error error;
  const trax_status status = finder == BY_TWIN     ? trax_hits_native(hits, frame, 2, &run, &error)
                             : finder == BY_EMBREE ? trax_hits_embree(hits, frame, &run, &error)
                                                   : trax_hits_exact(hits, frame, &run, &error);
  if (status != TRAX_OK)
    fail_msg("%s", error.message);
  assert_int_equal(run.rays, 97 * 61);
}

/* least: pixels that hit the same triangle, for certain. */
static void check_agreement(struct trax_mesh *mesh, struct trax_view view, uint64_t least) {
  struct trax_frame frame;
  struct trax_hits device, embree, exact;
  struct trax_hits_difference difference;
  struct trax_scene scene = scene_of(mesh, NULL);
  normalise(&scene, &view);
  make_frame(&frame, &scene, &view);
  find(&device, &frame, BY_TWIN);
  find(&embree, &frame, BY_EMBREE);
  find(&exact, &frame, WITHOUT_ERROR);
  trax_hits_judge(&difference, &device, &exact, &frame);
  assert_int_equal(difference.same + difference.tied + difference.holes + difference.wrong, 97 * 61);
  if (difference.holes + difference.wrong)
    fail_msg("%llu pixels beyond the error bound, the first at (%u, %u)",
             (unsigned long long)(difference.holes + difference.wrong), difference.x, difference.y);
  assert_true(difference.same >= least);
  assert_true(trax_hits_same(&device, &embree, &frame) >= least);
  trax_hits_release(&device);
  trax_hits_release(&exact);
  trax_hits_release(&embree);
  trax_frame_release(&frame);
  trax_scene_release(&scene);
}

static void test_agreement(void **state) {
  (void)state;
  const struct trax_view front = view_from(0.1f, 0.2f, 3, 0, 0, -1, 45, 2, 2, 2);
  struct trax_mesh mesh = {0};
  mesh_soup(&mesh, 500, 7);
  check_agreement(&mesh, front, 97 * 61 - 20);
  mesh_sphere(&mesh, 1, 6, 0);
  check_agreement(&mesh, front, 97 * 61 - 60);
  /* Far from the origin, where coordinates are coarse. */
  mesh_sphere(&mesh, 1, 5, 0);
  mesh_transform(&mesh, 1, 3e4f, -2e4f, 1e4f);
  check_agreement(&mesh, view_from(3e4f, -2e4f, 1e4f + 3, 0, 0, -1, 45, 3e4f, 0, 2e4f), 97 * 61 - 60);
  /* Rays along edges and through vertices: a pixel's middle looks along the axis. */
  mesh_box(&mesh, (float[]){-1, -1, -1}, (float[]){0, 0, 0}, 0);
  mesh_box(&mesh, (float[]){0, 0, -1}, (float[]){1, 1, 0}, 0);
  check_agreement(&mesh, view_from(0, 0, 3, 0, 0, -1, 45, 2, 2, 2), 97 * 61 - 200);
}

/* Everything twice, at one place: whichever is found is right. */
static void test_ties(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  mesh_soup(&mesh, 100, 3);
  const uint32_t count = mesh.triangle_count;
  for (uint32_t i = 0; i < count; i++) {
    const uint32_t *v = mesh.triangles[i].vertices;
    mesh_triangle(&mesh, v[1], v[2], v[0], 0);
  }
  check_agreement(&mesh, view_from(0.1f, 0.2f, 3, 0, 0, -1, 45, 2, 2, 2), 5400);
}

/* Another answer than those: what is behind, beside, or nothing. */
static void test_wrong_hits(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  struct trax_view view = view_from(0.013f, 0.027f, 5, 0, 0, -1, 20, 2, 2, 2);
  struct trax_frame frame;
  struct trax_hits right, wrong;
  struct trax_hits_difference difference;
  mesh_sphere(&mesh, 1, 3, 0);
  const uint32_t shell = mesh.triangle_count;
  mesh_box(&mesh, (float[]){-2, -2, -3}, (float[]){2, 2, -2.5f}, 0);
  struct trax_scene scene = scene_of(&mesh, NULL);
  normalise(&scene, &view);
  make_frame(&frame, &scene, &view);
  find(&right, &frame, BY_TWIN);
  const size_t middle = 30 * 97 + 48;
  assert_true(scene.source_ids[right.triangles[middle]] < shell);
  uint32_t behind = 0;
  while (scene.source_ids[behind] < shell)
    behind++;
  const uint32_t answers[] = {TRAX_NO_TRIANGLE, behind, right.triangles[middle - 20]};
  for (size_t i = 0; i < sizeof answers / sizeof *answers; i++) {
    find(&wrong, &frame, BY_TWIN);
    trax_hits_judge(&difference, &wrong, &right, &frame);
    assert_true(difference.same == 97 * 61);
    assert_true(answers[i] != right.triangles[middle]);
    wrong.triangles[middle] = answers[i];
    trax_hits_judge(&difference, &wrong, &right, &frame);
    assert_int_equal(difference.holes, i == 0);
    assert_int_equal(difference.wrong, i != 0);
    assert_int_equal(difference.tied, 0);
    assert_true(difference.x == 48 && difference.y == 30);
    trax_hits_release(&wrong);
  }
  trax_hits_release(&right);
  trax_frame_release(&frame);
  trax_scene_release(&scene);
}

/* Exact hits miss nothing, and hits of binary32 are seen to have holes or to be wrong. */
static void check_range(struct trax_mesh *mesh, struct trax_view view, uint64_t least_holes, uint64_t least_wrong) {
  struct trax_frame frame;
  struct trax_hits device, exact;
  struct trax_hits_difference difference;
  struct trax_scene scene = scene_of(mesh, NULL);
  normalise(&scene, &view);
  make_frame(&frame, &scene, &view);
  assert_true(frame.params->features & TRAX_FEATURE_BIT(EXACT));
  find(&device, &frame, BY_TWIN);
  find(&exact, &frame, WITHOUT_ERROR);
  trax_hits_judge(&difference, &device, &exact, &frame);
  assert_int_equal(difference.holes + difference.wrong, 0);
  assert_true(difference.same >= 97 * 61 - 100);
  trax_hits_release(&device);
  frame.params->features &= ~TRAX_FEATURE_BIT(EXACT);
  find(&device, &frame, BY_TWIN);
  trax_hits_judge(&difference, &device, &exact, &frame);
  if (difference.holes < least_holes || difference.wrong < least_wrong)
    fail_msg("binary32 has %llu holes and %llu wrong hits only", (unsigned long long)difference.holes,
             (unsigned long long)difference.wrong);
  trax_hits_release(&device);
  trax_hits_release(&exact);
  trax_frame_release(&frame);
  trax_scene_release(&scene);
}

static void test_range(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  const struct trax_view view = view_from(0, 0, 0, 0, -0.2f, -1, 80, 0, 0.5f, 0);
  const float lengths[] = {3e7f, 1e8f, 1e9f, 1.7e18f};
  const uint64_t holes[] = {1, 50, 50, 50};
  for (int i = 0; i < 4; i++) {
    const float length = lengths[i];
    mesh_box(&mesh, (float[]){-length, -2, -length}, (float[]){length, length, length}, 0);
    check_range(&mesh, view, holes[i], 0);
  }
  /* The near boxes, too. */
  mesh_box(&mesh, (float[]){-1, -1, -4}, (float[]){0.2f, 0.1f, -3}, 0);
  mesh_box(&mesh, (float[]){-1e9f, -2, -1e9f}, (float[]){1e9f, 1e9f, 1e9f}, 0);
  check_range(&mesh, view, 50, 0);
  mesh_box(&mesh, (float[]){-1e-9f, -1e-9f, -4e-9f}, (float[]){0.2e-9f, 0.1e-9f, -3e-9f}, 0);
  mesh_box(&mesh, (float[]){-1e18f, -1e18f, -1e18f}, (float[]){1e18f, 1e18f, 1e18f}, 0);
  check_range(&mesh, view, 0, 10);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_agreement),
      cmocka_unit_test(test_ties),
      cmocka_unit_test(test_wrong_hits),
      cmocka_unit_test(test_range),
  };
  return cmocka_run_group_tests_name("hits", tests, NULL, NULL);
}
