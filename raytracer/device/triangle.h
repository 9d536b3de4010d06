/* Whether a ray hits a triangle. The method is chosen at compile time, -DTRAX_TRIANGLE=METHOD.

   TRAX_WATERTIGHT, the default: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection" (JCGT 2(1), 2013). Two
   triangles that share an edge compute the same value for it with opposite signs, and zero counts as inside, so a ray
   cannot pass between them.

   TRAX_MOLLER_TRUMBORE, to compare: "Fast, Minimum Storage Ray/Triangle Intersection" (Journal of Graphics Tools 2(1),
   1997). Two triangles round their common edge each in its own way.

   docs/robustness.md shows what each gets wrong and what it costs. */
#ifndef TRAX_DEVICE_TRIANGLE_H
#define TRAX_DEVICE_TRIANGLE_H

#include "algebra.h"
#include "bits.h"
#include "exact.h"
#include "nodes.h"
#include "run.h"
#include "trax/scene_format.h"

#include <stdbool.h>

#define TRAX_WATERTIGHT 1
#define TRAX_MOLLER_TRUMBORE 2
#ifndef TRAX_TRIANGLE
#define TRAX_TRIANGLE TRAX_WATERTIGHT
#endif

struct hit {
  int32_t distance_bits;  /* float_bits of the parameter along the ray */
  const char *triangle;   /* struct trax_triangle; NULL: nothing was hit */
  float weight1, weight2; /* barycentric, of v1 and v2 */
};

/* A smaller determinant is taken for zero, or its reciprocal might be infinite. It is twice the triangle's area as seen
   along the ray, in a scene that is 2^-4 wide at least (trax_normalise). */
#define LEAST_DETERMINANT_BITS 0x00800000 /* 2^-126 */

/* The ray is in the triangle: does it hit it before *hit? scaled is the distance times the determinant: the division
   waits until the hit is all but certain. edge1 and edge2 are the weights times the determinant. Of equal distances the
   one wins that comes_first: so the first comparison, whose product and reciprocal are within 3 units of 2^-24, must
   let pass what may turn out to be equal. */
#define UNITS_OF_DOUBT 4

/* An order of triangles that knows nothing of the tree: by the bits of their vertices, and only of those at one place
   by where they stand in the file. So neither the shape of the tree nor the order in which it is traversed shows in a
   picture, nor how often a triangle stands in it. Asked where two hits are equally far away: rarely. */
static inline bool comes_first(const char *triangle, const char *other) {
  const uint32_t *words = (const uint32_t *)(const void *)triangle, *others = (const uint32_t *)(const void *)other;
  KEEP_ROLLED
  for (int i = 0; i < 9; i++) {
    uint32_t word = words[i], other_word = others[i];
    if (word != other_word)
      return word < other_word;
  }
  return triangle < other;
}

static inline __attribute__((always_inline)) bool
accept_hit(const char *triangle, bool any, float scaled, float determinant, float edge1, float edge2, struct hit *hit) {
  int32_t size_bits = magnitude(determinant);
  int32_t scaled_bits = float_bits(scaled) ^ (float_bits(determinant) & SIGN_BIT);
  if (scaled_bits <= 0 ||
      scaled_bits > float_bits(bits_float(hit->distance_bits) * bits_float(size_bits)) + UNITS_OF_DOUBT)
    return false;
  if (!any) {
    float reciprocal = 1.0f / determinant;
    int32_t distance_bits = float_bits(scaled * reciprocal);
    if (distance_bits > hit->distance_bits ||
        (distance_bits == hit->distance_bits && (!hit->triangle || !comes_first(triangle, hit->triangle))))
      return false;
    hit->distance_bits = distance_bits;
    hit->triangle = triangle;
    hit->weight1 = edge1 * reciprocal;
    hit->weight2 = edge2 * reciprocal;
  }
  return true;
}

#if TRAX_TRIANGLE == TRAX_WATERTIGHT

/* Other programs of the TPs have no room for it. */
#if defined TRAX_EXACT_HITS || !defined __trax__
#define HAS_EXACT_RAY
#endif

/* Coordinates are renamed so that the direction's largest component is the third, and sheared and scaled so that the
   ray is the third axis. offset_ are the coordinates' places in a vertex, in bytes. */
struct triangle_ray {
  uint32_t offset_u, offset_v, offset_w;
  struct vector origin; /* renamed */
  float shear_u, shear_v, scale_w;
#ifdef HAS_EXACT_RAY
  struct exact_ray ray; /* as it is */
#endif
};

/* inverse: the reciprocals of the direction's components, of which only the largest one's is used. */
static inline void prepare_triangle_ray(struct triangle_ray *ray, struct vector origin, struct vector direction,
                                        struct vector inverse) {
  int32_t size = greatest_magnitude(direction);
#ifdef HAS_EXACT_RAY
  if (HITS_ARE_EXACT)
    ray->ray = (struct exact_ray){{origin.x, origin.y, origin.z}, {direction.x, direction.y, direction.z}};
#endif
  if (size == magnitude(direction.x)) {
    ray->offset_u = 4, ray->offset_v = 8, ray->offset_w = 0;
    ray->origin = (struct vector){origin.y, origin.z, origin.x};
    ray->shear_u = direction.y * inverse.x, ray->shear_v = direction.z * inverse.x, ray->scale_w = inverse.x;
  } else if (size == magnitude(direction.y)) {
    ray->offset_u = 8, ray->offset_v = 0, ray->offset_w = 4;
    ray->origin = (struct vector){origin.z, origin.x, origin.y};
    ray->shear_u = direction.z * inverse.y, ray->shear_v = direction.x * inverse.y, ray->scale_w = inverse.y;
  } else {
    ray->offset_u = 0, ray->offset_v = 4, ray->offset_w = 8;
    ray->origin = origin;
    ray->shear_u = direction.x * inverse.z, ray->shear_v = direction.y * inverse.z, ray->scale_w = inverse.z;
  }
}

/* A triangle's corner as seen from the ray's origin, renamed and sheared, but not scaled. */
static inline __attribute__((always_inline)) struct vector sheared_corner(const struct triangle_ray *ray,
                                                                          const char *triangle, int corner) {
  float w = load_float(triangle + ray->offset_w + 12 * corner) - ray->origin.z;
  float u = load_float(triangle + ray->offset_u + 12 * corner) - ray->origin.x - ray->shear_u * w;
  float v = load_float(triangle + ray->offset_v + 12 * corner) - ray->origin.y - ray->shear_v * w;
  return (struct vector){u, v, w};
}

/* Of edge values: not on the same side. Zeros of either sign are on both sides. */
static inline bool opposite(float a, float b) {
  uint32_t a_bits = (uint32_t)float_bits(a), b_bits = (uint32_t)float_bits(b);
  HIDE_ORIGIN(a_bits);
  HIDE_ORIGIN(b_bits);
  return (int32_t)(a_bits ^ b_bits) < 0 && a_bits << 1 != 0 && b_bits << 1 != 0;
}

#ifdef HAS_EXACT_RAY
/* May the ray hit the triangle? Only where two edge values are certain to be on different sides does it not. As the
   watertight test below, but with all lengths scaled by a power of two to less than 2, so that no product leaves the
   range of floats. In units of 2^-24, and with S, the greatest magnitude of a coordinate across the ray: the vertices
   as seen from the origin are off by 2, their product with the shear (6, from a reciprocal of error 5) by 16, so
   coordinates across the ray by 22, and edge values by 4 * 22 S + 2 * 22 * 22 * 2^-24 + 4 S S, where S is at most 4. */
static inline __attribute__((always_inline)) bool may_hit_triangle(const struct triangle_ray *ray,
                                                                   const char *triangle) {
  const char *at_u = triangle + ray->offset_u, *at_v = triangle + ray->offset_v, *at_w = triangle + ray->offset_w;
  float coordinate[9];
  int32_t size = 0, across = 0;
  for (int corner = 0; corner < 3; corner++) {
    float *place = coordinate + 3 * corner;
    place[0] = load_float(at_u + 12 * corner) - ray->origin.x;
    place[1] = load_float(at_v + 12 * corner) - ray->origin.y;
    place[2] = load_float(at_w + 12 * corner) - ray->origin.z;
    size = larger(size, larger(larger(magnitude(place[0]), magnitude(place[1])), magnitude(place[2])));
  }
  float scale = bits_float(0x7F000000 - (size & 0x7F800000));
  for (int corner = 0; corner < 3; corner++) {
    float *place = coordinate + 3 * corner;
    float w = place[2] * scale;
    place[0] = place[0] * scale - ray->shear_u * w;
    place[1] = place[1] * scale - ray->shear_v * w;
    across = larger(across, larger(magnitude(place[0]), magnitude(place[1])));
  }
  int32_t error = float_bits(bits_float(across) * 0x1p-17f + 0x1p-38f);
  uint32_t sides = 0; /* bit 0: an edge value is certainly positive; bit 1: one is certainly negative */
  for (int corner = 0; corner < 3; corner++) {
    const float *b = coordinate + 3 * ((corner + 1) % 3), *c = coordinate + 3 * ((corner + 2) % 3);
    float edge = c[0] * b[1] - c[1] * b[0];
    if (magnitude(edge) > error)
      sides |= 1u << ((uint32_t)float_bits(edge) >> 31);
  }
  return sides != 3;
}

/* As hit_triangle, without error. */
static inline __attribute__((always_inline)) bool
hit_triangle_exactly(const struct triangle_ray *ray, const char *triangle, bool any, struct hit *hit) {
  struct exact_result answer;
  struct exact_ray copy = ray->ray; /* whose address is taken, so that no other part of the ray must be in memory */
  if (!may_hit_triangle(ray, triangle) || !exact_hit(&copy, (const float *)(const void *)triangle, &answer))
    return false;
  int32_t distance_bits = float_bits(answer.distance);
  const char *other = hit->triangle;
  if (distance_bits > hit->distance_bits)
    return false;
  if (!any) {
    if (distance_bits == hit->distance_bits && (!other || !comes_first(triangle, other)))
      return false;
    *hit = (struct hit){distance_bits, triangle, answer.weight1, answer.weight2};
  }
  return true;
}
#else
#define hit_triangle_exactly(ray, triangle, any, hit) false
#endif

/* Is the triangle hit before hit->distance_bits? If so *hit becomes this one; if any hit will do, only the answer
   counts. */
static inline __attribute__((always_inline)) bool hit_triangle(const struct triangle_ray *ray, const char *triangle,
                                                               bool any, struct hit *hit) {
  if (HITS_ARE_EXACT)
    return hit_triangle_exactly(ray, triangle, any, hit);
  struct vector b = sheared_corner(ray, triangle, 1), c = sheared_corner(ray, triangle, 2);
  struct vector a = sheared_corner(ray, triangle, 0);
  float edge_a = c.x * b.y - c.y * b.x;
  float edge_b = a.x * c.y - a.y * c.x;
  if (opposite(edge_a, edge_b))
    return false;
  float edge_c = b.x * a.y - b.y * a.x;
  if (opposite(edge_a, edge_c) || opposite(edge_b, edge_c))
    return false;
  float determinant = edge_a + edge_b + edge_c;
  if (magnitude(determinant) < LEAST_DETERMINANT_BITS)
    return false;
  return accept_hit(triangle, any, (edge_a * a.z + edge_b * b.z + edge_c * c.z) * ray->scale_w, determinant, edge_b,
                    edge_c, hit);
}

#elif TRAX_TRIANGLE == TRAX_MOLLER_TRUMBORE

struct triangle_ray {
  struct vector origin, direction;
};

static inline void prepare_triangle_ray(struct triangle_ray *ray, struct vector origin, struct vector direction,
                                        struct vector inverse) {
  (void)inverse;
  *ray = (struct triangle_ray){origin, direction};
}

static inline __attribute__((always_inline)) bool hit_triangle(const struct triangle_ray *ray, const char *triangle,
                                                               bool any, struct hit *hit) {
  const float *v0 = (const float *)(const void *)triangle, *v1 = v0 + 3, *v2 = v0 + 6;
  struct vector a = load_vector(v0), f = minus(load_vector(v2), a), p = cross(ray->direction, f);
  struct vector e = minus(load_vector(v1), a);
  float determinant = dot(e, p);
  int32_t size_bits = magnitude(determinant), sign = float_bits(determinant) & SIGN_BIT;
  if (size_bits < LEAST_DETERMINANT_BITS)
    return false;
  struct vector s = minus(ray->origin, a);

  /* 0 <= u <= 1 and 0 <= v <= 1 - u, all times |determinant|; a zero of either sign is inside. */
  float u = bits_float(float_bits(dot(s, p)) ^ sign);
  if ((uint32_t)float_bits(u) > (uint32_t)SIGN_BIT || float_bits(u) > size_bits)
    return false;
  struct vector q = cross(s, e);
  float v = bits_float(float_bits(dot(ray->direction, q)) ^ sign);
  if ((uint32_t)float_bits(v) > (uint32_t)SIGN_BIT || float_bits(u + v) > size_bits)
    return false;
  return accept_hit(triangle, any, dot(f, q), determinant, bits_float(float_bits(u) ^ sign),
                    bits_float(float_bits(v) ^ sign), hit);
}

#else
#error "TRAX_TRIANGLE is none of the methods above"
#endif

#endif
