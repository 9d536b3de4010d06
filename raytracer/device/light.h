/* Where the light comes from: points, directions and rectangles that the view has, and triangles that emit. */
#ifndef TRAX_DEVICE_LIGHT_H
#define TRAX_DEVICE_LIGHT_H

#include "algebra.h"
#include "material.h"
#include "run.h"
#include "sampler.h"
#include "shade.h"

#include <stdbool.h>

/* What reaches a point from a light, if nothing is in the way. */
struct arrival {
  struct vector direction; /* towards the light, unit length */
  int32_t distance_bits;   /* how far the shadow ray goes: FARTHEST_BITS, or up to */
  struct vector target;
  struct vector radiance; /* what a white surface that faces the light sends back */
  float density;          /* of an emitter: pi times that in solid angle with which the direction was taken; else 0 */
};

/* From 0 to what is as good as infinite; what is no number stays so, to be seen. */
static inline float bounded(float value) {
  return magnitude(value) > 0x7F800000 ? value : at_most(at_least(value, 0), TRAX_MAX_RADIANCE);
}

static inline struct vector bounded_colour(struct vector colour) {
  return (struct vector){bounded(colour.x), bounded(colour.y), bounded(colour.z)};
}

#define FARTHEST_BITS 0x7F000000 /* 2^127, farther than anything in a scene that frame.c accepts */

/* The way to a point; returns 1 / square of its distance, or 0, and changes nothing, if it is too near to have a
   direction. */
static inline float aim_at(struct arrival *arrival, struct vector from, struct vector to) {
  struct vector way = minus(to, from);
  if (HITS_ARE_EXACT) {
    int32_t exponent;
    way = scale_way(way, &exponent);
    if (exponent == 0)
      return 0;
    float square = dot(way, way), inverse = trax_rsqrt(square), scaled = inverse * bits_float(0x7F000000 - exponent);
    arrival->direction = times(inverse, way);
    arrival->distance_bits = float_bits(square * inverse * bits_float(exponent)) - LIGHT_SLACK;
    arrival->target = to;
    return at_most(scaled * scaled, 0x1p80f);
  }
  float square = dot(way, way);
  if (float_bits(square) < float_bits(0x1p-80f))
    return 0;
  float inverse = trax_rsqrt(square);
  arrival->direction = times(inverse, way);
  arrival->distance_bits = float_bits(square * inverse) - LIGHT_SLACK;
  arrival->target = to;
  return inverse * inverse;
}

/* False: nothing arrives. place chooses a point of the light. */
static inline bool light_arrives(struct arrival *arrival, const struct trax_device_light *light, struct vector point,
                                 struct place place) {
  struct vector target = load_vector(light->place);
  arrival->density = 0;
  arrival->radiance = load_vector(light->radiance);
  if (light->kind == TRAX_FROM_DIRECTION) {
    arrival->direction = arrival->target = target;
    arrival->distance_bits = FARTHEST_BITS;
    return true;
  }
  bool rectangle = light->kind == TRAX_FROM_RECTANGLE;
  if (rectangle)
    target =
        plus(target, plus(times(place.x, load_vector(light->edge[0])), times(place.y, load_vector(light->edge[1]))));
  float falloff = aim_at(arrival, point, target);
  if (float_bits(falloff) == 0)
    return false;
  if (rectangle) {
    float cosine = -dot(load_vector(light->normal), arrival->direction);
    if (float_bits(cosine) <= 0)
      return false;
    falloff *= cosine;
  }
  if (light->kind != TRAX_FROM_POINT)
    arrival->radiance = bounded_colour(times(falloff, arrival->radiance));
  return true;
}

/* Of the triangle's two sides; not towards the origin. */
static inline struct vector triangle_normal(const float *v) {
  struct vector a = load_vector(v), e = minus(load_vector(v + 3), a), f = minus(load_vector(v + 6), a);
  if (HITS_ARE_EXACT) {
    float scale = bits_float(0x7F000000 - (larger(greatest_magnitude(e), greatest_magnitude(f)) & 0x7F800000));
    e = times(scale, e), f = times(scale, f);
  }
  struct vector n = cross(e, f);
  int32_t size = larger(larger(magnitude(n.x), magnitude(n.y)), magnitude(n.z));
  if (size == 0)
    return (struct vector){0, 0, 0};
  return unit(times(bits_float(0x7E800000 - (size & 0x7F800000)), n));
}

/* pi times the density in solid angle of a point of an emitter at a distance's square, seen at a cosine; choices: how
   many the shadow ray was chosen from. */
static inline float emitter_density(float per_area, float square, float cosine, float choices) {
  return bounded(3.14159265f * per_area * square / at_least(choices * cosine, 0x1p-40f));
}

/* A point of one of the emitters: pick chooses which, place where on it. */
static inline bool emitter_arrives(struct arrival *arrival, bool one_sided, const struct trax_path_params *path,
                                   uint32_t pick, struct vector point, struct place place) {
  const struct trax_emitter *emitters = path_table(path->emitters);
  uint32_t low = 0, high = path->emitter_count; /* the last whose predecessors have no more than pick */
  while (high - low > 1) {
    uint32_t middle = (low + high) >> 1;
    if (emitters[middle].cumulative <= pick)
      low = middle;
    else
      high = middle;
  }
  const char *triangle = (const char *)scene.data + emitters[low].triangle;
  const float *v = (const float *)(const void *)triangle;
  const struct trax_device_material *materials = path_table(path->materials);
  const struct trax_device_material *material = &materials[triangle_material(triangle)];
  struct vector a = load_vector(v), e = minus(load_vector(v + 3), a), f = minus(load_vector(v + 6), a);
  float side = root(place.x);
  struct vector target = plus(a, plus(times(side * (1 - place.y), e), times(side * place.y, f)));
  float falloff = aim_at(arrival, point, target);
  if (float_bits(falloff) == 0)
    return false;
  float facing = -dot(triangle_normal(v), arrival->direction), cosine = bits_float(magnitude(facing));
  if (float_bits(cosine) < float_bits(0x1p-20f) ||
      (one_sided && float_bits(facing) < 0 && material->kind != TRAX_MATERIAL_GLASS))
    return false;
  arrival->density = emitter_density(material->emitter_density, 1 / falloff, cosine, (float)(int32_t)path->choices);
  arrival->radiance = load_vector(material->emission);
  return true;
}

#endif
