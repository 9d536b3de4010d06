/* How wrong a picture is: what is measured of a right method and of broken ones, and the converged picture in its file.
   Usage: render-error-test ROOT CACHE; ROOT has bin/clang and lib/trax, CACHE keeps compiled programs. */
#include "meshes.h"

#include "picture_error.h"
#include "temporary.h"

#include <dirent.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
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

/* The boxes that the traversal sees are widened by so much less than they should be; bits: of the special unit. */
static void measure(double figures[TRAX_ERROR_FIGURE_COUNT], struct trax_method method, float narrower, unsigned bits) {
  struct trax_frame frame = frame_of(method, 1);
  struct trax_config *config = trax_config_copy(common.config);
  char text[16];
  trax_error error;
  snprintf(text, sizeof text, "%u", bits);
  assert_int_equal(trax_config_set(config, "special.precision_bits", text, &error), TRAX_OK);
  frame.params->box_margin -= narrower;
  const struct trax_error_run run = {.specialise = {.root = root, .cache = cache},
                                     .config = config,
                                     .exact = &common.exact,
                                     .converged = &common.converged,
                                     .host_threads = 1};
  if (trax_error_measure(figures, &frame, &run, &error) != TRAX_OK)
    fail_msg("%s", error.message);
  trax_frame_release(&frame);
  trax_config_destroy(config);
}

enum { WHOLE = 24 }; /* bits */
#define FIGURE(NAME) (figures[TRAX_ERROR_##NAME])

/* What the place of a shadow ray's start does to a channel. The program takes the angle to a plain light from there, up
   to 3 x 2^-17 of a triangle's edges from the point: edges of 2, a light at 0.85 and more. */
#define OF_THE_START (3 * 0x1p-17 * 2 / 0.85 * 255)

/* Binary32 as it should be: the rounding of channels is far below a byte's, no hit is wrong, and what is left is for
   want of samples. */
static void test_the_default(void **state) {
  (void)state;
  double figures[TRAX_ERROR_FIGURE_COUNT];
  measure(figures, (struct trax_method){0}, 0, WHOLE);
  assert_true(FIGURE(RMSE) > 0 && FIGURE(RMSE) < OF_THE_START / 4);
  assert_true(FIGURE(LARGEST) < OF_THE_START);
  assert_true(FIGURE(WRONG) == 0 && FIGURE(SHADOW) == 0 && FIGURE(CHANGED) == 0);
  assert_true(FIGURE(SAMPLING_RMSE) > 1);
  assert_true(fabs(FIGURE(TOTAL_RMSE) - FIGURE(SAMPLING_RMSE)) < 1e-3);
  assert_true(FIGURE(FLIP) < 1e-3 && FIGURE(TOTAL_FLIP) > 0.01);
}

/* Boxes that are too small hide triangles: rays that should hit miss, or hit what is behind. */
static void test_shrunk_boxes(void **state) {
  (void)state;
  double figures[TRAX_ERROR_FIGURE_COUNT];
  measure(figures, (struct trax_method){0}, 0.1f, WHOLE);
  assert_true(FIGURE(MISSED) >= 20 && FIGURE(OTHER) >= 20);
  assert_true(FIGURE(GROWN) == 0);
  assert_true(FIGURE(WRONG) == FIGURE(MISSED) + FIGURE(OTHER));
  assert_true(FIGURE(RMSE) > 5 && FIGURE(LARGEST) > 50 && FIGURE(FLIP) > 0.01);
}

static void test_fewer_bits(void **state) {
  (void)state;
  double before = OF_THE_START / 16; /* which hides the difference between 24 bits and 18 */
  for (unsigned bits = WHOLE - 12; bits >= 6; bits -= 6) {
    double figures[TRAX_ERROR_FIGURE_COUNT];
    measure(figures, (struct trax_method){0}, 0, bits);
    assert_true(FIGURE(RMSE) > 4 * before);
    before = FIGURE(RMSE);
  }
}

static void test_other_methods(void **state) {
  (void)state;
  for (int method = 1; method < 4; method++) {
    double figures[TRAX_ERROR_FIGURE_COUNT];
    measure(figures,
            (struct trax_method){.triangle = method & 1 ? TRAX_TRIANGLE_MOLLER_TRUMBORE : 0, .fast_math = method & 2},
            0, WHOLE);
    assert_true(FIGURE(RMSE) < 2 && FIGURE(WRONG) <= 2);
  }
}

/* --- the converged picture --- */

static void converge(struct trax_converged *converged, const struct trax_scene *scene, float light,
                     const char *folder) {
  const struct trax_frame_options options = {.width = 16, .height = 9, .samples = 4, .shadows = true, .ambient = 0.1f};
  struct trax_frame_options fewer = options;
  struct trax_frame frame, rough;
  struct trax_view view = common.view;
  struct trax_render_run run = {0};
  trax_error error;
  view.light[0] += light;
  fewer.samples = 2;
  assert_int_equal(trax_frame_init(&frame, scene, &view, &options, &error), TRAX_OK);
  assert_int_equal(trax_frame_init(&rough, scene, &view, &fewer, &error), TRAX_OK);
  if (trax_converge(converged, &frame, &rough, folder, &run, &error) != TRAX_OK)
    fail_msg("%s", error.message);
  trax_frame_release(&frame);
  trax_frame_release(&rough);
}

static unsigned files_in(const char *folder, char last[512]) {
  unsigned count = 0;
  DIR *directory = opendir(folder);
  assert_non_null(directory);
  for (const struct dirent *entry; (entry = readdir(directory)) != NULL;)
    if (entry->d_name[0] != '.') {
      snprintf(last, 512, "%s/%s", folder, entry->d_name);
      count++;
    }
  closedir(directory);
  return count;
}

static void assert_same(const struct trax_converged *a, const struct trax_converged *b) {
  assert_memory_equal(a->picture.channels, b->picture.channels, (size_t)3 * 16 * 9 * sizeof(double));
  assert_true(a->rough_rmse == b->rough_rmse && a->rough_rmse > 0);
}

/* One file for a view, whatever the tree; another light has another one; a damaged one is computed again. */
static void test_converged_picture(void **state) {
  (void)state;
  const char *folder = test_path("converged");
  char path[512];
  struct trax_scene split;
  struct trax_converged first, again;
  build(&split, &common.mesh, &(struct trax_build_options){.nodes = TRAX_NODES_QUANTISED, .splits = 3});
  assert_true(split.triangle_count > common.scene.triangle_count);
  converge(&first, &common.scene, 0, NULL);
  converge(&again, &common.scene, 0, folder);
  assert_same(&first, &again);
  trax_exact_release(&again.picture);
  assert_int_equal(files_in(folder, path), 1);
  struct stat before, after;
  assert_int_equal(stat(path, &before), 0);
  converge(&again, &split, 0, folder);
  assert_same(&first, &again);
  trax_exact_release(&again.picture);
  assert_int_equal(files_in(folder, path), 1);
  assert_int_equal(stat(path, &after), 0);
  assert_true(before.st_ino == after.st_ino); /* it was not written again */

  FILE *file = fopen(path, "r+b");
  assert_non_null(file);
  fseek(file, 100, SEEK_SET);
  fputs("damaged!", file);
  fclose(file);
  converge(&again, &common.scene, 0, folder);
  assert_same(&first, &again);
  trax_exact_release(&again.picture);
  assert_int_equal(files_in(folder, path), 1);
  converge(&again, &common.scene, 0.5f, folder);
  assert_int_equal(files_in(folder, path), 2);
  assert_true(again.rough_rmse != first.rough_rmse);
  trax_exact_release(&again.picture);
  trax_exact_release(&first.picture);
  trax_scene_release(&split);
  while (files_in(folder, path))
    assert_int_equal(unlink(path), 0);
  assert_int_equal(rmdir(folder), 0);
}

int main(int argc, char **argv) {
  if (argc != 3)
    return 2;
  root = argv[1], cache = argv[2];
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_the_default), cmocka_unit_test(test_shrunk_boxes),
                                     cmocka_unit_test(test_fewer_bits), cmocka_unit_test(test_other_methods),
                                     cmocka_unit_test(test_converged_picture)};
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
