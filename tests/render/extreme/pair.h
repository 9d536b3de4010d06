/* A ray and a triangle, in exact arithmetic. */
#ifndef TRAX_EXTREME_PAIR_H
#define TRAX_EXTREME_PAIR_H

#include "exact.h"

#include <gmp.h>

/* A ray and a triangle, relative to the ray's origin: volume[i] is det(direction, next, previous vertex), which is the
   edge value opposite to vertex i times a common factor; their sum is the determinant. */
struct exact_pair {
  mpz_t vertex[3][3], direction[3], volume[3], determinant, product, sum, factor;
  mpq_t distance; /* along the direction; set if the determinant is not zero */
};

void exact_pair_init(struct exact_pair *pair);
void exact_pair_clear(struct exact_pair *pair);

/* value = number * 2^EXACT_BITS: exact for every finite binary32 number, and for a product of two. */
#define EXACT_BITS 298
void exact_set_float(mpz_t value, float number);
/* Sets a coordinate of a triangle's corner, in the scene. */
void exact_set_corner(struct exact_pair *pair, mpz_t value, const struct exact_triangle *triangle, int corner,
                      int axis);

enum side { OUTSIDE, HIT, BEHIND_ORIGIN, NO_AREA };

/* Evaluates pair->direction and pair->vertex. The distance is that of the triangle's plane, inside or not. */
enum side exact_evaluate(struct exact_pair *pair);
enum side exact_evaluate_ray(struct exact_pair *pair, const struct query_ray *ray,
                             const struct exact_triangle *triangle);

typedef double triple[3];

/* The corner in binary64, off by 2^-50 of the greatest summand at most, which is returned. */
double exact_corner(triple out, const struct exact_triangle *triangle, int corner);

/* A ray from origin, of which each coordinate is off by at most `off`, cannot hit the triangle. */
bool surely_outside(const triple origin, const triple direction, double off, const struct exact_triangle *triangle);

#define NO_TRIANGLE UINT32_MAX

/* Does the point at `distance` along the ray, on the triangle `own`, see scene->light from the side of the ray's
   origin? Of a point on an edge, what the points of `own` near by do. */
bool exact_sees_light(struct exact_pair *pair, const struct exact_scene *scene, const struct query_ray *ray,
                      uint32_t own, const mpq_t distance);

/* Does rounding explain that a point that sees the light, or does not, was said to be the other? See lights.c. */
bool exact_light_explained(struct exact_pair *pair, const struct exact_scene *scene, const struct query_ray *ray,
                           const struct exact_answer *answer, const mpq_t distance);

#endif
