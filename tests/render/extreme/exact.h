/* Hits of rays in exact rational arithmetic, and whether an answer in binary32 is right, or wrong by no more than
   rounding explains. */
#ifndef TRAX_EXTREME_EXACT_H
#define TRAX_EXTREME_EXACT_H

#include "query.h"
#include "trax/scene.h"

#include <stdbool.h>
#include <stddef.h>

/* The place of an instance's mesh: the point p is at matrix (p, 1). */
struct exact_place {
  float matrix[3][4];
  double inverse[3][3]; /* rounded, of the first three columns */
  double spread;        /* the further bound on where shadow rays start, by the distance (docs/instances.md) */
};

struct exact_triangle {
  float vertex[3][3];
  const struct exact_place *place; /* NULL: the vertices are in the scene */
};

/* Sets both arrays, which the caller frees. Returns how many triangles there are: with instances those of each, in the
   order of the file. */
uint32_t exact_triangles(struct exact_triangle **triangles, struct exact_place **places,
                         const struct trax_scene *scene);

/* The number of the triangle that was hit among these, and that in the meshes as they were imported; -1: none. */
int64_t exact_number(const struct trax_scene *scene, const struct query_answer *answer);
int64_t exact_source(const struct trax_scene *scene, const struct query_answer *answer);

/* Everything in the scene's own unit of length; the program worked on it scaled by 2^exponent (trax_normalise). */
struct exact_scene {
  const struct exact_triangle *triangles;
  uint32_t count;
  int exponent;
  float light[3];
};

/* An answer about a ray. With a light both rays are judged. */
struct exact_answer {
  int64_t triangle; /* -1: none */
  float distance;   /* of the parameter along the direction times 2^direction_exponent, in the scaled scene */
  int direction_exponent;
  enum query_light light;
  float origin[3]; /* of the shadow ray, in the scaled scene */
  bool exact;      /* of exact hits: what is hit is no matter of rounding */
};

/* Counts of rays. */
struct exact_tally {
  uint64_t judged;
  uint64_t hits;        /* that hit something exactly: a closed triangle, in front of the origin */
  uint64_t missed;      /* hit something and the answer is: nothing */
  uint64_t wrong;       /* another triangle than the nearest one, or one where there is none */
  uint64_t unexplained; /* of both, those that the error bound of the watertight test does not cover, or, of exact
                           hits, all but those that are another triangle 2^-21 of the distance behind the nearest */
  uint64_t lit;         /* whose nearest hit sees the light exactly */
  uint64_t leaks;       /* lit in the answer though something is in between, or the light is behind the triangle */
  uint64_t acne;        /* not lit in the answer though they see the light */
  uint64_t unexplained_lights; /* of leaks and acne, those that would not be right of where the shadow ray started */
  double worst_ulp;            /* of the distance, in units of the last place, where the triangle is right */
};

/* Judges several answers about one ray, each counted in its own tally. */
void exact_judge(struct exact_tally *tallies, const struct exact_scene *scene, const struct query_ray *ray,
                 const struct exact_answer *answers, unsigned count);

#endif
