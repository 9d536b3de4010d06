/* Cases of light: shadows and whole pictures. */
#include "cases.h"

#include <math.h>
#include <string.h>

/* --- shadows --- */

/* Rays from around at a globe; the light low over its horizon: half of the points are within a degree of the border
   between day and night. numbers: each coordinate of the globe's middle. */
static void make_grazing_globe(struct setup *setup, uint32_t rays) {
  const float offset = (float)setup->numbers[0];
  add_globe(setup, 20, &(struct globe){{offset, offset, offset}, 1, 0});
  setup->light[0] = offset + 50, setup->light[1] = setup->light[2] = offset;
  for (uint32_t i = 0; i < rays; i++) {
    float normal[3] = {i & 1 ? 0.02f + 0.02f * any(setup) : random_unit(&setup->seed), any(setup), any(setup)};
    float length = sqrtf(normal[1] * normal[1] + normal[2] * normal[2]), from[3], at[3];
    if (length < 0.01f)
      continue;
    for (int axis = 0; axis < 3; axis++) {
      if (i & 1 && axis > 0)
        normal[axis] /= length;
      at[axis] = offset + 0.99f * normal[axis];
      from[axis] = offset + 3 * normal[axis] + 2 * any(setup);
    }
    if (i & 2) { /* seen as flatly as it is lit: from along the surface */
      float turn = any(setup) > 0 ? 3.0f : -3.0f;
      for (int axis = 0; axis < 3; axis++)
        at[axis] = offset + 0.999f * normal[axis];
      from[0] = at[0];
      from[1] = at[1] - turn * normal[2];
      from[2] = at[2] + turn * normal[1];
    }
    aim(setup, from, at);
  }
}

/* The eye looks from inside at edges and corners of a room, or close by. numbers: the light. */
static void make_corners(struct setup *setup, uint32_t rays) {
  for (int axis = 0; axis < 3; axis++)
    setup->light[axis] = (float)setup->numbers[axis];
  mesh_box(&setup->mesh, (float[]){-2, -1, -3}, (float[]){2, 1, 3}, 0);
  const float half[3] = {2, 1, 3};
  for (uint32_t i = 0; i < rays; i++) {
    float from[3], at[3];
    for (int axis = 0; axis < 3; axis++) {
      from[axis] = 0.9f * half[axis] * any(setup);
      at[axis] = half[axis] * (i >> axis & 1 ? 1.0f : -1.0f);
    }
    uint32_t free = i % 3; /* along this edge; every sixth into the corner */
    if (i % 6 != 0)
      at[free] = half[free] * any(setup);
    if (i & 8) /* beside it */
      at[(free + 1) % 3] *= 1 - exp2f(-10 - 14 * random_unit(&setup->seed));
    aim(setup, from, at);
  }
}

/* A needle of width 2^-149 that shadow rays pass behind the light. A needle has a point before the light, too, so no
   box rejects it. Its determinants have so few bits that UNITS_OF_DOUBT are a multiple of them. All rays are in the
   plane y = 0, and the ground is symmetric about it: only there does a ray meet the needle. */
static void make_needle_behind_light(struct setup *setup, uint32_t rays) {
  triangle_at(setup, (float[]){-8, 0, 0}, (float[]){8, 8, 0}, (float[]){8, -8, 0});
  triangle_at(setup, (float[]){-1, 0, 1.9f}, (float[]){1, 0, 4}, (float[]){-1, 0x1p-149f, 1.9f});
  for (uint32_t i = 0; i < rays; i++)
    add_ray(setup, (float[]){0.5f * any(setup), 0, 1}, (float[]){0, 0, -1});
  setup->light[2] = 2;
}

/* --- pictures: the rays are those of the pixels --- */

static void picture(struct setup *setup, uint32_t width, uint32_t height, struct trax_view view) {
  setup->view = view;
  setup->width = width, setup->height = height;
  memcpy(setup->light, view.light, sizeof setup->light);
}

static void make_picture_empty(struct setup *setup, uint32_t rays) {
  (void)rays;
  picture(setup, 24, 16, view_from(0, 0, 0, 0, 0, -1, 60, 0, 1, 0));
}

static void room(struct setup *setup, uint32_t width, uint32_t height) {
  add_blocks(setup);
  picture(setup, width, height, view_from(-0.7f, 0.6f, 0.8f, 0.6f, -0.6f, -1, 70, 0.3f, 0.8f, 0.7f));
}

/* numbers: width and height. */
static void make_picture_room(struct setup *setup, uint32_t rays) {
  (void)rays;
  room(setup, (uint32_t)setup->numbers[0], (uint32_t)setup->numbers[1]);
}

static void make_picture_hardware(struct setup *setup, uint32_t rays) {
  room(setup, 24, rays < 1000 ? 8 : 16);
}

/* The room at 10^7, where floats are a unit apart: it is 128 of them wide. */
static void make_picture_offset(struct setup *setup, uint32_t rays) {
  (void)rays;
  add_blocks(setup);
  mesh_transform(&setup->mesh, 64, 1e7f, -1e7f, 1e7f);
  picture(setup, 48, 36,
          view_from(1e7f - 45, -1e7f + 38, 1e7f + 51, 0.6f, -0.6f, -1, 70, 1e7f + 19, -1e7f + 51, 1e7f + 45));
}

/* Pictures are so many times smaller in the short form of the suite. */
static uint32_t part_of(uint32_t rays) {
  return rays < 1000 ? 3 : 1;
}

static void make_picture_within(struct setup *setup, uint32_t rays) {
  add_globe(setup, 6, &(struct globe){{0, 0, 0}, 1, 0});
  add_globe(setup, 6, &(struct globe){{0, 0, 0}, 0x1p-20f, 0}); /* the eye is in it, on a plane of its box */
  picture(setup, 48 / part_of(rays), 32 / part_of(rays), view_from(0, 0, 0, 1, 1, -1, 100, 0, 0.1f, 0));
}

static void make_picture_on_vertex(struct setup *setup, uint32_t rays) {
  add_globe(setup, 6, &(struct globe){{0, 0, 0}, 1, 0});
  mesh_box(&setup->mesh, (float[]){-0.5f, -0.5f, -0.5f}, (float[]){0, 0, 0}, 0);
  picture(setup, 48 / part_of(rays), 32 / part_of(rays), view_from(0, 0, 0, 1, 0, 0, 120, 0, 0.4f, 0));
}

const struct extreme_case picture_cases[] = {
    {"grazing-shadows", "a globe of 3,200 triangles in grazing light", BY(make_grazing_globe), CASE_SHADOWS},
    {"grazing-shadows-away", "the same, 1000 radii from the origin", BY(make_grazing_globe, 1000), CASE_SHADOWS},
    {"corners-dark", "edges and corners of a room, light outside", BY(make_corners, 5, 4, 7),
     CASE_CLOSED | CASE_SHADOWS},
    {"corners-lit", "edges and corners of a room, light inside", BY(make_corners, 0.3, 0.4, -0.2),
     CASE_CLOSED | CASE_SHADOWS},
    {"light-on-surface", "the light on a corner of the room", BY(make_corners, 2, 1, 3), CASE_CLOSED | CASE_SHADOWS},
    {"needle-behind-light", "a triangle of width 2^-149 behind the light", BY(make_needle_behind_light), CASE_SHADOWS},
    {"picture-empty", "a picture of nothing", BY(make_picture_empty), 0},
    {"picture-1x1", "one pixel", BY(make_picture_room, 1, 1), CASE_CLOSED},
    {"picture-1xN", "1 x 333 pixels", BY(make_picture_room, 1, 333), CASE_CLOSED},
    {"picture-Nx1", "333 x 1 pixels", BY(make_picture_room, 333, 1), CASE_CLOSED},
    {"picture-few", "15 pixels, more threads", BY(make_picture_room, 5, 3), CASE_CLOSED},
    {"picture-hardware", "saturated hardware, 12 machines", BY(make_picture_hardware), CASE_CLOSED | CASE_HARDWARE},
    {"picture-offset", "a room of 128 at 10^7 from the origin", BY(make_picture_offset),
     CASE_CLOSED | CASE_BELOW_ROUNDING},
    {"eye-within", "the eye inside of geometry", BY(make_picture_within), CASE_CLOSED},
    {"eye-on-vertex", "the eye on a vertex", BY(make_picture_on_vertex), CASE_CLOSED},
};
const unsigned picture_case_count = sizeof picture_cases / sizeof *picture_cases;
