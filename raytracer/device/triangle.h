/* Whether a ray hits a triangle: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection" (JCGT 2(1), 2013). Two
   triangles that share an edge compute the same value for it with opposite signs, and zero counts as inside, so a ray
   cannot pass between them. docs/robustness.md shows the errors and the cost. */
#ifndef TRAX_DEVICE_TRIANGLE_H
#define TRAX_DEVICE_TRIANGLE_H

#include "algebra.h"
#include "bits.h"
#include "nodes.h"
#include "run.h"
#include "trax/scene_format.h"

#include <stdbool.h>

#if TRAX_INSTANCES
#include "placed.h"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers" /* the members of instances are 0 elsewhere */
#endif

struct hit {
  int32_t distance_bits;  /* float_bits of the parameter along the ray */
  const char *triangle;   /* struct trax_triangle; NULL: nothing was hit */
  float weight1, weight2; /* barycentric, of v1 and v2 */
#if TRAX_INSTANCES
  const char *instance; /* struct trax_instance, of the triangle; NULL: the scene has none */
  const char *visiting; /* that in whose mesh the ray is; NULL: it is in the tree over instances */
#endif
};

/* A smaller determinant counts as zero, because its reciprocal might be infinite. The determinant is twice the
   triangle's area as seen along the ray, in a scene that is at least 2^-4 wide (trax_normalise). */
#define LEAST_DETERMINANT_BITS 0x00800000 /* 2^-126 */

/* Whether a ray that passes through the triangle hits it before *hit. scaled is the distance times the determinant: the
   division waits until the hit is nearly certain. edge1 and edge2 are the weights times the determinant. Of equal
   distances the triangle that comes_first wins. So the first comparison, whose product and reciprocal are within 3
   units of 2^-24, must admit distances that may be equal. */
#define UNITS_OF_DOUBT 4

/* An order of triangles that does not depend on the tree: by the bits of their vertices, and for equal vertices by
   their order in the file. So a picture does not depend on the shape of the tree, on the order of traversal, or on how
   often a triangle is in the tree. Rarely called: when two hits are equally far away. */
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

/* Whether the triangle comes before the one that was hit. */
static inline __attribute__((always_inline)) bool comes_before(const char *triangle, const struct hit *hit) {
#if TRAX_INSTANCES
  if (HAS_INSTANCES)
    return placed_first(triangle, hit->visiting, hit->triangle, hit->instance);
#endif
  return comes_first(triangle, hit->triangle);
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
        (distance_bits == hit->distance_bits && (!hit->triangle || !comes_before(triangle, hit))))
      return false;
    hit->distance_bits = distance_bits;
    hit->triangle = triangle;
#if TRAX_INSTANCES
    hit->instance = hit->visiting;
#endif
    hit->weight1 = edge1 * reciprocal;
    hit->weight2 = edge2 * reciprocal;
  }
  return true;
}

/* Coordinates are renamed so that the direction's largest component is the third, and sheared and scaled so that the
   ray is the third axis. offset_ are the coordinates' places in a vertex, in bytes. */
struct triangle_ray {
  uint32_t offset_u, offset_v, offset_w;
  struct vector origin; /* renamed */
  float shear_u, shear_v, scale_w;
};

/* inverse: the reciprocals of the direction's components. Only that of the largest component is used. */
static inline void prepare_triangle_ray(struct triangle_ray *ray, struct vector origin, struct vector direction,
                                        struct vector inverse) {
  int32_t size = greatest_magnitude(direction);
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

/* Whether two edge values are on opposite sides. Zeros of either sign are on both sides. */
static inline bool opposite(float a, float b) {
  uint32_t a_bits = (uint32_t)float_bits(a), b_bits = (uint32_t)float_bits(b);
  HIDE_ORIGIN(a_bits);
  HIDE_ORIGIN(b_bits);
  return (int32_t)(a_bits ^ b_bits) < 0 && a_bits << 1 != 0 && b_bits << 1 != 0;
}

/* Whether the triangle is hit before hit->distance_bits. If so, *hit becomes this hit; if any hit suffices, only the
   answer counts. */
static inline __attribute__((always_inline)) bool hit_triangle(const struct triangle_ray *ray, const char *triangle,
                                                               bool any, struct hit *hit) {
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

#endif
