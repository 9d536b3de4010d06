/* Sampling of lights: points, directions and rectangles of the view, and emitting triangles. */
#ifndef TRAX_DEVICE_LIGHT_H
#define TRAX_DEVICE_LIGHT_H

#include "aim.h"
#include "algebra.h"
#include "material.h"
#include "run.h"
#include "sampler.h"

#include <stdbool.h>

/* Clamps to 0 and TRAX_MAX_RADIANCE. A NaN stays a NaN, so that it shows. */
static inline float bounded(float value) {
  return magnitude(value) > 0x7F800000 ? value : at_most(at_least(value, 0), TRAX_MAX_RADIANCE);
}

static inline struct vector bounded_colour(struct vector colour) {
  return (struct vector){bounded(colour.x), bounded(colour.y), bounded(colour.z)};
}

/* Samples a point of a light by `place`. False if no light arrives. */
static inline bool light_arrives(struct arrival *arrival, const struct trax_device_light *light, struct vector point,
                                 struct place place) {
  struct vector target = load_vector(light->place);
  arrival->pdf = 0;
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

/* pi times the pdf in solid angle of a point of an emitter. square: of the distance; cosine: at the emitter; choices:
   the number of lights that the shadow ray chooses from, where all emitters count as one. */
static inline float emitter_pdf(float per_area, float square, float cosine, float choices) {
  return bounded(3.14159265f * per_area * square / at_least(choices * cosine, 0x1p-40f));
}

/* Samples an emitter by pick and a point on it by place. */
static inline bool emitter_arrives(struct arrival *arrival, bool one_sided, const struct trax_path_params *path,
                                   uint32_t pick, struct vector point, struct place place) {
  const struct trax_emitter *emitters = path_table(path->emitters);
  uint32_t low = 0, high = path->emitter_count; /* the last emitter with a cumulative probability of at most pick */
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
  arrival->pdf = emitter_pdf(material->emitter_pdf, 1 / falloff, cosine, (float)(int32_t)path->choices);
  arrival->radiance = load_vector(material->emission);
  return true;
}

#endif
