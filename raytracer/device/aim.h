/* The direction from a surface to a light, and the normal of an emitting triangle. */
#ifndef TRAX_DEVICE_AIM_H
#define TRAX_DEVICE_AIM_H

#include "algebra.h"
#include "shade.h"

/* The shadow ray ends this far before the light, in units of the distance's last place: rounding may put a surface that
   holds the light in front of it. */
#define LIGHT_SLACK 64

struct light {
  struct vector direction; /* unit length */
  int32_t distance_bits;
  int32_t cosine_bits; /* of the angle to the normal; not positive: the light is behind the surface */
};

/* The cosine is that at the ray's start. path.h renders pictures in which the difference would show
   (TRAX_FEATURE_NEAR_LIGHT). */
static inline void aim_at_light(struct light *light, const struct surface *surface, const float *position) {
  struct vector way = minus(load_vector(position), surface->start);
  float square = dot(way, way);
  float inverse = trax_rsqrt(square);
  float cosine = dot(surface->normal, way) * surface->inverse_length * inverse;
  light->direction = times(inverse, way);
  light->distance_bits = float_bits(square * inverse) - LIGHT_SLACK;
  /* A light within 2^-40 of the point has no usable direction. */
  light->cosine_bits = float_bits(square) >= float_bits(0x1p-80f) ? float_bits(cosine) : 0;
}

/* The light that reaches a point if nothing blocks it. */
struct arrival {
  struct vector direction; /* towards the light, unit length */
  int32_t distance_bits;   /* the shadow ray's length; FARTHEST_BITS: unlimited */
  struct vector target;
  struct vector radiance; /* reflected by a white surface that faces the light */
  float pdf;              /* of an emitter: pi times that in solid angle; else 0 */
};

#define FARTHEST_BITS 0x7F000000 /* 2^127, farther than anything in a scene that frame.c accepts */

/* Sets direction, distance and target. Returns 1 / square of the distance; 0, with nothing set, if the target is too
   near to have a direction. */
static inline float aim_at(struct arrival *arrival, struct vector from, struct vector to) {
  struct vector way = minus(to, from);
  float square = dot(way, way);
  if (float_bits(square) < float_bits(0x1p-80f))
    return 0;
  float inverse = trax_rsqrt(square);
  arrival->direction = times(inverse, way);
  arrival->distance_bits = float_bits(square * inverse) - LIGHT_SLACK;
  arrival->target = to;
  return inverse * inverse;
}

/* A unit normal on either side; 0 if the triangle has no area. */
static inline struct vector triangle_normal(const float *v) {
  struct vector a = load_vector(v), e = minus(load_vector(v + 3), a), f = minus(load_vector(v + 6), a);
  struct vector n = cross(e, f);
  int32_t size = larger(larger(magnitude(n.x), magnitude(n.y)), magnitude(n.z));
  if (size == 0)
    return (struct vector){0, 0, 0};
  return unit(times(bits_float(0x7E800000 - (size & 0x7F800000)), n));
}

#endif
