/* Cases at the ends of binary32: large faces near the eye, tiny things in huge scenes, both at once, moved and turned.
 */
#include "cases.h"

#include <math.h>
#include <string.h>

/* --- moved and turned --- */

static void turn(float point[3]) {
  static const double matrix[3][3] = {{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}};
  const double old[3] = {(double)point[0], (double)point[1], (double)point[2]};
  for (int i = 0; i < 3; i++)
    point[i] = (float)(matrix[i][0] * old[0] + matrix[i][1] * old[1] + matrix[i][2] * old[2]);
}

static void turn_and_move(struct setup *setup, const float by[3]) {
  for (uint32_t i = 0; i < setup->mesh.vertex_count; i++) {
    turn(setup->mesh.vertices[i]);
    for (int axis = 0; axis < 3; axis++)
      setup->mesh.vertices[i][axis] += by[axis];
  }
  for (uint32_t i = 0; i < setup->ray_count; i++) {
    turn(setup->rays[i].origin);
    turn(setup->rays[i].direction);
    for (int axis = 0; axis < 3; axis++)
      setup->rays[i].origin[axis] += by[axis];
  }
}

/* --- large faces --- */

/* Rays start within half a unit of 0 and go in all directions, most of them close to the horizon. */
static void look_around(struct setup *setup, uint32_t rays, float size) {
  for (uint32_t i = 0; i < rays; i++) {
    float from[3] = {0.5f * size * any(setup), 0.5f * size * any(setup), 0.5f * size * any(setup)};
    float direction[3] = {any(setup), any(setup), any(setup)};
    if (i & 3)
      direction[1] *= exp2f(-20 * random_unit(&setup->seed));
    if (i % 16 == 0)
      from[0] = from[1] = from[2] = 0;
    add_ray(setup, from, direction);
  }
}

/* A room from -L to L whose floor is near. numbers: L, and how far below the eye the floor is. */
static void make_room(struct setup *setup, uint32_t rays) {
  const float length = (float)setup->numbers[0], height = (float)setup->numbers[1];
  mesh_box(&setup->mesh, (float[]){-length, -height, -length}, (float[]){length, length, length}, 0);
  look_around(setup, rays, height);
}

static void make_room_turned(struct setup *setup, uint32_t rays) {
  make_room(setup, rays);
  turn_and_move(setup, (float[]){1e3f, -2e3f, 3e3f});
}

static void make_ground(struct setup *setup, uint32_t rays) {
  const float far = 1e8f, corner[4][3] = {{-far, 0, -far}, {far, 0, -far}, {far, 0, far}, {-far, 0, far}};
  triangle_at(setup, corner[0], corner[1], corner[2]);
  triangle_at(setup, corner[0], corner[2], corner[3]);
  for (uint32_t i = 0; i < rays; i++) {
    float from[3] = {any(setup), 1.7f, any(setup)};
    add_ray(setup, from, (float[]){any(setup), -exp2f(-24 * random_unit(&setup->seed)), any(setup)});
  }
}

/* The eye is so near the plane of a ground that in binary32 it might be on either side. */
static void make_oblique(struct setup *setup, uint32_t rays) {
  float p[3] = {8.1234567e8f, -3.3456789e8f, 5.7777777e8f}, q[3] = {-2.2345678e8f, 7.6543211e8f, 6.1357911e8f},
        from_p[3], from_q[3];
  for (int axis = 0; axis < 3; axis++)
    from_p[axis] = -p[axis], from_q[axis] = -q[axis];
  triangle_at(setup, q, p, from_p);
  triangle_at(setup, from_q, from_p, p);
  for (uint32_t i = 0; i < rays; i++) {
    float from[3] = {any(setup), any(setup), any(setup)}, at[3];
    const float far = exp2f(-32 * random_unit(&setup->seed)), across = far * any(setup);
    for (int axis = 0; axis < 3; axis++)
      at[axis] = far * (i & 1 ? q : from_q)[axis] + across * p[axis];
    aim(setup, from, at);
  }
  setup->light[0] = 3, setup->light[1] = 4, setup->light[2] = 2;
}

/* --- tiny things --- */

/* One beside the other, none within another or the floor: where surfaces cross, no ray starts between them. */
static void rocks(struct setup *setup, float distance, float size, float height) {
  for (int i = 0; i < 6; i++) {
    const float column = 0.4f * (float)i - 1, row = 0.2f * (float)i - 2;
    add_globe(setup, 2, &(struct globe){{distance * column, height, distance * row}, size, 0.2f});
  }
}

/* Rays aim at vertices, edges and faces of the first triangles. */
static void aim_at_first(struct setup *setup, uint32_t rays, uint32_t triangles, float radius) {
  const uint32_t all = setup->mesh.triangle_count;
  for (uint32_t i = 0; i < rays; i++) {
    float from[3] = {radius * any(setup), radius * random_unit(&setup->seed), radius * any(setup)}, at[3];
    setup->mesh.triangle_count = i & 7 ? triangles : all;
    random_target(setup, at);
    aim(setup, from, at);
  }
  setup->mesh.triangle_count = all;
}

/* numbers: the globe's radius, and the size of a rock. */
static void make_tiny(struct setup *setup, uint32_t rays) {
  const float radius = (float)setup->numbers[0], size = (float)setup->numbers[1];
  rocks(setup, 8 * size, size, 0);
  const uint32_t first = setup->mesh.triangle_count;
  mesh_box(&setup->mesh, (float[]){-size, -size, -4 * size}, (float[]){0, 0, -3 * size}, 0);
  add_globe(setup, 3, &(struct globe){{0, 0, 0}, radius, 0.1f});
  aim_at_first(setup, rays, first, size);
}

static void make_tiny_turned(struct setup *setup, uint32_t rays) {
  make_tiny(setup, rays);
  turn_and_move(setup, (float[]){1e-3f, -2e-3f, 3e-3f});
}

/* --- both, with light --- */

/* Rocks of a hundredth around the eye, on a floor that is 2 below it and 1e9 wide. */
static void make_both(struct setup *setup, uint32_t rays) {
  rocks(setup, 4, 0.01f, -1.95f);
  const uint32_t first = setup->mesh.triangle_count;
  mesh_box(&setup->mesh, (float[]){-1e9f, -2, -1e9f}, (float[]){1e9f, 1e9f, 1e9f}, 0);
  aim_at_first(setup, rays, first, 1);
  setup->light[0] = 3, setup->light[1] = 4, setup->light[2] = 2;
}

static void make_both_turned(struct setup *setup, uint32_t rays) {
  rocks(setup, 400, 4, -490);
  const uint32_t first = setup->mesh.triangle_count;
  mesh_box(&setup->mesh, (float[]){-1e9f, -500, -1e9f}, (float[]){1e9f, 1e9f, 1e9f}, 0);
  aim_at_first(setup, rays, first, 100);
  turn_and_move(setup, (float[]){1e3f, -2e3f, 3e3f});
  setup->light[0] = 1300, setup->light[1] = -1800, setup->light[2] = 3200;
}

/* The shadow of a step so low that only rays from close to the floor meet the step. */
static void make_low_step(struct setup *setup, uint32_t rays) {
  mesh_box(&setup->mesh, (float[]){0, -2, -1}, (float[]){1, -1.9998f, 1}, 0);
  mesh_box(&setup->mesh, (float[]){-1e9f, -2, -1e9f}, (float[]){1e9f, 1e9f, 1e9f}, 0);
  for (uint32_t i = 0; i < rays; i++) {
    const float from[3] = {any(setup), random_unit(&setup->seed), any(setup)};
    aim(setup, from, (float[]){-4e-5f + 2e-5f * any(setup), -2, 0.5f * any(setup)});
  }
  setup->light[0] = 3, setup->light[1] = 4, setup->light[2] = 2;
}

/* Rays to rocks that end at the light: 2^-60 of the scene away from it. */
static void make_tiny_lit(struct setup *setup, uint32_t rays) {
  make_tiny(setup, rays);
  setup->light[0] = 0.002f, setup->light[1] = 0.004f, setup->light[2] = 0.001f;
}

/* --- a picture --- */

/* Small in the short form of the suite: with exact hits the emulated machine takes long. */
static void make_picture_both(struct setup *setup, uint32_t rays) {
  mesh_box(&setup->mesh, (float[]){-1, -2, -4}, (float[]){0.2f, -0.9f, -3}, 0);
  mesh_box(&setup->mesh, (float[]){0.3f, -2, -3.5f}, (float[]){1, -0.3f, -2.5f}, 0);
  mesh_box(&setup->mesh, (float[]){-1e17f, -2, -1e17f}, (float[]){1e17f, 1e17f, 1e17f}, 0);
  setup->view = view_from(0, 0, 0, 0, -0.3f, -1, 60, 3, 4, 2);
  const uint32_t part = rays < 1000 ? 3 : 1;
  setup->width = 40 / part, setup->height = 30 / part;
  memcpy(setup->light, setup->view.light, sizeof setup->light);
}

const struct extreme_case range_cases[] = {
    {"room-3e7", "a room of 3e7 whose floor is 2 below the eye", BY(make_room, 3e7, 2),
     CASE_CLOSED | CASE_BEYOND_BINARY32},
    {"room-1e9", "the same of 1e9", BY(make_room, 1e9, 2), CASE_CLOSED | CASE_BEYOND_BINARY32},
    {"room-1e18", "the same of 1.7e18, the floor 0.001 below", BY(make_room, 1.7e18, 1e-3),
     CASE_CLOSED | CASE_BEYOND_BINARY32},
    {"room-turned", "a room of 1e9, moved and turned", BY(make_room_turned, 1e9, 500),
     CASE_CLOSED | CASE_BEYOND_BINARY32},
    {"ground", "two triangles of 1e8, 1.7 below the eye", BY(make_ground), CASE_BEYOND_BINARY32},
    {"oblique", "a ground of 1e9, the eye within 2 of it", BY(make_oblique),
     CASE_SHADOWS | CASE_BEYOND_BINARY32 | CASE_BELOW_OFFSET},
    {"tiny-1e16", "rocks of 1 in a globe of 1e16", BY(make_tiny, 1e16, 1), CASE_CLOSED},
    {"tiny-1e18", "rocks of 1e-9 in a globe of 1.5e18", BY(make_tiny, 1.5e18, 1e-9),
     CASE_CLOSED | CASE_BEYOND_BINARY32},
    {"tiny-turned", "rocks of 1e-6 in a globe of 1e17, moved and turned", BY(make_tiny_turned, 1e17, 1e-6),
     CASE_CLOSED | CASE_BEYOND_BINARY32},
    {"both", "rocks of 0.01 on a floor of 1e9", BY(make_both),
     CASE_CLOSED | CASE_SHADOWS | CASE_BEYOND_BINARY32 | CASE_BELOW_OFFSET},
    {"both-turned", "rocks of 4 on a floor of 1e9, moved and turned", BY(make_both_turned),
     CASE_CLOSED | CASE_SHADOWS | CASE_BEYOND_BINARY32 | CASE_BELOW_OFFSET},
    {"low-step", "the shadow of a step of 0.0002 on a floor of 1e9", BY(make_low_step), CASE_CLOSED | CASE_SHADOWS},
    {"tiny-lit", "rocks of 0.001 and a light in a globe of 1e17", BY(make_tiny_lit, 1e17, 1e-3),
     CASE_CLOSED | CASE_SHADOWS},
    {"picture-both", "boxes of 1 on a floor of 1e17", BY(make_picture_both), CASE_CLOSED | CASE_BEYOND_BINARY32},
};
const unsigned range_case_count = sizeof range_cases / sizeof *range_cases;
