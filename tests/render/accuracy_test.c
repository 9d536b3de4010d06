/* Error against run time: what is measured of a right method and of broken ones, fronts, and rows kept in files.
   Usage: render-accuracy-test ROOT CACHE; ROOT has bin/clang and lib/trax, CACHE keeps compiled programs. */
#include "meshes.h"

#include "accuracy.h"
#include "temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static const char *root, *cache;

enum { WIDTH = 64, HEIGHT = 36 };

static struct {
  struct trax_mesh mesh;
  struct trax_scene scene;
  struct trax_view view;
  struct trax_exact exact, converged;
  struct trax_config *config;
} common;

static struct trax_frame frame_of(struct trax_method method, uint32_t samples) {
  const struct trax_frame_options options = {.width = WIDTH,
                                             .height = HEIGHT,
                                             .samples = samples,
                                             .shadows = true,
                                             .ambient = 0.1f,
                                             .background = 0xFF102030,
                                             .method = method};
  struct trax_frame frame;
  trax_error error;
  if (trax_frame_init(&frame, &common.scene, &common.view, &options, &error) != TRAX_OK)
    fail_msg("%s", error.message);
  return frame;
}

static void render_exact(struct trax_exact *exact, uint32_t samples) {
  struct trax_frame frame = frame_of((struct trax_method){0}, samples);
  struct trax_render_run run = {0};
  trax_error error;
  assert_int_equal(trax_render_exact(exact, &frame, true, &run, &error), TRAX_OK);
  trax_frame_release(&frame);
}

static int set_up(void **state) {
  (void)state;
  trax_error error;
  mesh_soup(&common.mesh, 2000, 5);
  build(&common.scene, &common.mesh, &(struct trax_build_options){.passes = TRAX_DEFAULT_PASSES});
  common.view = view_from(0.3f, 0.5f, 2.6f, -0.1f, -0.2f, -1, 45, 1.5f, 2, 2);
  render_exact(&common.exact, 1);
  render_exact(&common.converged, 64);
  common.config = trax_config_create();
  return !common.config || trax_config_preset(common.config, "1x32", &error) != TRAX_OK;
}

static int tear_down(void **state) {
  (void)state;
  trax_config_destroy(common.config);
  trax_exact_release(&common.exact);
  trax_exact_release(&common.converged);
  trax_scene_release(&common.scene);
  trax_mesh_release(&common.mesh);
  return 0;
}

static struct trax_accuracy_run run_of(void) {
  return (struct trax_accuracy_run){.specialise = {.root = root, .cache = cache},
                                    .config = common.config,
                                    .original = &common.scene,
                                    .exact = &common.exact,
                                    .converged = &common.converged,
                                    .host_threads = 1};
}

/* The boxes that the traversal sees are widened by so much less than they should be. */
static struct trax_accuracy_row measure(struct trax_variant variant, float narrower) {
  struct trax_frame frame = frame_of(variant.method, 1);
  frame.params->box_margin -= narrower;
  struct trax_accuracy_row row;
  const struct trax_accuracy_run run = run_of();
  trax_error error;
  variant.samples = 1;
  if (trax_accuracy_measure(&row, &variant, &frame, &run, &error) != TRAX_OK)
    fail_msg("%s", error.message);
  trax_frame_release(&frame);
  return row;
}

#define FIGURE(row, NAME) ((row).figures[TRAX_ACCURACY_##NAME])

/* Binary32 as it should be: the rounding of channels is far below a byte's, no hit is wrong, and what is left is for
   want of samples. */
static void test_the_default(void **state) {
  (void)state;
  const struct trax_accuracy_row row = measure((struct trax_variant){.group = "default"}, 0);
  assert_true(FIGURE(row, RMSE) > 0 && FIGURE(row, RMSE) < 1e-3);
  assert_true(FIGURE(row, WRONG) == 0 && FIGURE(row, SHADOW) == 0 && FIGURE(row, CHANGED) == 0);
  assert_true(FIGURE(row, SAMPLING_RMSE) > 1);
  assert_true(fabs(FIGURE(row, TOTAL_RMSE) - FIGURE(row, SAMPLING_RMSE)) < 1e-3);
  assert_true(FIGURE(row, FLIP) < 1e-3 && FIGURE(row, TOTAL_FLIP) > 0.01);
  assert_true(FIGURE(row, CYCLES) > 0 && FIGURE(row, MEMORY) > 0 && FIGURE(row, ENERGY) > 0 && FIGURE(row, MRPS) > 0);
  assert_in_range(FIGURE(row, CODE), 1000, 4096);
}

/* Boxes that are too small hide triangles: rays that should hit miss, or hit what is behind. */
static void test_shrunk_boxes(void **state) {
  (void)state;
  const struct trax_accuracy_row row = measure((struct trax_variant){.group = "default"}, 0.1f);
  assert_true(FIGURE(row, MISSED) >= 20 && FIGURE(row, OTHER) >= 20);
  assert_true(FIGURE(row, GROWN) == 0);
  assert_true(FIGURE(row, WRONG) == FIGURE(row, MISSED) + FIGURE(row, OTHER));
  assert_true(FIGURE(row, RMSE) > 5 && FIGURE(row, LARGEST) > 50 && FIGURE(row, FLIP) > 0.01);
}

static void test_fewer_bits(void **state) {
  (void)state;
  double before = 0;
  for (unsigned bits = 24; bits >= 6; bits -= 6) {
    const struct trax_accuracy_row row =
        measure((struct trax_variant){.group = "unit", .bits = bits, .latency = TRAX_LATENCY_DIGITS}, 0);
    assert_true(FIGURE(row, RMSE) > 4 * before);
    before = FIGURE(row, RMSE);
  }
}

static void test_other_methods(void **state) {
  (void)state;
  struct trax_variant *variants;
  size_t count, measured = 0;
  trax_error error;
  assert_int_equal(trax_variants(&variants, &count, &common.scene, &error), TRAX_OK);
  assert_string_equal(variants[0].group, "default");
  for (size_t i = 1; i < count; i++) {
    for (size_t j = 0; j < i; j++)
      assert_string_not_equal(variants[i].name, variants[j].name);
    if (strcmp(variants[i].group, "triangle") != 0 && strcmp(variants[i].group, "math") != 0)
      continue;
    const struct trax_accuracy_row row = measure(variants[i], 0);
    assert_true(FIGURE(row, RMSE) < 2 && FIGURE(row, WRONG) <= 2);
    measured++;
  }
  assert_int_equal(measured, 3);
  free(variants);
}

static struct trax_accuracy_row measure_scene(const struct trax_scene *scene, const struct trax_variant *variant) {
  const struct trax_frame_options options = {
      .width = WIDTH, .height = HEIGHT, .samples = 1, .shadows = true, .ambient = 0.1f, .background = 0xFF102030};
  struct trax_frame frame;
  trax_error error;
  assert_int_equal(trax_frame_init(&frame, scene, &common.view, &options, &error), TRAX_OK);
  const struct trax_accuracy_run run = run_of();
  struct trax_accuracy_row row;
  if (trax_accuracy_measure(&row, variant, &frame, &run, &error) != TRAX_OK)
    fail_msg("%s", error.message);
  trax_frame_release(&frame);
  return row;
}

static struct trax_scene rebuild(struct trax_rebuild_options how) {
  struct trax_scene rebuilt;
  trax_error error;
  assert_int_equal(trax_scene_rebuild(&rebuilt, &common.scene, &how, NULL, &error), TRAX_OK);
  return rebuilt;
}

/* Half a cell of the longest axis is how far a vertex is moved, at most; of thousands one is moved nearly so far. */
static void check_grid(const struct trax_scene *scene, unsigned bits) {
  double farthest = 0, size = 0;
  for (int axis = 0; axis < 3; axis++)
    size = fmax(size, (double)common.scene.header->bounds_max[axis] - common.scene.header->bounds_min[axis]);
  for (uint32_t triangle = 0; triangle < scene->triangle_count; triangle++)
    for (int axis = 0; axis < 3; axis++)
      farthest = fmax(farthest, fabs((double)scene->triangles[triangle].v0[axis] -
                                     common.scene.triangles[scene->source_ids[triangle]].v0[axis]));
  const double half = size / (ldexp(1, (int)bits) - 1) / 2;
  assert_true(farthest >= 0.9 * half && farthest <= 1.01 * half); /* rounded to binary32 */
}

static void test_coarse_vertices(void **state) {
  (void)state;
  double before = 1e-3;
  for (unsigned bits = 16; bits >= 8; bits -= 8) {
    struct trax_scene scene = rebuild((struct trax_rebuild_options){.vertex_bits = bits});
    check_grid(&scene, bits);
    const struct trax_variant variant = {.samples = 1, .rebuilt = true, .tree = {.vertex_bits = bits}};
    const struct trax_accuracy_row row = measure_scene(&scene, &variant);
    assert_true(FIGURE(row, RMSE) > 2 * before);
    before = FIGURE(row, RMSE);
    trax_scene_release(&scene);
  }
}

static void check_tree(const struct trax_scene *scene, struct trax_rebuild_options how) {
  const struct trax_variant variant = {.samples = 1, .rebuilt = true, .tree = how};
  const struct trax_accuracy_row row = measure_scene(scene, &variant);
  assert_true(FIGURE(row, WRONG) == 0 && FIGURE(row, TIED) == 0 && FIGURE(row, SHADOW) == 0);
  assert_true(FIGURE(row, RMSE) < 1e-3);
  assert_true(how.split ? FIGURE(row, SCENE) > common.scene.size : FIGURE(row, SCENE) < common.scene.size);
}

/* Built anew a scene is the same, so what another tree costs is due to the tree; and it changes no hit. */
static void test_other_trees(void **state) {
  (void)state;
  const struct trax_scene_section *sections = common.scene.header->sections;
  struct trax_scene same = rebuild((struct trax_rebuild_options){0});
  assert_memory_equal(same.nodes, common.scene.nodes, sections[TRAX_SCENE_NODES].size);
  assert_memory_equal(same.triangles, common.scene.triangles, sections[TRAX_SCENE_TRIANGLES].size);
  trax_scene_release(&same);

  const struct trax_rebuild_options quantised = {.nodes = TRAX_NODES_QUANTISED}, split = {.split = true};
  struct trax_scene scene = rebuild(quantised);
  check_tree(&scene, quantised);
  trax_scene_release(&scene);

  scene = rebuild(split);
  trax_error error;
  bool is_split;
  assert_int_equal(trax_scene_is_split(&is_split, &common.scene, &error), TRAX_OK);
  assert_false(is_split);
  assert_int_equal(trax_scene_is_split(&is_split, &scene, &error), TRAX_OK);
  assert_true(is_split && scene.triangle_count > common.scene.triangle_count);
  check_tree(&scene, split);
  /* And back. */
  struct trax_scene whole;
  assert_int_equal(trax_scene_rebuild(&whole, &scene, &(struct trax_rebuild_options){0}, NULL, &error), TRAX_OK);
  assert_int_equal(whole.triangle_count, common.scene.triangle_count);
  trax_scene_release(&whole);
  trax_scene_release(&scene);
}

static void test_keys(void **state) {
  (void)state;
  struct trax_frame frame = frame_of((struct trax_method){0}, 1);
  struct trax_frame other = frame_of((struct trax_method){.triangle = TRAX_TRIANGLE_MOLLER_TRUMBORE}, 1);
  const struct trax_accuracy_run run = run_of();
  const struct trax_variant plain = {.samples = 1}, bits = {.samples = 1, .bits = 12, .latency = TRAX_LATENCY_DIGITS},
                            newton = {.samples = 1, .bits = 10, .latency = TRAX_LATENCY_NEWTON},
                            digits = {.samples = 1, .bits = 10, .latency = TRAX_LATENCY_DIGITS};
  char keys[6][33];
  trax_error error;
  assert_int_equal(trax_accuracy_key(keys[0], &plain, &frame, &run, &error), TRAX_OK);
  assert_int_equal(trax_accuracy_key(keys[1], &bits, &frame, &run, &error), TRAX_OK);
  assert_int_equal(trax_accuracy_key(keys[2], &newton, &frame, &run, &error), TRAX_OK);
  assert_int_equal(trax_accuracy_key(keys[3], &digits, &frame, &run, &error), TRAX_OK);
  assert_int_equal(trax_accuracy_key(keys[4], &plain, &other, &run, &error), TRAX_OK);
  for (int i = 0; i < 5; i++)
    for (int j = 0; j < i; j++)
      assert_string_not_equal(keys[i], keys[j]);
  assert_int_equal(trax_accuracy_key(keys[5], &plain, &frame, &run, &error), TRAX_OK);
  assert_string_equal(keys[5], keys[0]);
  trax_frame_release(&frame);
  trax_frame_release(&other);
}

static void test_fronts(void **state) {
  (void)state;
  static const struct {
    double cycles, numerical, total;
    uint32_t samples;
    bool numerical_front, total_front;
  } points[] = {{10, 1, 5, 1, true, true},    /* cheapest */
                {10, 1, 5, 1, false, false},  /* the same again */
                {12, 1, 4, 1, false, true},   /* better in the total only */
                {11, 0.5, 6, 1, true, false}, /* in the numerical only */
                {13, 2, 7, 1, false, false},  /* in neither */
                {20, 0, 3, 2, false, true}};  /* of more samples */
  enum { COUNT = sizeof points / sizeof *points };
  struct trax_accuracy_row rows[COUNT] = {0};
  for (size_t i = 0; i < COUNT; i++) {
    rows[i].variant.samples = points[i].samples;
    FIGURE(rows[i], CYCLES) = points[i].cycles;
    FIGURE(rows[i], RMSE) = points[i].numerical;
    FIGURE(rows[i], TOTAL_RMSE) = points[i].total;
  }
  trax_accuracy_fronts(rows, COUNT);
  for (size_t i = 0; i < COUNT; i++) {
    assert_int_equal(rows[i].numerical_front, points[i].numerical_front);
    assert_int_equal(rows[i].total_front, points[i].total_front);
  }
}

static void test_rows_in_files(void **state) {
  (void)state;
  const char *path = test_path("row");
  struct trax_accuracy_row row = {0}, again = {0};
  trax_error error;
  for (int i = 0; i < TRAX_ACCURACY_FIGURE_COUNT; i++)
    row.figures[i] = i % 2 ? 1e9 + i : M_PI * pow(10, -i);
  assert_int_equal(trax_accuracy_write_row(&row, path, &error), TRAX_OK);
  assert_true(trax_accuracy_read_row(&again, path));
  assert_memory_equal(row.figures, again.figures, sizeof row.figures);
  assert_int_equal(truncate(path, 40), 0);
  assert_false(trax_accuracy_read_row(&again, path));
  unlink(path);
  assert_false(trax_accuracy_read_row(&again, path));
}

int main(int argc, char **argv) {
  if (argc != 3)
    return 2;
  root = argv[1], cache = argv[2];
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_the_default),
                                     cmocka_unit_test(test_shrunk_boxes),
                                     cmocka_unit_test(test_fewer_bits),
                                     cmocka_unit_test(test_other_methods),
                                     cmocka_unit_test(test_coarse_vertices),
                                     cmocka_unit_test(test_other_trees),
                                     cmocka_unit_test(test_keys),
                                     cmocka_unit_test(test_fronts),
                                     cmocka_unit_test(test_rows_in_files)};
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
