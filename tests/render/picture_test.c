/* Pictures of the native twin against Embree's, and against what must hold whatever the reference says. */
#include "meshes.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* The twin's picture, which agrees with the reference's: within 2/255 in all but `exceptions` pixels. */
static struct trax_picture agreeing(const struct trax_scene *scene, const struct trax_view *view, uint32_t width,
                                    uint32_t height, unsigned exceptions) {
  struct trax_picture twin = take(scene, view, width, height, false, 2);
  struct trax_picture reference = take(scene, view, width, height, true, 0);
  struct trax_difference difference;
  trax_picture_compare(&difference, &twin, &reference, 2);
  if (difference.beyond > exceptions)
    print_error("%llu of %llu pixels beyond 2/255, worst %u at (%u, %u)\n", (unsigned long long)difference.beyond,
                (unsigned long long)difference.pixels, difference.largest, difference.x, difference.y);
  assert_true(difference.beyond <= exceptions);
  trax_picture_release(&reference);
  return twin;
}

static void assert_same(const struct trax_picture *a, const struct trax_picture *b) {
  assert_int_equal(a->width, b->width);
  assert_int_equal(a->height, b->height);
  assert_memory_equal(a->pixels, b->pixels, 4 * (size_t)a->width * a->height);
}

/* An open box with two boxes in it, in the manner of Cornell's. */
static void make_room(struct trax_mesh *mesh) {
  uint32_t white = mesh_material(mesh, 0.75f, 0.75f, 0.75f), red = mesh_material(mesh, 0.6f, 0.05f, 0.05f),
           green = mesh_material(mesh, 0.1f, 0.5f, 0.1f);
  static const float corners[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                      {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  static const unsigned char quads[5][4] = {{0, 1, 2, 3}, {0, 1, 5, 4}, {3, 2, 6, 7}, {0, 3, 7, 4}, {1, 2, 6, 5}};
  for (int i = 0; i < 8; i++)
    mesh_vertex(mesh, corners[i][0], corners[i][1], corners[i][2]);
  for (int i = 0; i < 5; i++) {
    uint32_t material = i == 3 ? red : i == 4 ? green : white;
    mesh_triangle(mesh, quads[i][0], quads[i][1], quads[i][2], material);
    mesh_triangle(mesh, quads[i][0], quads[i][2], quads[i][3], material);
  }
  mesh_box(mesh, (float[]){-0.7f, -1, -0.6f}, (float[]){-0.1f, 0.3f, 0.0f}, white);
  mesh_box(mesh, (float[]){0.15f, -1, 0.1f}, (float[]){0.65f, -0.4f, 0.6f}, white);
}

static const struct trax_view *room_view(void) {
  static struct trax_view view;
  view = view_from(0.02f, 0.03f, 3.9f, 0, 0, -1, 40, 0.1f, 0.85f, 0.2f);
  return &view;
}

static void test_room(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  make_room(&mesh);
  struct trax_scene scene = scene_of(&mesh, NULL);
  struct trax_picture picture = agreeing(&scene, room_view(), 160, 120, 19);
  unsigned red = 0, green = 0, dark = 0, lit = 0;
  for (unsigned i = 0; i < 160 * 120; i++) {
    int r = picture.pixels[i] & 0xFF, g = picture.pixels[i] >> 8 & 0xFF, b = picture.pixels[i] >> 16 & 0xFF;
    red += r > 2 * g, green += g > r + 20 && g > b + 20;
    dark += r == g && g == b && g < 95, lit += r == g && g == b && g > 130;
  }
  assert_true(red > 1000 && green > 1000 && dark > 500 && lit > 4000);
  trax_picture_release(&picture);
  trax_scene_release(&scene);
}

static void test_any_number_of_threads(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  make_room(&mesh);
  struct trax_scene scene = scene_of(&mesh, NULL);
  struct trax_picture one = take(&scene, room_view(), 61, 33, false, 1);
  for (unsigned threads = 2; threads <= 200; threads = threads * 3 + 1) { /* more than there are rows, too */
    struct trax_picture more = take(&scene, room_view(), 61, 33, false, threads);
    assert_same(&one, &more);
    trax_picture_release(&more);
  }
  trax_picture_release(&one);
  struct trax_picture tiny = take(&scene, room_view(), 1, 1, false, 64); /* more threads than pixels */
  trax_picture_release(&tiny);
  trax_scene_release(&scene);
}

static void test_soup(void **state) {
  (void)state;
  for (uint32_t seed = 1; seed <= 4; seed++) {
    struct trax_mesh mesh = {0};
    mesh_soup(&mesh, 3000, seed);
    struct trax_scene scene = scene_of(&mesh, NULL);
    struct trax_view view = view_from(0.3f, 0.5f, 2.6f, -0.1f, -0.2f, -1, 45, 1.5f, 2, 2);
    struct trax_picture picture = agreeing(&scene, &view, 160, 90, 14);
    assert_in_range(background_pixels(&picture), 500, 14000);
    trax_picture_release(&picture);
    trax_scene_release(&scene);
  }
}

/* Within a closed surface there is no background; within a convex one nothing is in shadow, so neither holes between
   triangles nor a surface that shadows itself go unseen. */
static void test_inside_a_sphere(void **state) {
  (void)state;
  for (unsigned levels = 1; levels <= 6; levels++) {
    struct trax_mesh mesh = {0};
    mesh_sphere(&mesh, 3, levels, 0);
    struct trax_scene scene = scene_of(&mesh, NULL);
    /* The view from the centre is symmetric: many rays meet vertices and edges. The light is there, too. */
    struct trax_view view = view_from(0, 0, 0, 0, 0, -1, 120, 0, 0, 0);
    struct trax_picture picture = agreeing(&scene, &view, 255, 129, 33);
    assert_int_equal(background_pixels(&picture), 0);
    for (unsigned i = 0; i < 255 * 129; i++)
      assert_true((picture.pixels[i] & 0xFF) > 160); /* lit: the ambient light alone gives at most 79 */
    trax_picture_release(&picture);
    trax_scene_release(&scene);
  }
}

/* A convex body throws no shadow on the side that the light sees. */
static void test_convex_body_from_outside(void **state) {
  (void)state;
  const float offsets[] = {0, 10, 1000};
  for (size_t i = 0; i < sizeof offsets / sizeof *offsets; i++) {
    struct trax_mesh mesh = {0};
    mesh_sphere(&mesh, 1, 4, 0);
    mesh_transform(&mesh, 1, offsets[i], -offsets[i], offsets[i]);
    struct trax_scene scene = scene_of(&mesh, NULL);
    float x = offsets[i], y = -offsets[i], z = offsets[i];
    struct trax_view view = view_from(x, y, z + 3, 0, 0, -1, 45, x, y, z + 3); /* the light at the eye */
    struct trax_picture picture = take(&scene, &view, 128, 128, false, 2);
    unsigned lit = 0, unlit = 0;
    for (unsigned p = 0; p < 128 * 128; p++)
      if (picture.pixels[p] != TRAX_DEFAULT_BACKGROUND) {
        lit += (picture.pixels[p] & 0xFF) > 90;
        unlit += (picture.pixels[p] & 0xFF) <= 90;
      }
    /* Unlit pixels lie in the outermost ring, where facets are seen edge-on. */
    assert_true(lit > 8000);
    assert_true(unlit < lit / 50);
    trax_picture_release(&picture);
    trax_scene_release(&scene);
  }
}

static void test_shapes_of_pictures(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  make_room(&mesh);
  struct trax_scene scene = scene_of(&mesh, NULL);
  const uint32_t sizes[][2] = {{1, 1}, {1, 2}, {2, 1}, {1, 97}, {97, 1}, {7, 8}, {8, 7}, {9, 9}, {3000, 1}, {1, 3000}};
  for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
    uint32_t pixels = sizes[i][0] * sizes[i][1];
    struct trax_picture picture = agreeing(&scene, room_view(), sizes[i][0], sizes[i][1], pixels / 1000 + pixels / 50);
    for (uint32_t p = 0; p < pixels; p++)
      assert_int_equal(picture.pixels[p] >> 24, 0xFF); /* none was left out */
    trax_picture_release(&picture);
  }
  trax_scene_release(&scene);
}

/* The ray of a 1 x 1 picture is the view's direction exactly: two of its components are zero. */
static void test_axis_parallel_rays(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  mesh_box(&mesh, (float[]){-1, -1, -1}, (float[]){1, 1, 1}, 0);
  mesh_box(&mesh, (float[]){1, 1, 1}, (float[]){2, 2, 2}, 0); /* its planes go on where the first one's end */
  struct trax_scene scene = scene_of(&mesh, NULL);
  for (int axis = 0; axis < 3; axis++)
    for (int sign = -1; sign <= 1; sign += 2)
      for (int place = 0; place < 9; place++) {
        float eye[3], direction[3] = {0, 0, 0};
        const float places[3] = {0, 0.5f, 1}; /* the diagonal's middle, beside it, the boxes' planes */
        direction[axis] = (float)sign;
        eye[axis] = -5 * (float)sign;
        eye[(axis + 1) % 3] = places[place % 3];
        eye[(axis + 2) % 3] = places[place / 3];
        struct trax_view view =
            view_from(eye[0], eye[1], eye[2], direction[0], direction[1], direction[2], 30, eye[0], eye[1], eye[2]);
        struct trax_picture picture = take(&scene, &view, 1, 1, false, 1);
        assert_int_equal(background_pixels(&picture), 0);
        trax_picture_release(&picture);
      }
  trax_scene_release(&scene);
}

/* Eyes inside, on planes of boxes, on surfaces' planes, on a vertex. */
static void test_eyes_in_awkward_places(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  mesh_box(&mesh, (float[]){-2, -2, -2}, (float[]){2, 2, 2}, 0);
  mesh_box(&mesh, (float[]){-1, -1, -1}, (float[]){0, 0, 0}, 0);
  struct trax_scene scene = scene_of(&mesh, NULL);
  const float eyes[][3] = {{-0.5f, -0.5f, -0.5f}, {0, 1, 1}, {1, 0, 1}, {0, 0, 1}, {-1, 0.5f, 0}, {0.5f, 0.5f, 0.5f}};
  for (size_t i = 0; i < sizeof eyes / sizeof *eyes; i++)
    for (int axis = 0; axis < 3; axis++) {
      const float *e = eyes[i];
      struct trax_view view =
          view_from(e[0], e[1], e[2], axis == 0, axis == 1, -(float)(axis == 2), 100, 1.5f, 1.5f, 1.5f);
      struct trax_picture picture = agreeing(&scene, &view, 65, 49, 65 + 49); /* a line may lie on an edge */
      assert_int_equal(background_pixels(&picture), 0);
      trax_picture_release(&picture);
    }
  trax_scene_release(&scene);
}

static void test_one_triangle_and_none(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  struct trax_view view = view_from(0.25f, 0.25f, 2, 0, 0, -1, 60, 0.2f, 0.3f, 1);
  struct trax_scene scene = scene_of(&mesh, NULL);
  struct trax_picture picture = agreeing(&scene, &view, 40, 30, 0);
  assert_int_equal(background_pixels(&picture), 40 * 30);
  trax_picture_release(&picture);
  trax_scene_release(&scene);

  for (uint32_t turned = 0; turned < 2; turned++) { /* either side is drawn alike */
    mesh_vertex(&mesh, 0, 0, 0), mesh_vertex(&mesh, 1, 0, 0), mesh_vertex(&mesh, 0, 1, 0);
    mesh_triangle(&mesh, 0, 1 + turned, 2 - turned, 0);
    scene = scene_of(&mesh, NULL);
    picture = agreeing(&scene, &view, 160, 120, 2);
    assert_in_range(160 * 120 - background_pixels(&picture), 1300, 1400); /* 1/2 of (120 / (4 tan 30))^2 = 1350 */
    trax_picture_release(&picture);
    trax_scene_release(&scene);
  }
}

/* Triangles without area, which the importer would drop, are never hit and harm nothing. */
static void test_degenerate_triangles(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  struct trax_scene scene = {0}, plain = {0};
  make_room(&mesh);
  build(&plain, &mesh, NULL);
  for (uint32_t i = 0; i < 8; i++) {
    mesh_triangle(&mesh, i, i, i, 0);           /* a point */
    mesh_triangle(&mesh, i, (i + 1) % 8, i, 0); /* a line */
  }
  uint32_t first = mesh_vertex(&mesh, -0.5f, 0.1f, 0.7f);
  mesh_vertex(&mesh, 0, 0.1f, 0.7f), mesh_vertex(&mesh, 0.5f, 0.1f, 0.7f);
  mesh_triangle(&mesh, first, first + 1, first + 2, 0); /* in front of everything */
  build(&scene, &mesh, NULL);
  assert_int_equal(scene.triangle_count, plain.triangle_count + 17);
  struct trax_picture with = take(&scene, room_view(), 160, 120, false, 2);
  struct trax_picture without = take(&plain, room_view(), 160, 120, false, 2);
  assert_same(&with, &without);
  trax_picture_release(&with);
  trax_picture_release(&without);
  trax_scene_release(&scene);
  trax_scene_release(&plain);
  trax_mesh_release(&mesh);
}

/* The unit of length does not matter, not even in the last bit. */
static void test_scale(void **state) {
  (void)state;
  struct trax_picture first = {0};
  const int exponents[] = {0, -3, 9, -60, 55, -90, 25};
  for (size_t i = 0; i < sizeof exponents / sizeof *exponents; i++) {
    struct trax_mesh mesh = {0};
    float scale = ldexpf(1, exponents[i]);
    make_room(&mesh);
    mesh_transform(&mesh, scale, 0, 0, 0);
    struct trax_scene scene = scene_of(&mesh, NULL);
    struct trax_view view = *room_view();
    for (int c = 0; c < 3; c++)
      view.eye[c] *= scale, view.light[c] *= scale;
    int exponent = normalise(&scene, &view);
    assert_true(exponents[i] < -4 || exponents[i] > 18 ? exponent != 0 : exponent == 0);
    struct trax_picture picture = agreeing(&scene, &view, 80, 60, 5);
    if (i == 0) {
      first = picture;
    } else {
      assert_same(&first, &picture);
      trax_picture_release(&picture);
    }
    trax_scene_release(&scene);
  }
  trax_picture_release(&first);
}

/* Far from the origin, where floats are one unit apart. */
static void test_far_offset(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  make_room(&mesh);
  mesh_transform(&mesh, 64, 1e7f, -1e7f, 1e7f);
  struct trax_scene scene = scene_of(&mesh, NULL);
  struct trax_view view = view_from(1e7f + 2, -1e7f + 3, 1e7f + 250, 0, 0, -1, 40, 1e7f + 7, -1e7f + 50, 1e7f + 12);
  assert_int_equal(normalise(&scene, &view), -3);
  /* The points that shadow rays start from are a unit apart, too: the shadows' borders are as coarse. */
  struct trax_picture picture = agreeing(&scene, &view, 80, 60, 48);
  assert_true(background_pixels(&picture) < 2000);
  trax_picture_release(&picture);
  trax_scene_release(&scene);
}

static void test_light_that_is_beyond_any_scale(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  make_room(&mesh);
  struct trax_scene scene = scene_of(&mesh, NULL);
  struct trax_view view = *room_view();
  trax_error error;
  int exponent;
  view.light[1] = 0x1p39f; /* as good as parallel light */
  assert_int_equal(trax_normalise(&scene, &view, &exponent, &error), TRAX_OK);
  struct trax_picture picture = agreeing(&scene, &view, 40, 30, 2);
  trax_picture_release(&picture);
  view.light[1] = 0x1p60f;
  assert_int_equal(trax_normalise(&scene, &view, &exponent, &error), TRAX_ERROR);
  assert_non_null(strstr(error.message, "light"));
  trax_scene_release(&scene);
}

/* The deepest scene there may be, where the whole stack is in use (with the sanitizers an overflow is seen). */
static void test_deepest_scene(void **state) {
  (void)state;
  struct trax_scene scene;
  chain_scene(&scene);
  struct trax_view from_front = view_from(0, 0, 3, 0, 0, -1, 40, 0.5f, 0.4f, 4);
  struct trax_picture picture = agreeing(&scene, &from_front, 80, 60, 2);
  assert_true(background_pixels(&picture) < 2400);
  trax_picture_release(&picture);
  struct trax_view from_behind = view_from(0, 0, -60, 0, 0, 1, 40, 0.5f, 0.4f, 4); /* the light beyond all of them */
  picture = agreeing(&scene, &from_behind, 80, 60, 2);
  trax_picture_release(&picture);
  free(scene.bytes);
}

/* Sizes from 2^-40 to 2^20 in one scene: the builder makes a chain of its own. */
static void test_nested_sizes(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  struct trax_scene scene = {0};
  for (int i = -40; i <= 20; i++) {
    float s = ldexpf(1, i);
    uint32_t first = mesh_vertex(&mesh, s, 0, 0);
    mesh_vertex(&mesh, 0, s, 0), mesh_vertex(&mesh, 0, 0, s);
    mesh_triangle(&mesh, first, first + 1, first + 2, 0);
  }
  const float eyes[] = {0x1p22f, 3, 0x1p-10f};
  for (int i = 0; i < 3; i++) {
    build(&scene, &mesh, NULL);
    float e = eyes[i];
    struct trax_view view = view_from(e, e, e, -1, -1, -1, 60, e, 1.3f * e, e);
    normalise(&scene, &view);
    struct trax_picture picture = agreeing(&scene, &view, 80, 60, 4);
    trax_picture_release(&picture);
    trax_scene_release(&scene);
  }
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
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_room),
      cmocka_unit_test(test_any_number_of_threads),
      cmocka_unit_test(test_soup),
      cmocka_unit_test(test_inside_a_sphere),
      cmocka_unit_test(test_convex_body_from_outside),
      cmocka_unit_test(test_shapes_of_pictures),
      cmocka_unit_test(test_axis_parallel_rays),
      cmocka_unit_test(test_eyes_in_awkward_places),
      cmocka_unit_test(test_one_triangle_and_none),
      cmocka_unit_test(test_degenerate_triangles),
      cmocka_unit_test(test_scale),
      cmocka_unit_test(test_far_offset),
      cmocka_unit_test(test_light_that_is_beyond_any_scale),
      cmocka_unit_test(test_deepest_scene),
      cmocka_unit_test(test_nested_sizes),
      cmocka_unit_test(test_full_disk),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
