/* Rays for the device program's own traversal, by the thousand: query.c is compiled for the TP and, once for each
   method of the triangle test, for the host. Buffers of the program: scene, params (struct query_params), rays,
   answers. */
#ifndef TRAX_EXTREME_QUERY_H
#define TRAX_EXTREME_QUERY_H

#include "trax/render_params.h"

#include <stdint.h>

struct query_ray {
  float origin[3], direction[3]; /* of any length but 0 */
};

struct query_params {
  uint32_t count;
  uint32_t shadows; /* 1: a second ray from what was hit to the light */
  float box_margin; /* as in struct trax_render_params */
  float light[3];
  uint32_t node_layout; /* these two, too */
  struct trax_ray_grid grid;
};

enum query_light { QUERY_NOT_ASKED, QUERY_BEHIND, QUERY_SHADOWED, QUERY_LIT };

struct query_answer {
  uint32_t triangle;      /* its offset in the scene file; 0: nothing was hit */
  uint32_t instance;      /* that of its instance; 0: the scene has none */
  uint32_t distance_bits; /* of the parameter along the direction times direction_scale (ray.h) */
  float weight1, weight2;
  uint32_t light;  /* enum query_light */
  float origin[3]; /* where the shadow ray started */
};

/* Answers answers[first .. last - 1] on the host. */
typedef void query_function(const void *scene, const struct query_params *params, const struct query_ray *rays,
                            struct query_answer *answers, uint32_t first, uint32_t last);
query_function query_exact, query_watertight, query_moller_trumbore, query_instances, query_instances_moller_trumbore;

#endif
