/* Light from far away, by its direction: a square of texels on the octahedron |x| + |y| + |z| = 1, whose lower half is
   folded outwards. The upper corner is y. Within a texel the light is the same. */
#ifndef TRAX_DEVICE_ENVIRONMENT_H
#define TRAX_DEVICE_ENVIRONMENT_H

#include "aim.h"
#include "algebra.h"
#include "run.h"
#include "sampler.h"

static inline float with_sign(float size, float sign) {
  return bits_float(float_bits(size) | (float_bits(sign) & SIGN_BIT));
}

static inline float size_of(float value) {
  return bits_float(magnitude(value));
}

/* The texel of a direction of unit length. *pdf: pi times the density in solid angle with which environment_arrives
   chooses the direction. */
static inline const struct trax_environment_texel *environment_texel(const struct trax_path_params *path,
                                                                     struct vector direction, float *pdf) {
  const struct trax_environment_texel *texels = path_table(path->environment);
  const float inverse = 1 / (size_of(direction.x) + size_of(direction.y) + size_of(direction.z));
  float u = direction.x * inverse, v = direction.z * inverse;
  if (float_bits(direction.y) < 0) {
    const float across = with_sign(at_least(1 - size_of(v), 0), u);
    v = with_sign(at_least(1 - size_of(u), 0), v);
    u = across;
  }
  const int32_t side = 1 << path->environment_log2, last = side - 1;
  const float half = 0.5f * (float)side;
  int32_t column = (int32_t)(u * half + half), row = (int32_t)(v * half + half);
  column = column < last ? column : last;
  row = row < last ? row : last;
  const struct trax_environment_texel *texel = &texels[(uint32_t)(row << path->environment_log2) + (uint32_t)column];
  *pdf = texel->pdf * (inverse * inverse * inverse) / (float)(int32_t)path->choices;
  return texel;
}

/* Samples a direction: the texel by pick, the place in it by place. */
static inline bool environment_arrives(struct arrival *arrival, const struct trax_path_params *path, uint32_t pick,
                                       struct place place) {
  const uint32_t log2 = path->environment_log2;
  const struct trax_environment_texel *texels = path_table(path->environment);
  const struct trax_environment_alias *aliases = (const void *)(texels + (1u << 2 * log2));
  const uint64_t product = (uint64_t)pick << 2 * log2;
  uint32_t number = (uint32_t)(product >> 32);
  if ((uint32_t)product >= aliases[number].threshold)
    number = aliases[number].other;
  const float width = 2 / (float)(int32_t)(1u << log2);
  const float u = ((float)(int32_t)(number & ((1u << log2) - 1)) + place.x) * width - 1;
  const float v = ((float)(int32_t)(number >> log2) + place.y) * width - 1;
  struct vector to = {u, 1 - size_of(u) - size_of(v), v};
  if (float_bits(to.y) < 0) {
    to.x = with_sign(at_least(1 - size_of(v), 0), u);
    to.z = with_sign(at_least(1 - size_of(u), 0), v);
  }
  const float square = dot(to, to), inverse = trax_rsqrt(square);
  arrival->direction = arrival->target = times(inverse, to);
  arrival->distance_bits = FARTHEST_BITS;
  arrival->radiance = load_vector(texels[number].radiance);
  arrival->pdf = texels[number].pdf * (square * square * inverse) / (float)(int32_t)path->choices;
  return true;
}

/* The light of a ray that hits nothing. pdf: pi times that of its direction; 0: a mirror, glass or the eye. */
static inline struct vector environment_found(const struct trax_render_params *run, struct vector direction,
                                              float pdf) {
  float other;
  const struct trax_environment_texel *texel = environment_texel(RUN_PATH(run), direction, &other);
  const struct vector light = load_vector(texel->radiance);
  return NEEDS(run, PATHS) && float_bits(pdf) != 0 ? times(pdf / (pdf + other), light) : light;
}

#endif
