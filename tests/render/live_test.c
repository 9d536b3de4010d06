/* The frames of a picture that arrives: pixels that are there, missing ones, and the last frame. */
#include "live.h"

#include "meshes.h"
#include "temporary.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static struct trax_picture read_frame(const char *path) {
  struct trax_picture picture;
  trax_error error;
  if (trax_picture_read(&picture, path, &error) != TRAX_OK)
    fail_msg("%s", error.message);
  return picture;
}

enum { WIDTH = 32, HEIGHT = 24 };

/* Missing pixels are squares of 8 pixels. */
static bool is_missing(const struct trax_picture *frame, size_t pixel) {
  return frame->pixels[pixel] == ((pixel % WIDTH / 8 + pixel / WIDTH / 8) % 2 ? 0xFF505050u : 0xFF404040u);
}

static void test_frames(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  struct trax_scene scene;
  struct trax_frame frame;
  trax_error error;
  const float low[3] = {-1, -1, -1}, high[3] = {1, 1, 1};
  struct trax_view view = view_from(0, 0, 5, 0, 0, -1, 40, 2, 5, 5);
  mesh_box(&mesh, low, high, mesh_material(&mesh, 1, 1, 1));
  build(&scene, &mesh, NULL);
  struct options options = {.frame = {.width = WIDTH, .height = HEIGHT, .samples = 1}};
  struct live *live;
  assert_int_equal(live_create(&live, &options, &error), TRAX_OK);
  assert_null(live); /* nobody watches */
  live_show(live, NULL);
  options.progress_png = test_path("frame.png");
  assert_int_equal(live_create(&live, &options, &error), TRAX_OK);
  assert_int_equal(trax_frame_init(&frame, &scene, &view, &options.frame, &error), TRAX_OK);

  live_begin(live, &frame);
  struct trax_picture shown = read_frame(options.progress_png);
  for (size_t i = 0; i < WIDTH * HEIGHT; i++)
    assert_true(is_missing(&shown, i));
  trax_picture_release(&shown);

  uint32_t image[WIDTH * HEIGHT] = {0};
  for (size_t i = 0; i < WIDTH * HEIGHT; i += i % 3 + 1)
    image[i] = 0xFF000000u | (uint32_t)i;
  live_show(live, image);
  shown = read_frame(options.progress_png);
  for (size_t i = 0; i < WIDTH * HEIGHT; i++)
    assert_true(image[i] ? shown.pixels[i] == image[i] : is_missing(&shown, i));
  trax_picture_release(&shown);

  for (size_t i = 0; i < WIDTH * HEIGHT; i++)
    image[i] = 0xFF000000u | (uint32_t)(7 * i);
  struct trax_picture whole = {.width = WIDTH, .height = HEIGHT, .pixels = image};
  assert_int_equal(live_end(live, &whole, &error), TRAX_OK);
  shown = read_frame(options.progress_png);
  assert_memory_equal(shown.pixels, image, sizeof image);
  trax_picture_release(&shown);
  live_destroy(live);

  options.progress_png = test_path("none/frame.png"); /* a run ends before it says so */
  assert_int_equal(live_create(&live, &options, &error), TRAX_OK);
  live_begin(live, &frame);
  assert_int_equal(live_end(live, &whole, &error), TRAX_ERROR);
  assert_non_null(strstr(error.message, "none/frame.png"));
  live_destroy(live);
  trax_frame_release(&frame);
  trax_scene_release(&scene);
  trax_mesh_release(&mesh);
}

/* More pixels than a buffer of the C library has: libpng meets the failure, and must not hide its reason. */
static void test_full_disk(void **state) {
  (void)state;
  struct trax_picture picture;
  trax_error error;
  assert_int_equal(trax_picture_init(&picture, 128, 128, &error), TRAX_OK);
  for (uint32_t i = 0; i < 128 * 128; i++)
    picture.pixels[i] = i * 2654435761u; /* packs badly */
  assert_int_equal(trax_picture_write(&picture, "/dev/full", &error), TRAX_ERROR);
  assert_string_equal(error.message, "/dev/full: cannot be written: No space left on device");
  trax_picture_release(&picture);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_frames), cmocka_unit_test(test_full_disk)};
  return cmocka_run_group_tests_name("live", tests, NULL, NULL);
}
