/* The surface that a ray hit, and its colour. */
#ifndef TRAX_DEVICE_SHADE_H
#define TRAX_DEVICE_SHADE_H

#include "algebra.h"
#include "bits.h"
#include "camera.h"
#include "record.h"
#include "trax/scene_format.h"
#include "triangle.h"

#include <trax.h>

struct surface {
  struct vector point;  /* the hit; light arrives here */
  struct vector start;  /* off the surface; rays that leave on the viewer's side start here */
  struct vector normal; /* towards the viewer; its largest component at most 1 */
  float inverse_length; /* of the normal */
  struct vector behind; /* where a ray that goes on through the surface starts */
  bool turned;          /* the viewer sees v0, v1, v2 clockwise */
};

/* The shadow ray's origin is moved along the normal so far that rounding cannot put it behind its own triangle: by a
   bound on all errors off the triangle's plane, in terms of M, the greatest magnitude among v0's coordinates, and E,
   that among the edges' components. With u = 2^-24:
   - the point relative to v0, a sum of the edges (errors of the weights lie in the plane): 5u E a coordinate;
   - the point itself: u M a coordinate;
   - the shadow ray's test of the same triangle: vertices, at most 2E from the point, are off by at most 14u 2E across
   the ray (see frame.c) and the distance along it by 12u 2E. As displacements off the plane these sum to less than
   sqrt(3) (5u E + u M) + 52u E < 61u E + 2u M. The double leaves room for the normal's own error. */
#define OFFSET_PER_EDGE 0x1p-17f
#define OFFSET_PER_POSITION 0x1p-22f

#if TRAX_INSTANCES
/* The further bound of an instance's triangle, which grows with its distance from the instance's origin
   (docs/instances.md). */
static inline float bound_of_place(const struct hit *hit, struct vector a, int32_t edge) {
  if (!hit->instance)
    return 0;
  const struct trax_instance *instance = instance_at(hit->instance);
  const int32_t away = greatest_magnitude(minus(a, load_vector(instance->origin)));
  return instance->spread * (bits_float(away) + bits_float(edge));
}
#endif

static inline __attribute__((always_inline)) void find_surface(struct surface *surface, const struct hit *hit,
                                                               struct vector eye, struct vector direction) {
  (void)direction; /* exact.h needs it */
  const float *v0 = (const float *)(const void *)hit->triangle, *v1 = v0 + 3, *v2 = v0 + 6;
  struct vector a = load_vector(v0), e = minus(load_vector(v1), a), f = minus(load_vector(v2), a), n = cross(e, f);

  /* Scaled by a power of two to at most 1, so that no square below leaves the range of floats; then turned towards the
     viewer. A needle's normal may round to zero. */
  struct vector sight = minus(a, eye);
  int32_t size = greatest_magnitude(n);
  if (size == 0) {
    n = sight;
    size = greatest_magnitude(n);
  }
  int32_t away = ~float_bits(dot(n, sight)) & SIGN_BIT;
  n = times(bits_float((0x7E800000 - (size & 0x7F800000)) | away), n);

  int32_t edge = larger(greatest_magnitude(e), greatest_magnitude(f));
  float inverse_length = trax_rsqrt(dot(n, n));
  float bound = bits_float(greatest_magnitude(a)) * OFFSET_PER_POSITION + bits_float(edge) * OFFSET_PER_EDGE;
#if TRAX_INSTANCES
  bound += bound_of_place(hit, a, edge);
#endif
  struct vector out = times(bound * inverse_length, n);

  /* The start is also half as far back along the line of sight, but not beyond the eye. Nothing is in between, so
     this is away from every near surface. In a corner, the normal alone may lead along another wall, or into it. */
  struct vector inside = plus(times(hit->weight1, e), times(hit->weight2, f));
  sight = plus(sight, inside);
  int32_t far = greatest_magnitude(sight) & 0x7F800000;
  struct vector back = times(at_most(bits_float(0x7E800000 - far) * bound, 1), sight);
  surface->point = plus(a, inside);
  surface->start = plus(a, plus(inside, minus(out, back)));
  surface->behind = plus(a, minus(inside, out));
  surface->turned = away != 0;
  surface->normal = n;
  surface->inverse_length = inverse_length;
}

/* The interpolated normal of the vertices, in the mesh. */
static inline __attribute__((always_inline)) struct vector stored_normal(const struct hit *hit,
                                                                         uint32_t normals_distance) {
  const float *n0 = (const float *)(const void *)(hit->triangle + normals_distance), *n1 = n0 + 3, *n2 = n0 + 6;
  struct vector first = load_vector(n0);
  return plus(first, plus(times(hit->weight1, minus(load_vector(n1), first)),
                          times(hit->weight2, minus(load_vector(n2), first))));
}

/* Replaces the normal by the smooth one, on the same side of the triangle. */
static inline __attribute__((always_inline)) void set_smooth_normal(struct surface *surface, struct vector n) {
  int32_t side = float_bits(dot(n, surface->normal)) & SIGN_BIT;
  n = (struct vector){bits_float(float_bits(n.x) ^ side), bits_float(float_bits(n.y) ^ side),
                      bits_float(float_bits(n.z) ^ side)};
  surface->normal = n;
  surface->inverse_length = trax_rsqrt(bits_float(larger(float_bits(dot(n, n)), float_bits(0x1p-40f))));
}

static inline __attribute__((always_inline)) void smooth_surface(struct surface *surface, const struct hit *hit,
                                                                 uint32_t normals_distance) {
  set_smooth_normal(surface, stored_normal(hit, normals_distance));
}

static inline uint32_t triangle_material(const char *triangle) {
  return load_word(triangle + 36);
}

static inline uint32_t material_of_hit(const struct hit *hit) {
  return triangle_material(hit->triangle);
}

/* The ambient light that the surface reflects; with that of the point light at most 1. */
static inline float ambient_light(const struct trax_render_params *frame, const struct surface *surface) {
  return frame->ambient + dot(surface->normal, load_vector(frame->fill)) * surface->inverse_length;
}

/* The square root; 2^-20 for numbers near 0 and below, which rounds to the pixel value 0. */
static inline float root_of_light(float light) {
  light = bits_float(larger(float_bits(light), float_bits(0x1p-40f)));
  return light * trax_rsqrt(light);
}

static inline uint32_t pixel_of(float red, float green, float blue) {
  RECORD_CHANNELS(red, green, blue);
  return (uint32_t)(int32_t)(red + 0.5f) | (uint32_t)(int32_t)(green + 0.5f) << 8 |
         (uint32_t)(int32_t)(blue + 0.5f) << 16 | 0xFF000000u;
}

/* Gamma 2: the palette has the square roots of the colours. */
static inline uint32_t shade(const float *colour, float light) {
  float root = root_of_light(light);
  return pixel_of(colour[0] * root, colour[1] * root, colour[2] * root);
}

/* --- several samples: sums of squared pixel values, which are linear in the light --- */

static inline void add_light(struct vector *sum, const float *colour, float light) {
  sum->x += colour[0] * colour[0] * light;
  sum->y += colour[1] * colour[1] * light;
  sum->z += colour[2] * colour[2] * light;
}

static inline float squared_byte(uint32_t value) {
  float number = (float)(int32_t)(value & 255);
  return number * number;
}

static inline void add_pixel(struct vector *sum, uint32_t pixel) {
  sum->x += squared_byte(pixel);
  sum->y += squared_byte(pixel >> 8);
  sum->z += squared_byte(pixel >> 16);
}

static inline uint32_t mean_pixel(const struct vector *sum, float weight) {
  return pixel_of(root_of_light(sum->x * weight), root_of_light(sum->y * weight), root_of_light(sum->z * weight));
}

#endif
