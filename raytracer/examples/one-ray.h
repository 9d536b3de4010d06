/* The parts of a pixel's work that steps 9 and 10 share. The arithmetic is that of step 7; only the order of work
   differs. */
#ifndef TRAX_EXAMPLES_ONE_RAY_H
#define TRAX_EXAMPLES_ONE_RAY_H

#include "traversal.h"

struct trax_buffer scene, params, image;

/* Copies words past the data cache, so that data of a single use do not displace the scene. */
typedef unsigned __attribute__((may_alias)) word;
static inline void load_once(void *to, const void *from, unsigned bytes) {
  for (unsigned i = 0; i < bytes / sizeof(word); i++)
    ((word *)to)[i] = __builtin_nontemporal_load((const word *)from + i);
}
static inline void store_once(void *to, const void *from, unsigned bytes) {
  for (unsigned i = 0; i < bytes / sizeof(word); i++)
    __builtin_nontemporal_store(((const word *)from)[i], (word *)to + i);
}

/* False: the slot is beyond the picture's edge. */
static inline bool slot_pixel(const struct trax_render_params *frame, unsigned slot, unsigned *x, unsigned *y) {
  unsigned tile = slot >> 2 * frame->tile_log2_side, within = slot & ((1u << 2 * frame->tile_log2_side) - 1);
  unsigned row = (unsigned)((uint64_t)(2 * tile) * frame->row_multiplier >> 32) >> frame->row_shift;
  *x = (tile - row * frame->tiles_across) << frame->tile_log2_side | even_bits(within);
  *y = row << frame->tile_log2_side | even_bits(within >> 1);
  return *x < frame->width && *y < frame->height;
}

static inline struct vector eye_direction(const struct trax_render_params *frame, unsigned x, unsigned y) {
  float column = (float)(int)x + 0.5f, row = (float)(int)y + 0.5f;
  return normalise(add(add(load(frame->corner), scale(load(frame->step_x), column)), scale(load(frame->step_y), row)));
}

/* A surface that a ray from the eye has hit, and the ray from there to the light. */
struct surface {
  struct vector origin, direction;
  float distance;   /* to the light */
  float light;      /* that the surface reflects in shadow */
  float from_light; /* added if the light is visible; 0: the surface does not face it */
  unsigned material;
};

static inline struct surface surface_at(const struct trax_render_params *frame, struct vector origin,
                                        struct vector direction, struct hit hit) {
  struct surface at = {.material = hit.triangle->material};
  struct vector corner = load(hit.triangle->v0);
  struct vector edge1 = subtract(load(hit.triangle->v1), corner), edge2 = subtract(load(hit.triangle->v2), corner);
  struct vector normal = normalise(cross(edge1, edge2));
  if (dot(normal, direction) > 0)
    normal = scale(normal, -1);
  at.origin = add(origin, scale(direction, hit.distance));
  at.origin = add(at.origin, scale(normal, EPSILON * hit.distance));
  at.light = frame->ambient + dot(normal, load(frame->fill));
  struct vector to_light = subtract(load(frame->light), at.origin);
  float square = dot(to_light, to_light), inverse = trax_rsqrt(square);
  at.direction = scale(to_light, inverse);
  at.distance = square * inverse;
  float cosine = dot(normal, at.direction);
  at.from_light = cosine > 0 ? frame->light_strength * cosine : 0;
  return at;
}

static inline unsigned colour_of(const struct trax_render_params *frame, unsigned material, float light) {
  const float *colour = ((const struct trax_palette_entry *)(frame + 1))[material].colour;
  float root = light > 0 ? light * trax_rsqrt(light) : 0;
  return channel(colour[0] * root) | channel(colour[1] * root) << 8 | channel(colour[2] * root) << 16 | 0xFF000000u;
}

static inline void write_pixel(unsigned pixel, unsigned colour) {
  trax_store_nt((unsigned *)image.data + pixel, colour);
}

static inline void check_scene(const struct trax_render_params *frame) {
  check_input(frame, scene.data);
}

#endif
