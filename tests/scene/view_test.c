/* View files: what is read, what is refused and where; and the framing of scenes without one. */
#include "support.h"

#include "trax/view.h"

#include <dirent.h>
#include <math.h>
#include <string.h>

static float dot(const float a[3], const float b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void check_frame_of_reference(const struct trax_view *view) {
  assert_true(fabsf(dot(view->direction, view->direction) - 1) < 1e-6f);
  assert_true(fabsf(dot(view->up, view->up) - 1) < 1e-6f);
  assert_true(fabsf(dot(view->up, view->direction)) < 1e-6f);
}

static void read_good(struct trax_view *view, const char *text) {
  trax_error error;
  if (trax_view_read(view, test_text("good.view", text), &error) != TRAX_OK)
    fail_msg("%s", error.message);
  check_frame_of_reference(view);
}

static void test_values(void **state) {
  (void)state;
  struct trax_view view;
  read_good(&view, "eye = [1, 2, 3];\ndirection = [0.0, 0.0, -4.0]; up = (0, 2.5, 1); # mixed needs a list\n"
                   "fov = 45; light = [-1.0, 1.0e2, 0.5];\n");
  const float eye[3] = {1, 2, 3}, direction[3] = {0, 0, -1}, up[3] = {0, 1, 0}, light[3] = {-1, 100, 0.5f};
  assert_memory_equal(view.eye, eye, sizeof eye);
  assert_true(view.direction[0] == direction[0] && view.direction[2] == direction[2]);
  assert_true(view.up[1] == up[1] && view.up[2] == 0);
  assert_memory_equal(view.light, light, sizeof light);
  assert_true(view.fov == 45);
  read_good(&view, "eye = [1, 2, 3]; look_at = [1, 2, 13]; up = [0, 1, 0]; fov = 45; light = [0, 0, 0];");
  assert_true(view.direction[0] == 0 && view.direction[1] == 0 && view.direction[2] == 1);
}

static void test_lights(void **state) {
  (void)state;
  struct trax_view view;
  read_good(&view,
            "eye = [1, 2, 3]; direction = [0, 0, -1]; up = [0, 1, 0]; fov = 45;\n"
            "lights = ( { type = \"point\"; position = [1, 2, 3]; colour = (0.5, 1, 0); strength = 2; falloff = 4; },\n"
            "  { type = \"directional\"; direction = [0, -3, 0]; },\n"
            "  { type = \"rectangle\"; corner = [7, 8, 9]; edges = ( [2, 0, 0], [0, 0, 4] ); strength = 0.5; } );");
  assert_int_equal(view.light_count, 3);
  const struct trax_light expected[] = {
      {.kind = TRAX_LIGHT_POINT, .position = {1, 2, 3}, .colour = {0.5f, 1, 0}, .strength = 2, .falloff = 4},
      {.kind = TRAX_LIGHT_DIRECTIONAL, .direction = {0, -1, 0}, .colour = {1, 1, 1}, .strength = 1},
      {.kind = TRAX_LIGHT_RECTANGLE,
       .position = {7, 8, 9},
       .direction = {0, -1, 0},
       .edges = {{2, 0, 0}, {0, 0, 4}},
       .colour = {1, 1, 1},
       .strength = 0.5f}};
  for (uint32_t i = 0; i < 3; i++) {
    const struct trax_light *light = &view.lights[i];
    assert_int_equal(light->kind, expected[i].kind);
    assert_true(light->strength == expected[i].strength && light->falloff == expected[i].falloff);
    for (int axis = 0; axis < 3; axis++) {
      assert_true(light->position[axis] == expected[i].position[axis]);
      assert_true(light->direction[axis] == expected[i].direction[axis]);
      assert_true(light->edges[0][axis] == expected[i].edges[0][axis]);
      assert_true(light->edges[1][axis] == expected[i].edges[1][axis]);
      assert_true(light->colour[axis] == expected[i].colour[axis]);
    }
  }
}

#define EYE "eye = [0, 0, 0]; direction = [0, 0, 1]; up = [0, 1, 0]; fov = 45;\n"
#define LIGHT(text) EYE "lights = (\n{ " text " } );"

static void test_errors(void **state) {
  (void)state;
  static const struct {
    const char *text, *message;
  } bad[] = {
      {EYE "light = [0, 0, 0];\nlights = ( );", "bad.view:3: lights: light is given as well"},
      {EYE "lights = ( );", "bad.view:2: lights: must be a list of lights"},
      {EYE "lights = [1, 2, 3];", "bad.view:2: lights: must be a list of lights"},
      {EYE "lights = ( 7 );", "bad.view:2: lights[0]: must be a light"},
      {EYE "lights = ( {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {} );", "at most 16 lights"},
      {LIGHT(""), "bad.view:3: lights[0].type: missing"},
      {LIGHT("type = 7;"), "bad.view:3: lights[0].type: must be \"point\""},
      {LIGHT("type = \"spot\";"), "bad.view:3: lights[0].type: must be \"point\""},
      {LIGHT("type = \"point\";"), "bad.view:3: lights[0].position: missing"},
      {LIGHT("type = \"point\";\nposition = [1, 2];"), "bad.view:4: lights[0].position: must have exactly three"},
      {LIGHT("type = \"point\";\ncorner = [1, 2, 3];"), "bad.view:4: lights[0].corner: unknown; the keys are type,"},
      {LIGHT("type = \"point\"; position = [1, 2, 3];\nstrength = -1;"),
       "bad.view:4: lights[0].strength: must be a number from 0 to 1e+06"},
      {LIGHT("type = \"point\"; position = [1, 2, 3];\nfalloff = \"far\";"), "bad.view:4: lights[0].falloff: must be"},
      {LIGHT("type = \"point\"; position = [1, 2, 3];\ncolour = [0, 2, 0];"),
       "bad.view:4: lights[0].colour: must be three numbers from 0 to 1"},
      {LIGHT("type = \"directional\"; direction = [0, 0, 0];"), "bad.view:3: lights[0].direction: has no length"},
      {LIGHT("type = \"rectangle\"; corner = [0, 0, 0]; edges = ([1, 0, 0]);"), "lights[0].edges: must be two vectors"},
      {LIGHT("type = \"rectangle\"; corner = [0, 0, 0]; edges = ([1, 0, 0], 7);"), "lights[0].edges: must be three"},
      {LIGHT("type = \"rectangle\"; corner = [0, 0, 0]; edges = ([1, 0, 0], [0, 0, 0]);"), "an edge has no length"},
      {LIGHT("type = \"rectangle\"; corner = [0, 0, 0]; edges = ([1, 0, 0], [1, 1, 0]);"), "not perpendicular"},
      {"eye = [1, 2, 3];\ndirection = [0, 0, 1];\nup = [0, 1, 0];\nfov = 45;\n", "bad.view:1: light: missing"},
      {"direction = [0, 0, 1];", "bad.view:1: eye: missing"},
      {"eye = [0, 0, 0]; up = [0, 1, 0];", "bad.view:1: direction: missing, and so is look_at"},
      {"eye = [0, 0, 0];\ndirection = [0, 0, 1];\nlook_at = [0, 0, 1];", "bad.view:3: look_at: direction is given"},
      {"\n\neye = [1, 2];", "bad.view:3: eye: must have exactly three numbers"},
      {"\neye = 7;", "bad.view:2: eye: must be three numbers"},
      {"eye = [\"a\", \"b\", \"c\"];", "bad.view:1: eye: must be three numbers"},
      {"eye = [1e30, 0.0, 0.0];", "bad.view:1: eye: must be three numbers of ordinary size"},
      {"eye = [0, 0, 0];\ndirection = [0, 0, 0];", "bad.view:2: direction: has no length"},
      {"eye = [0, 1, 0];\nlook_at = [0, 1, 0];", "bad.view:2: look_at: is the eye itself"},
      {"eye = [0, 0, 0];\ndirection = [0, 2, 0];\nup = [0, -3, 0];", "bad.view:3: up: is parallel to the direction"},
      {"eye = [0, 0, 0];\ndirection = [0, 2, 0];\nup = [0, 0, 0];", "bad.view:3: up: has no length"},
      {"eye = [0, 0, 0]; direction = [0, 2, 0]; up = [1, 0, 0];\nfov = 180.0;", "bad.view:2: fov: must be"},
      {"eye = [0, 0, 0]; direction = [0, 2, 0]; up = [1, 0, 0];\nfov = \"wide\";", "bad.view:2: fov: must be"},
      {"eye = [0, 0, 0];\nlihgt = [0, 0, 0];", "bad.view:2: lihgt: unknown"},
      {"eye = [0, 0, 0];\neye = [0, 0, 0];", "bad.view:2: "},
      {"eye = [0, 0, 0", "bad.view:1: syntax error"},
      {"\n\n?", "bad.view:3: syntax error"},
      {"@include \"/nowhere.view\"\n", "bad.view:1: @include: a view is one file"},
      {"eye = [0, 0, 0];\n \t@include \"/dev/zero\"\n", "bad.view:2: @include: a view is one file"},
  };
  for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
    struct trax_view view;
    trax_error error;
    if (trax_view_read(&view, test_text("bad.view", bad[i].text), &error) != TRAX_ERROR)
      fail_msg("accepted: %s", bad[i].text);
    assert_contains(error.message, bad[i].message);
  }
  struct trax_view view;
  trax_error error;
  assert_int_equal(trax_view_read(&view, test_path("nowhere.view"), &error), TRAX_ERROR);
  assert_contains(error.message, "nowhere.view: cannot be read");
  assert_int_equal(trax_view_read(&view, test_directory(), &error), TRAX_ERROR);
  assert_int_equal(trax_view_read(&view, test_file("zeros.view", "eye\0", 4), &error), TRAX_ERROR);
  assert_contains(error.message, "zeros.view:1: not text");
}

static void test_shipped_views(void **state) {
  (void)state;
  DIR *stream = opendir(VIEWS);
  assert_non_null(stream);
  unsigned count = 0;
  for (struct dirent *entry; (entry = readdir(stream));) {
    if (!strstr(entry->d_name, ".view"))
      continue;
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", VIEWS, entry->d_name);
    struct trax_view view;
    trax_error error;
    if (trax_view_read(&view, path, &error) != TRAX_OK)
      fail_msg("%s", error.message);
    check_frame_of_reference(&view);
    count++;
  }
  closedir(stream);
  assert_true(count >= 6);
}

/* A written view reads back. */
static void test_writing(void **state) {
  (void)state;
  static const char *const texts[] = {
      "eye = [1, 2, 3]; look_at = [1.1, 2.0, 13.3]; up = [0, 1, 0]; fov = 45; light = [1.0e12, -0.1, 1.0e-7];",
      "eye = (0.3, 1e-20, 3); direction = [1, 1, 1]; up = [0, 1, 0]; fov = 30.3; lights = ("
      "{ type = \"point\"; position = (0.1, 2, 3); falloff = 0.7; strength = 3; },"
      "{ type = \"directional\"; direction = [1, 2, 3]; colour = (0.1, 0.2, 1); },"
      "{ type = \"rectangle\"; corner = [1, 2, 3]; edges = ((0.1, 0, 0), (0, 0.3, 0)); });"};
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    struct trax_view first, second;
    trax_error error;
    read_good(&first, texts[i]);
    const char *path = test_path("written.view");
    assert_int_equal(trax_view_write(&first, path, &error), TRAX_OK);
    if (trax_view_read(&second, path, &error) != TRAX_OK)
      fail_msg("%s", error.message);
    assert_memory_equal(first.eye, second.eye, sizeof first.eye);
    assert_memory_equal(first.light, second.light, sizeof first.light);
    assert_true(first.has_look_at == second.has_look_at && first.fov == second.fov);
    assert_memory_equal(first.look_at, second.look_at, sizeof first.look_at);
    for (int axis = 0; axis < 3; axis++) { /* made of unit length once more */
      assert_true(fabsf(first.direction[axis] - second.direction[axis]) < 1e-6f);
      assert_true(fabsf(first.up[axis] - second.up[axis]) < 1e-6f);
    }
    assert_int_equal(first.light_count, second.light_count);
    for (uint32_t k = 0; k < first.light_count; k++) {
      const struct trax_light *a = &first.lights[k], *b = &second.lights[k];
      assert_true(a->kind == b->kind && a->strength == b->strength && a->falloff == b->falloff);
      assert_memory_equal(a->position, b->position, sizeof a->position);
      assert_memory_equal(a->edges, b->edges, sizeof a->edges);
      assert_memory_equal(a->colour, b->colour, sizeof a->colour);
      for (int axis = 0; axis < 3; axis++)
        assert_true(fabsf(a->direction[axis] - b->direction[axis]) < 1e-6f);
    }
  }
}

static void assert_point(const float point[3], float x, float y, float z) {
  if (fabsf(point[0] - x) > 1e-5f || fabsf(point[1] - y) > 1e-5f || fabsf(point[2] - z) > 1e-5f)
    fail_msg("%g %g %g is not %g %g %g", (double)point[0], (double)point[1], (double)point[2], (double)x, (double)y,
             (double)z);
}

static void test_orbit(void **state) {
  (void)state;
  const float centre[3] = {1, 0, 0};
  struct trax_view start, view;
  read_good(&start, "eye = [1, 0, 4]; look_at = [1, 0, 0]; up = [0, 1, 0]; fov = 45; light = [7, 8, 9];");
  view = start;
  trax_view_orbit(&view, centre, 90, 0);
  check_frame_of_reference(&view);
  assert_point(view.eye, 5, 0, 0);
  assert_point(view.direction, -1, 0, 0);
  assert_point(view.up, 0, 1, 0);
  assert_point(view.light, 7, 8, 9);
  assert_point(view.look_at, 1, 0, 0);
  view = start;
  trax_view_orbit(&view, centre, 0, 30);
  check_frame_of_reference(&view);
  assert_point(view.eye, 1, 2, 4 * cosf(3.14159265f / 6));
  assert_point(view.up, 0, cosf(3.14159265f / 6), -0.5f);
  trax_view_orbit(&view, centre, 180, 0); /* around y, though the camera is tilted */
  assert_point(view.eye, 1, 2, -4 * cosf(3.14159265f / 6));
  view = start;
  trax_view_orbit(&view, centre, 45, 90); /* straight from above is no special case */
  check_frame_of_reference(&view);
  assert_point(view.eye, 1, 4, 0);
  assert_point(view.direction, 0, -1, 0);
}

static void test_aiming(void **state) {
  (void)state;
  struct trax_view view;
  trax_error error;
  read_good(&view, "eye = [1, 0, 4]; direction = [0, 0, -1]; up = [0, 1, 0]; fov = 45; light = [7, 8, 9];");
  const float at[3] = {1, 0, 4}, aside[3] = {2, 0, 4}, up[3] = {1, 0, 7}, none[3] = {0, 0, 0};
  assert_int_equal(trax_view_aim(&view, at, &error), TRAX_ERROR);
  assert_contains(error.message, "is the eye itself");
  assert_int_equal(trax_view_aim(&view, aside, &error), TRAX_OK);
  assert_point(view.direction, 1, 0, 0);
  assert_int_equal(trax_view_set_up(&view, up, &error), TRAX_OK);
  assert_point(view.up, 0, 0, 1);
  assert_int_equal(trax_view_set_up(&view, none, &error), TRAX_ERROR);
  assert_contains(error.message, "has no length");
  assert_int_equal(trax_view_set_up(&view, view.direction, &error), TRAX_ERROR);
  assert_contains(error.message, "in which the eye looks");
}

/* A scene of triangles whose corners are among those of a box: the box's diagonals, seen from any side. */
static void make_box(struct trax_scene *scene, struct trax_scene_header *header, struct trax_triangle triangles[8],
                     const float box[2][3]) {
  *header = (struct trax_scene_header){0};
  *scene = (struct trax_scene){.header = header, .triangles = triangles, .triangle_count = 8};
  for (int corner = 0; corner < 8; corner++)
    for (int axis = 0; axis < 3; axis++) {
      triangles[corner].v0[axis] = box[corner >> axis & 1][axis];
      triangles[corner].v1[axis] = box[0][axis];
      triangles[corner].v2[axis] = box[1][axis];
    }
  for (int axis = 0; axis < 3; axis++) {
    header->bounds_min[axis] = box[0][axis];
    header->bounds_max[axis] = box[1][axis];
  }
}

/* The whole scene is in the picture, in the middle, and takes 80 % of its width or height. */
static void check_framed(const struct trax_view *view, const struct trax_scene *scene, float aspect) {
  const float *d = view->direction, *u = view->up;
  const float right[3] = {d[1] * u[2] - d[2] * u[1], d[2] * u[0] - d[0] * u[2], d[0] * u[1] - d[1] * u[0]};
  const float tangent = tanf(view->fov * 3.14159265f / 360);
  float low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
  check_frame_of_reference(view);
  for (uint32_t i = 0; i < scene->triangle_count; i++) {
    float p[3];
    for (int axis = 0; axis < 3; axis++)
      p[axis] = scene->triangles[i].v0[axis] - view->eye[axis];
    const float depth = dot(p, d);
    assert_true(depth > 0);
    const float places[2] = {dot(p, right) / (depth * tangent * aspect), dot(p, u) / (depth * tangent)};
    for (int side = 0; side < 2; side++) {
      low[side] = fminf(low[side], places[side]);
      high[side] = fmaxf(high[side], places[side]);
    }
  }
  const int fuller = high[0] - low[0] > high[1] - low[1] ? 0 : 1;
  if (!(fabsf(high[fuller] - 0.8f) < 1e-3f && fabsf(low[fuller] + 0.8f) < 1e-3f))
    fail_msg("the picture is filled from %g to %g", (double)low[fuller], (double)high[fuller]);
  assert_true(high[!fuller] <= 0.801f && low[!fuller] >= -0.801f);
}

static void test_framing(void **state) {
  (void)state;
  static const float boxes[][2][3] = {{{-1, -1, -1}, {1, 1, 1}},
                                      {{0, 0, 0}, {556, 559, 549}},
                                      {{1000, 0, 0}, {1001, 50, 0.5f}},
                                      {{-5, -0.1f, -5}, {5, 0, 5}},
                                      {{0, 0, 0}, {1, 3, 0}},
                                      {{-1e-6f, 0, 0}, {1e-6f, 1e-6f, 0}},
                                      {{-1e-24f, -1e-24f, 0}, {1e-24f, 1e-24f, 1e-24f}},
                                      {{0, 0, 0}, {1e-35f, 2e-35f, 0}}};
  static const float aspects[] = {0.5f, 1, 16 / 9.0f, 4}, ups[][3] = {{0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {2, 1, -1}};
  struct trax_scene_header header;
  struct trax_triangle triangles[8];
  struct trax_scene scene;
  struct trax_view view;
  for (size_t b = 0; b < sizeof boxes / sizeof boxes[0]; b++)
    for (size_t a = 0; a < sizeof aspects / sizeof aspects[0]; a++)
      for (size_t i = 0; i < sizeof ups / sizeof ups[0]; i++) {
        make_box(&scene, &header, triangles, boxes[b]);
        trax_view_frame(&view, &scene, ups[i], i == 1 ? 75 : 0, aspects[a]);
        check_framed(&view, &scene, aspects[a]);
        assert_true(view.fov == (i == 1 ? 75 : 40));
        double away = 0, size = 0; /* the light is two diagonals away */
        for (int axis = 0; axis < 3; axis++) {
          const double low = (double)boxes[b][0][axis], high = (double)boxes[b][1][axis];
          away += pow((double)view.light[axis] - (low + high) / 2, 2);
          size += pow(high - low, 2);
        }
        assert_true(fabs(sqrt(away / size) - 2) < 0.01);
      }
  /* A point has no size to fit. */
  static const float point[2][3] = {{3, 4, 5}, {3, 4, 5}};
  make_box(&scene, &header, triangles, point);
  trax_view_frame(&view, &scene, ups[0], 0, 1);
  check_frame_of_reference(&view);
  assert_true(view.eye[2] > 5);
}

/* Eye and light stand to a scene that is turned as they do to the scene. */
static void test_framing_upwards(void **state) {
  (void)state;
  static const float box[2][3] = {{-1, -2, -3}, {4, 5, 6}};
  static const struct {
    float up[3];
    int from[3], sign[3]; /* the axis of the scene with y upwards that has become x, y, z, and in which direction */
  } turns[] = {{{0, 3, 0}, {0, 1, 2}, {1, 1, 1}},
               {{0, 0, 1}, {0, 2, 1}, {1, -1, 1}},
               {{0, 0, -1}, {0, 2, 1}, {1, 1, -1}},
               {{1, 0, 0}, {1, 0, 2}, {1, -1, 1}},
               {{0, -1, 0}, {0, 1, 2}, {-1, -1, 1}}};
  struct trax_scene_header header;
  struct trax_triangle triangles[8];
  struct trax_scene scene;
  struct trax_view plain, turned;
  make_box(&scene, &header, triangles, box);
  trax_view_frame(&plain, &scene, turns[0].up, 0, 1.5f);
  for (size_t i = 0; i < sizeof turns / sizeof turns[0]; i++) {
    float other[2][3];
    for (int axis = 0; axis < 3; axis++)
      for (int side = 0; side < 2; side++)
        other[side][axis] = turns[i].sign[axis] * box[turns[i].sign[axis] < 0 ? !side : side][turns[i].from[axis]];
    make_box(&scene, &header, triangles, other);
    trax_view_frame(&turned, &scene, turns[i].up, 0, 1.5f);
    for (int axis = 0; axis < 3; axis++) {
      assert_true(fabsf(turned.eye[axis] - turns[i].sign[axis] * plain.eye[turns[i].from[axis]]) < 1e-4f);
      assert_true(fabsf(turned.light[axis] - turns[i].sign[axis] * plain.light[turns[i].from[axis]]) < 1e-4f);
      assert_true(fabsf(turned.up[axis] - turns[i].sign[axis] * plain.up[turns[i].from[axis]]) < 1e-5f);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_values),          cmocka_unit_test(test_lights),  cmocka_unit_test(test_errors),
      cmocka_unit_test(test_shipped_views),   cmocka_unit_test(test_framing), cmocka_unit_test(test_writing),
      cmocka_unit_test(test_framing_upwards), cmocka_unit_test(test_orbit),   cmocka_unit_test(test_aiming),
  };
  return cmocka_run_group_tests_name("views", tests, NULL, NULL);
}
