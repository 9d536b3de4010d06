/* The scene and the rays of a case, and what they are made of. */
#ifndef TRAX_EXTREME_SETUP_H
#define TRAX_EXTREME_SETUP_H

#include "../meshes.h"
#include "query.h"

#include <stdbool.h>
#include <stdint.h>

/* The result of make(), all of it zero before, but for the seed and the case's numbers. */
struct setup {
  const double *numbers;
  struct trax_mesh mesh;
  struct trax_scene premade; /* instead of the mesh */
  struct trax_build_options build;
  bool turned; /* the children of every node change places */
  struct query_ray *rays;
  uint32_t ray_count, ray_capacity;
  float light[3];
  struct trax_view view;  /* of cases with pictures: the rays are its pixels' */
  uint32_t width, height; /* 0: no picture */
  uint32_t seed;
};

void setup_release(struct setup *setup);

float any(struct setup *setup); /* in [-1, 1) */
uint32_t one_of(struct setup *setup, uint32_t count);

/* None if the direction is zero. */
void add_ray(struct setup *setup, const float origin[3], const float direction[3]);
void aim(struct setup *setup, const float from[3], const float at[3]);

/* A vertex, a point of an edge, or one inside, of a triangle by chance. */
void random_target(struct setup *setup, float at[3]);

/* Rays from within `radius` of `centre` along each axis, at targets on the mesh. */
void aim_from_within(struct setup *setup, const float centre[3], float radius, uint32_t rays);

void triangle_at(struct setup *setup, const float a[3], const float b[3], const float c[3]);

struct globe {
  float centre[3], radius, roughness;
};

/* A closed surface of 8 n^2 triangles, seen from whose centre each is in front of no other; with roughness the radius
   of each vertex varies by as much. */
void add_globe(struct setup *setup, int n, const struct globe *globe);

/* A room of 2 x 2 x 2 with boxes whose planes go on where others' end: a grid of 0.5. */
void add_blocks(struct setup *setup);

#endif
