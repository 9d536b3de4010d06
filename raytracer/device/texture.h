/* Textures: bilinear between the four nearest texels, in linear light. */
#ifndef TRAX_DEVICE_TEXTURE_H
#define TRAX_DEVICE_TEXTURE_H

#include "algebra.h"
#include "run.h"
#include "traverse.h"

struct texel {
  struct vector colour;
  float alpha;
};

static inline float byte_of(uint32_t word, unsigned shift) {
  return (float)(int32_t)(word >> shift & 255);
}

/* A texel's number along a side of 2^log2_size. */
static inline uint32_t texel_number(int32_t number, uint32_t log2_size, uint32_t flags) {
  int32_t last = (int32_t)(1u << log2_size) - 1;
  if (!(flags & TRAX_TEXTURE_CLAMP))
    return (uint32_t)(number & last);
  return (uint32_t)(number < 0 ? 0 : number > last ? last : number);
}

static inline int32_t floor_of(float value) {
  int32_t whole = (int32_t)value;
  return whole - (value < (float)whole);
}

/* u and v are finite, and their products with the texture's sides below 2^31, by the bounds of scene_format.h. */
static inline __attribute__((always_inline)) struct texel
texture_at(const char *scene_bytes, const struct trax_texture *texture, float u, float v) {
  uint32_t log2_width = texture->log2_width, log2_height = texture->log2_height, flags = texture->flags;
  const uint32_t *texels = (const uint32_t *)(const void *)scene_at(scene_bytes, texture->texels);
  float x = u * (float)(int32_t)(1u << log2_width) - 0.5f, y = v * (float)(int32_t)(1u << log2_height) - 0.5f;
  int32_t column = floor_of(x), row = floor_of(y);
  float along = x - (float)column, across = y - (float)row;
  struct texel sum = {{0, 0, 0}, 0};
  KEEP_ROLLED
  for (int32_t tap = 0; tap < 4; tap++) {
    int32_t right = tap & 1, down = tap >> 1;
    uint32_t i = texel_number(column + right, log2_width, flags), j = texel_number(row + down, log2_height, flags);
    uint32_t word = texels[(j << log2_width) + i];
    float weight = (right ? along : 1 - along) * (down ? across : 1 - across);
    float red = byte_of(word, 0), green = byte_of(word, 8), blue = byte_of(word, 16);
    sum.colour = plus(sum.colour, times(weight, (struct vector){red * red, green * green, blue * blue}));
    sum.alpha += weight * byte_of(word, 24);
  }
  sum.colour = times(1.0f / 65025, sum.colour);
  sum.alpha *= 1.0f / 255;
  return sum;
}

/* The texel at the hit of a triangle. number: of the material's texture, from 1. */
static inline struct texel texture_of_hit(const char *scene_bytes, uint32_t number, const struct hit *hit) {
  const struct trax_scene_header *header = (const struct trax_scene_header *)(const void *)scene_bytes;
  const float *corner = (const float *)(const void *)(hit->triangle + (header->sections[TRAX_SCENE_UVS].offset -
                                                                       header->sections[TRAX_SCENE_TRIANGLES].offset));
  const struct trax_texture *textures =
      (const struct trax_texture *)(const void *)(scene_bytes + header->sections[TRAX_SCENE_TEXTURES].offset);
  float w1 = hit->weight1, w2 = hit->weight2;
  float u = corner[0] + (w1 * (corner[2] - corner[0]) + w2 * (corner[4] - corner[0]));
  float v = corner[1] + (w1 * (corner[3] - corner[1]) + w2 * (corner[5] - corner[1]));
  return texture_at(scene_bytes, &textures[number - 1], u, v);
}

#endif
