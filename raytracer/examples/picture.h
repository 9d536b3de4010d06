/* The parts that all steps share: vectors, the bits of floats, and the check of the workload. */
#ifndef TRAX_EXAMPLES_PICTURE_H
#define TRAX_EXAMPLES_PICTURE_H

#include "trax/render_params.h"

#include <math.h>
#include <stdbool.h>
#include <trax.h>

extern struct trax_buffer scene, params, image;         /* which a step defines */
__asm__(".globl workload_rays\n.set workload_rays, 1"); /* as many rays as the device program: sampled runs need not
                                                           guess */

#define SIGN_BIT (-0x7FFFFFFF - 1)
#define EPSILON 1e-4f /* of the distance: how far a shadow ray's origin is off the surface */

struct vector {
  float x, y, z;
};

static inline struct vector load(const float *v) {
  return (struct vector){v[0], v[1], v[2]};
}
static inline struct vector add(struct vector a, struct vector b) {
  return (struct vector){a.x + b.x, a.y + b.y, a.z + b.z};
}
static inline struct vector subtract(struct vector a, struct vector b) {
  return (struct vector){a.x - b.x, a.y - b.y, a.z - b.z};
}
static inline struct vector scale(struct vector v, float factor) {
  return (struct vector){v.x * factor, v.y * factor, v.z * factor};
}
static inline struct vector multiply(struct vector a, struct vector b) {
  return (struct vector){a.x * b.x, a.y * b.y, a.z * b.z};
}
static inline float dot(struct vector a, struct vector b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline struct vector cross(struct vector a, struct vector b) {
  return (struct vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline struct vector normalise(struct vector v) {
  return scale(v, trax_rsqrt(dot(v, v)));
}

/* The bits of a float. Floats that are not negative are ordered as their bits are; a negative one is less than each of
   them, and only two negative ones stand in the wrong order. */
static inline int bits(float number) {
  int result;
  __builtin_memcpy(&result, &number, sizeof result);
  return result;
}
static inline float value(int bits) {
  float result;
  __builtin_memcpy(&result, &bits, sizeof result);
  return result;
}
static inline int smaller(int a, int b) {
  return a < b ? a : b;
}
static inline int larger(int a, int b) {
  return a > b ? a : b;
}

static inline unsigned channel(float value) {
  return value < 255 ? (unsigned)(int)(value + 0.5f) : 255;
}

/* A number's bits of even places, put together. */
static inline unsigned even_bits(unsigned number) {
  number &= 0x155;
  number = (number | number >> 1) & 0x133;
  number = (number | number >> 2) & 0x10F;
  return (number | number >> 4) & 0x1F;
}

#define WORKLOAD (TRAX_FEATURE_BIT(SHADOWS) | TRAX_FEATURE_BIT(MATERIALS))

static inline void check_workload(const struct trax_render_params *frame) {
  if ((frame->features & ~WORKLOAD) || !(frame->features & TRAX_FEATURE_BIT(SHADOWS)))
    trax_abort("this program renders the paper's workload only: one point light, its shadows, Lambert's law");
}

#endif
