/* Rays as input and their results, as the program of trax-render --rays (device/rays.c) has them. Its buffers besides
   `scene` and `params`, whose slots are the rays:
     rays   a struct trax_input_ray for each ray
     hits   a struct trax_ray_hit for each ray, in the same order */
#ifndef TRAX_RAY_INPUT_H
#define TRAX_RAY_INPUT_H

#include <stdint.h>

struct trax_input_ray {
  float origin[3], direction[3]; /* the direction need not have unit length */
  float farthest;                /* limit of the distances of hits, in units of the direction */
  uint32_t kind;                 /* enum trax_ray_kind */
};

struct trax_ray_hit {
  uint32_t triangle;      /* the nearest: bytes from the start of the scene; 0: none */
  float distance;         /* in units of the direction */
  float weight1, weight2; /* barycentric, of the second and third corner */
};

/* The triangle of a ray that asked only whether there is one, if there is one. The scene's header is there. */
#define TRAX_ANY_TRIANGLE 1u

/* Rays in a row that threads of one TM take, as a power of two. */
#define TRAX_RAYS_LOG2_SIDE 3u

_Static_assert(sizeof(struct trax_input_ray) == 32 && sizeof(struct trax_ray_hit) == 16, "no padding");

#endif
