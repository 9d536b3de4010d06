/* Closed rooms, and cameras within them. */
#include "meshes.h"
#include "room.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* A box whose fronts are inside, as those of mesh_box, or outside. */
static void add_box(struct trax_mesh *mesh, const float low[3], const float high[3], bool inside) {
  const uint32_t first = mesh->triangle_count;
  mesh_box(mesh, low, high, 0);
  for (uint32_t i = first; !inside && i < mesh->triangle_count; i++) {
    const uint32_t corner = mesh->triangles[i].vertices[1];
    mesh->triangles[i].vertices[1] = mesh->triangles[i].vertices[2];
    mesh->triangles[i].vertices[2] = corner;
  }
}

/* The mesh is released. */
static bool look(struct trax_view *view, struct trax_mesh *mesh, const float up[3]) {
  struct trax_scene scene = scene_of(mesh, NULL);
  trax_error error;
  bool inside;
  trax_view_frame(view, &scene, up, 0, 1.5f);
  const struct trax_view framed = *view;
  if (trax_view_room(view, &inside, &scene, up, 1.5f, &error) != TRAX_OK)
    fail_msg("%s", error.message);
  if (!inside)
    assert_memory_equal(view, &framed, sizeof framed);
  struct trax_view again = framed;
  bool inside_again;
  assert_int_equal(trax_view_room(&again, &inside_again, &scene, up, 1.5f, &error), TRAX_OK);
  assert_memory_equal(&again, view, sizeof again); /* the same every time */
  trax_scene_release(&scene);
  return inside;
}

static const float y[3] = {0, 1, 0}, z[3] = {0, 0, 1};

/* A long hall: the eye is near one end of it in the lower half, looks along it, and the light is in it, higher up. */
static void test_hall(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  struct trax_view view;
  const float low[3] = {-20, 0, -3}, high[3] = {20, 8, 3}, table_low[3] = {-2, 0, -1}, table_high[3] = {2, 1, 1};
  mesh_material(&mesh, 1, 1, 1);
  add_box(&mesh, low, high, true);
  add_box(&mesh, table_low, table_high, false);
  assert_true(look(&view, &mesh, y));
  assert_true(fabsf(view.eye[0]) > 10 && fabsf(view.eye[0]) < 20 && fabsf(view.eye[2]) < 3);
  assert_true(view.eye[1] > 0 && view.eye[1] <= 4.01f);
  assert_true(view.direction[0] * view.eye[0] < 0 && fabsf(view.direction[0]) > 0.9f);
  assert_true(view.up[1] == 1 && view.fov == 60);
  for (int axis = 0; axis < 3; axis++)
    assert_true(view.light[axis] > low[axis] && view.light[axis] < high[axis]);
  assert_true(view.light[1] > view.eye[1]);
}

/* The room with z upwards. */
static void test_hall_upwards(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  struct trax_view view;
  const float low[3] = {-3, -20, 0}, high[3] = {3, 20, 8};
  mesh_material(&mesh, 1, 1, 1);
  add_box(&mesh, low, high, true);
  assert_true(look(&view, &mesh, z));
  assert_true(fabsf(view.eye[1]) > 10 && view.eye[2] <= 4.01f && view.direction[1] * view.eye[1] < 0);
  assert_true(view.up[2] == 1);
}

/* An eye within a solid object sees backs; one where a wall is missing sees much of the sphere. */
static void test_no_room(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  struct trax_view view;
  const float low[3] = {-1, -1, -1}, high[3] = {1, 1, 1};
  mesh_material(&mesh, 1, 1, 1);
  add_box(&mesh, low, high, false);
  assert_false(look(&view, &mesh, y));
  mesh_material(&mesh, 1, 1, 1);
  add_box(&mesh, low, high, true);
  mesh.triangle_count -= 4; /* two of its walls */
  assert_false(look(&view, &mesh, y));
}

/* A view that comes with trax is of no use for another mesh of the same name. */
static void test_shown(void **state) {
  (void)state;
  struct trax_mesh mesh = {0};
  trax_error error;
  bool shows;
  mesh_sphere(&mesh, 1, 3, mesh_material(&mesh, 1, 1, 1));
  struct trax_scene scene = scene_of(&mesh, NULL);
  struct trax_view view = view_from(0, 0, 4, 0, 0, -1, 40, 0, 5, 5);
  assert_int_equal(trax_view_shows(&shows, &view, &scene, 1.5f, &error), TRAX_OK);
  assert_true(shows);
  view.eye[2] = 40;
  assert_int_equal(trax_view_shows(&shows, &view, &scene, 1.5f, &error), TRAX_OK);
  assert_false(shows);
  trax_scene_release(&scene);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_hall), cmocka_unit_test(test_hall_upwards),
                                     cmocka_unit_test(test_no_room), cmocka_unit_test(test_shown)};
  return cmocka_run_group_tests_name("rooms", tests, NULL, NULL);
}
