/* Hits without error, for scenes in which binary32 cannot tell (TRAX_FEATURE_EXACT). A program that includes this file
   first has its functions in place of those of triangle.h, shade.h and aim.h; no other file knows of it but main.c.

   Edge values, determinant and distance are sums of products of three floats. Each product is added, as an integer, to
   an accumulator as wide as all products (U. Kulisch, "Computer Arithmetic and Validity", 2008), so that signs are
   certain and a quotient is rounded once. */
#ifndef TRAX_DEVICE_EXACT_H
#define TRAX_DEVICE_EXACT_H

#include "aim.h"
#include "bits.h"
#include "run.h"
#include "shade.h"
#include "triangle.h"

#include <stdbool.h>
#include <stdint.h>

/* Whether hits are exact. Always so in a program of the TPs that includes this file; the twin has both kinds. */
#ifdef TRAX_EXACT_HITS
#define HITS_ARE_EXACT TRAX_EXACT_HITS
#else
#define HITS_ARE_EXACT NEEDS((const struct trax_render_params *)params.data, EXACT)
#endif

/* --- sums of products --- */

/* The unit is 2^-447, the product of three of the least floats. trax_normalise keeps all factors below
   2^33. Then the sum of 36 products has less than 32 * EXACT_WORDS bits. */
#define EXACT_WORDS 18

/* Functions of their own: they run rarely, and the traversal's registers stay free. */
#define EXACT_STEP static __attribute__((noinline, unused))

struct exact_ray {
  float origin[3], direction[3];
};

/* value * 2^exponent. A power of two that all sums have in common is left out. */
struct exact_value {
  float value;
  int32_t exponent;
};

/* A float's significand as an integer. */
static inline uint32_t digits_of(uint32_t bits) {
  return (bits & 0x7FFFFFu) | (bits & 0x7F800000u ? 0x800000u : 0);
}

/* The exponent of its last bit, less that of 2^-149. */
static inline uint32_t weight_of(uint32_t bits) {
  uint32_t exponent = bits >> 23 & 255;
  return exponent ? exponent - 1 : 0;
}

/* *sum += a b c, or -= if the sign bit of `sign` is set. */
static inline void add_product(uint32_t *sum, uint32_t a, uint32_t b, uint32_t c, uint32_t sign) {
  uint32_t place = weight_of(a) + weight_of(b) + weight_of(c), shift = place & 31;
  uint64_t ab = (uint64_t)digits_of(a) * digits_of(b);
  uint64_t low = (ab & 0xFFFFFFFFu) * digits_of(c), high = (ab >> 32) * digits_of(c) + (low >> 32);
  uint32_t word[3] = {(uint32_t)low, (uint32_t)high, (uint32_t)(high >> 32)};
  /* Two's complement: a subtraction inverts all bits and adds 1. */
  uint32_t turned = (uint32_t)((int32_t)(a ^ b ^ c ^ sign) >> 31), carry = turned & 1, below = 0;
  uint32_t *at = sum + (place >> 5), *end = sum + EXACT_WORDS;
  for (int i = 0; i < 4; i++) {
    uint32_t part = below;
    if (i < 3)
      part |= word[i] << shift, below = word[i] >> 1 >> (31 - shift);
    uint32_t old = *at, added = old + (part ^ turned), both = added + carry;
    carry = (added < old) | (both < added);
    *at++ = both;
  }
  KEEP_ROLLED
  for (; at != end && carry != (turned & 1); at++) {
    uint32_t both = *at + turned + carry;
    carry = turned ? *at != 0 : both == 0;
    *at = both;
  }
}

/* The sum of det(x, p, q), det(x, q, r) and det(x, r, p), or of the last of them alone. */
EXACT_STEP void add_determinants(uint32_t *sum, const float *x, const float *p, const float *q, const float *r,
                                 bool last_alone, uint32_t sign) {
  const float *corner[4] = {p, q, r, p};
  for (int i = last_alone ? 2 : 0; i < 3; i++) {
    const float *y = corner[i], *z = corner[i + 1];
    KEEP_ROLLED
    for (uint32_t term = 0; term < 6; term++) {
      uint32_t first = term >> 1, odd = term & 1, second = first + 1 + odd, third = first + 2 - odd;
      second -= second > 2 ? 3 : 0, third -= third > 2 ? 3 : 0;
      add_product(sum, (uint32_t)float_bits(x[first]), (uint32_t)float_bits(y[second]), (uint32_t)float_bits(z[third]),
                  sign ^ odd << 31);
    }
  }
}

/* The sum, rounded to a relative error of 2^-24. Sets *sum to 0. */
EXACT_STEP struct exact_value take_sum(uint32_t *sum) {
  uint32_t negative = (uint32_t)((int32_t)sum[EXACT_WORDS - 1] >> 31), carry = negative & 1, high = 0, low = 0;
  int32_t top = 0;
  KEEP_ROLLED
  for (int32_t i = 0; i < EXACT_WORDS; i++) {
    uint32_t word = (sum[i] ^ negative) + carry;
    carry &= word == 0;
    sum[i] = 0;
    if (word)
      low = top == i - 1 ? high : 0, high = word, top = i;
  }
  if (high == 0)
    return (struct exact_value){0, 0};
  int32_t zeros = __builtin_clz(high);
  uint32_t bits = high << zeros | low >> 1 >> (31 - zeros);
  float value = (float)(int32_t)(bits >> 1);
  return (struct exact_value){bits_float(float_bits(value) | (int32_t)(negative & 0x80000000u)), 32 * top - zeros};
}

/* a / b; 0 if that is negligible beside 1. */
static inline float exact_quotient(struct exact_value a, struct exact_value b) {
  int32_t exponent = a.exponent - b.exponent;
  exponent = exponent < -252 ? -252 : exponent > 252 ? 252 : exponent;
  int32_t half = exponent >> 1;
  return a.value / b.value * bits_float((127 + half) << 23) * bits_float((127 + exponent - half) << 23);
}

static inline bool exactly_opposite(struct exact_value a, struct exact_value b) {
  return (float_bits(a.value) ^ float_bits(b.value)) < 0 && magnitude(a.value) != 0 && magnitude(b.value) != 0;
}

struct exact_result {
  float distance, weight1, weight2;
};

/* Edges and vertices belong to the triangle. A triangle whose plane holds the ray is not hit, nor one at distance 0. */
EXACT_STEP bool exact_hit(const struct exact_ray *ray, const float *a, struct exact_result *answer) {
  const float *b = a + 3, *c = a + 6, *origin = ray->origin, *direction = ray->direction;
  uint32_t sum[EXACT_WORDS] = {0};
  add_determinants(sum, direction, c, b, origin, false, 0);
  struct exact_value edge_a = take_sum(sum);
  add_determinants(sum, direction, a, c, origin, false, 0);
  struct exact_value edge_b = take_sum(sum);
  if (exactly_opposite(edge_a, edge_b))
    return false;
  add_determinants(sum, direction, b, a, origin, false, 0);
  struct exact_value edge_c = take_sum(sum);
  if (exactly_opposite(edge_a, edge_c) || exactly_opposite(edge_b, edge_c))
    return false;
  add_determinants(sum, direction, b, a, c, false, 0);
  struct exact_value determinant = take_sum(sum);
  add_determinants(sum, a, b, a, c, true, 0);
  add_determinants(sum, origin, b, a, c, false, 0x80000000u);
  struct exact_value scaled = take_sum(sum);
  if (magnitude(determinant.value) == 0 || magnitude(scaled.value) == 0 || exactly_opposite(scaled, determinant))
    return false;
  answer->distance = bits_float(larger(float_bits(exact_quotient(scaled, determinant)), 1));
  answer->weight1 = exact_quotient(edge_b, determinant);
  answer->weight2 = exact_quotient(edge_c, determinant);
  return true;
}

/* Whether the ray sees v0, v1, v2 clockwise, as a sign bit. */
EXACT_STEP int32_t exactly_turned(const float *direction, const float *a) {
  uint32_t sum[EXACT_WORDS] = {0};
  add_determinants(sum, direction, a + 3, a, a + 6, false, 0);
  return float_bits(take_sum(sum).value) & SIGN_BIT;
}

/* --- the ray and the triangle --- */

struct exact_triangle_ray {
  struct triangle_ray sheared;
  struct exact_ray ray;
};

static inline void prepare_exact_triangle_ray(struct exact_triangle_ray *ray, struct vector origin,
                                              struct vector direction, struct vector inverse) {
  if (HITS_ARE_EXACT)
    ray->ray = (struct exact_ray){{origin.x, origin.y, origin.z}, {direction.x, direction.y, direction.z}};
  prepare_triangle_ray(&ray->sheared, origin, direction, inverse);
}

/* False if two edge values certainly have different signs, so that the ray misses the triangle. This is the watertight
   test with all lengths scaled by a power of two to less than 2, so that no product leaves the range of floats. The
   errors, in units of 2^-24, where S is the greatest magnitude of a coordinate across the ray: 2 of the vertices as
   seen from the origin, 16 of their products with the shear (6, from a reciprocal of error 5), hence 22 of coordinates
   across the ray, and 4 * 22 S + 2 * 22 * 22 * 2^-24 + 4 S S of edge values, where S is at most 4. */
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

/* The exact form of hit_triangle. */
static inline __attribute__((always_inline)) bool
hit_triangle_exactly(const struct exact_triangle_ray *ray, const char *triangle, bool any, struct hit *hit) {
  if (!HITS_ARE_EXACT)
    return hit_triangle(&ray->sheared, triangle, any, hit);
  struct exact_result answer;
  struct exact_ray copy = ray->ray; /* whose address is taken, so that no other part of the ray must be in memory */
  if (!may_hit_triangle(&ray->sheared, triangle) || !exact_hit(&copy, (const float *)(const void *)triangle, &answer))
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

/* --- the surface and the light --- */

/* The exact form of find_surface. Edges are scaled by a power of two, so that the normal stays in the range of floats.
   The viewer's side of it is found without error. The point comes from the vertices or from the ray, whichever has the
   smaller error bound: along the ray that is 6u R + u O a coordinate, where R is the greatest component of the way from
   the eye, and O that of the eye. The shadow ray's test has no error of its own. */
#define OFFSET_PER_WAY 0x1p-19f

static inline __attribute__((always_inline)) void find_surface_exactly(struct surface *surface, const struct hit *hit,
                                                                       struct vector eye, struct vector direction) {
  if (!HITS_ARE_EXACT) {
    find_surface(surface, hit, eye, direction);
    return;
  }
  const float *v0 = (const float *)(const void *)hit->triangle, *v1 = v0 + 3, *v2 = v0 + 6;
  struct vector a = load_vector(v0), e = minus(load_vector(v1), a), f = minus(load_vector(v2), a);
  int32_t edge = larger(greatest_magnitude(e), greatest_magnitude(f));
  float edge_scale = bits_float(0x7F000000 - (edge & 0x7F800000));
  struct vector n = cross(times(edge_scale, e), times(edge_scale, f));
  int32_t away = exactly_turned(&direction.x, v0), size = greatest_magnitude(n);
  if (size == 0) {
    n = direction;
    away = SIGN_BIT;
    size = greatest_magnitude(n);
  }
  n = times(bits_float((0x7E800000 - (size & 0x7F800000)) | away), n);

  struct vector way = times(bits_float(hit->distance_bits), direction);
  float bound = bits_float(greatest_magnitude(a)) * OFFSET_PER_POSITION + bits_float(edge) * OFFSET_PER_EDGE;
  float way_bound =
      bits_float(greatest_magnitude(eye)) * OFFSET_PER_POSITION + bits_float(greatest_magnitude(way)) * OFFSET_PER_WAY;
  struct vector base = a, inside = plus(times(hit->weight1, e), times(hit->weight2, f));
  if (float_bits(way_bound) < float_bits(bound))
    bound = way_bound, base = eye, inside = way;
  surface->inverse_length = trax_rsqrt(dot(n, n));
  struct vector out = times(bound * surface->inverse_length, n);
  int32_t depth = greatest_magnitude(way) & 0x7F800000;
  struct vector back = times(at_most(bits_float(0x7E800000 - depth) * bound, 1), way);
  surface->point = plus(base, inside);
  surface->start = plus(base, plus(inside, minus(out, back)));
  surface->behind = plus(base, minus(inside, out));
  surface->turned = away != 0;
  surface->normal = n;
}

/* Scales by a power of two to less than 2. `exponent` receives the bits of the power's reciprocal, 0 if the way is too
   short to have a direction. */
static inline struct vector scale_way(struct vector way, int32_t *exponent) {
  *exponent = greatest_magnitude(way) & 0x7F800000;
  return times(bits_float(0x7F000000 - *exponent), way);
}

static inline void aim_at_light_exactly(struct light *light, const struct surface *surface, const float *position) {
  if (!HITS_ARE_EXACT) {
    aim_at_light(light, surface, position);
    return;
  }
  int32_t exponent;
  struct vector way = scale_way(minus(load_vector(position), surface->start), &exponent);
  float square = dot(way, way), inverse = trax_rsqrt(square);
  float cosine = dot(surface->normal, way) * surface->inverse_length * inverse;
  light->direction = times(inverse, way);
  light->distance_bits = float_bits(square * inverse * bits_float(exponent)) - LIGHT_SLACK;
  light->cosine_bits = exponent ? float_bits(cosine) : 0;
}

static inline float aim_exactly(struct arrival *arrival, struct vector from, struct vector to) {
  if (!HITS_ARE_EXACT)
    return aim_at(arrival, from, to);
  int32_t exponent;
  struct vector way = scale_way(minus(to, from), &exponent);
  if (exponent == 0)
    return 0;
  float square = dot(way, way), inverse = trax_rsqrt(square), scaled = inverse * bits_float(0x7F000000 - exponent);
  arrival->direction = times(inverse, way);
  arrival->distance_bits = float_bits(square * inverse * bits_float(exponent)) - LIGHT_SLACK;
  arrival->target = to;
  return at_most(scaled * scaled, 0x1p80f);
}

/* The normal, from edges scaled by a power of two: that of a small triangle would vanish. */
static inline struct vector exact_triangle_normal(const float *v) {
  if (!HITS_ARE_EXACT)
    return triangle_normal(v);
  struct vector a = load_vector(v), e = minus(load_vector(v + 3), a), f = minus(load_vector(v + 6), a);
  float scale = bits_float(0x7F000000 - (larger(greatest_magnitude(e), greatest_magnitude(f)) & 0x7F800000));
  e = times(scale, e), f = times(scale, f);
  const float scaled[9] = {0, 0, 0, e.x, e.y, e.z, f.x, f.y, f.z};
  return triangle_normal(scaled);
}

/* --- these replace the plain functions from here on --- */

#define triangle_ray exact_triangle_ray
#define prepare_triangle_ray prepare_exact_triangle_ray
#define hit_triangle hit_triangle_exactly
#define find_surface find_surface_exactly
#define aim_at_light aim_at_light_exactly
#define aim_at aim_exactly
#define triangle_normal exact_triangle_normal

#endif
