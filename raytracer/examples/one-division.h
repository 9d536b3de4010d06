/* The parts of step 3 that later steps keep: the triangle's test by products, and one division a ray. A step defines
   triangle_record, a structure with corners v0, v1 and v2, before it includes this file. */
#ifndef TRAX_EXAMPLES_ONE_DIVISION_H
#define TRAX_EXAMPLES_ONE_DIVISION_H

#include "picture.h"

#define UNITS_OF_DOUBT 2 /* units of the last place by which the rounded product and quotient may differ */

struct hit {
  float distance;
  const triangle_record *triangle; /* NULL: nothing was hit */
};

/* Moeller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection" (Journal of Graphics Tools 2(1), 1997), for
   both sides. Distances times the determinant are compared, so only a nearer hit takes a division, and an any-hit ray
   takes none. */
static inline bool hit_triangle(const struct vector *origin, const struct vector *direction,
                                const triangle_record *triangle, bool any, struct hit *hit) {
  struct vector corner = load(triangle->v0);
  struct vector edge1 = subtract(load(triangle->v1), corner), edge2 = subtract(load(triangle->v2), corner);
  struct vector p = cross(*direction, edge2);
  float determinant = dot(edge1, p);
  int sign = bits(determinant) & SIGN_BIT, size = bits(determinant) ^ sign; /* what is below is times the sign */
  struct vector t = subtract(*origin, corner);
  float u = dot(t, p);
  int u_bits = bits(u) ^ sign;
  struct vector q = cross(t, edge1);
  float v = dot(*direction, q);
  int v_bits = bits(v) ^ sign, sum_bits = bits(u + v) ^ sign;
  if (size == 0 || (unsigned)u_bits > (unsigned)SIGN_BIT || u_bits > size || (unsigned)v_bits > (unsigned)SIGN_BIT ||
      sum_bits > size) /* a zero of either sign is inside */
    return false;
  float scaled = dot(edge2, q);
  int scaled_bits = bits(scaled) ^ sign;
  if (scaled_bits <= 0 || scaled_bits > bits(hit->distance * value(size)) + UNITS_OF_DOUBT)
    return false;
  if (!any) {
    float distance = scaled / determinant;
    if (bits(distance) >= bits(hit->distance))
      return false;
    hit->distance = distance;
    hit->triangle = triangle;
  }
  return true;
}

/* A direction that is turned by 2^-30 enters the same boxes. */
static inline float away_from_zero(float component) {
  int sign = bits(component) & SIGN_BIT;
  return value(larger(bits(component) ^ sign, bits(0x1p-30f)) | sign);
}

#endif
