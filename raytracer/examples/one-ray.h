/* One ray and one pixel, for steps 9 and 10, which differ from step 7 in what the threads do when. The arithmetic is
   that of step 7, whose comments explain it. */
#ifndef TRAX_EXAMPLES_ONE_RAY_H
#define TRAX_EXAMPLES_ONE_RAY_H

#include "layouts/records.h"
#include "trax/render_params.h"

#include <math.h>
#include <stdbool.h>
#include <trax.h>

struct trax_buffer scene, params, image;

#define SIGN_BIT (-0x7FFFFFFF - 1)
#define UNITS_OF_DOUBT 2 /* by which the product may be rounded otherwise than the quotient, in its last place */
#define EPSILON 1e-4f    /* of the distance: how far a shadow ray's origin is off the surface */

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
static inline int larger(int a, int b) {
  return a > b ? a : b;
}

struct vector {
  float x, y, z;
};

/* Copies words past the data cache, where what is used once would displace the scene. */
typedef unsigned __attribute__((may_alias)) word;
static inline void load_once(void *to, const void *from, unsigned bytes) {
  for (unsigned i = 0; i < bytes / sizeof(word); i++)
    ((word *)to)[i] = __builtin_nontemporal_load((const word *)from + i);
}
static inline void store_once(void *to, const void *from, unsigned bytes) {
  for (unsigned i = 0; i < bytes / sizeof(word); i++)
    __builtin_nontemporal_store(((const word *)from)[i], (word *)to + i);
}

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

struct ray {
  struct vector origin, direction, factor, start;
  int near_x, near_y, near_z;
};

struct hit {
  float distance;
  const struct trax_triangle *triangle; /* NULL: nothing was hit */
};

static inline bool clip(const char *near, const char *far, float factor, float start, int *enter, int *leave) {
  int near_bits = bits(value(*(const uint16_t *)near) * factor - start);
  int far_bits = bits(value(*(const uint16_t *)far) * factor - start);
  if (near_bits > *enter)
    *enter = near_bits;
  if (far_bits < *leave)
    *leave = far_bits;
  return *enter <= *leave;
}

static inline bool hit_box(const struct ray *ray, const uint16_t *box, int nearest, int *enter) {
  const char *min = (const char *)box, *max = (const char *)(box + 3);
  int leave = nearest;
  *enter = 0;
  return clip(min + ray->near_x, max - ray->near_x, ray->factor.x, ray->start.x, enter, &leave) &&
         clip(min + 2 + ray->near_y, max + 2 - ray->near_y, ray->factor.y, ray->start.y, enter, &leave) &&
         clip(min + 4 + ray->near_z, max + 4 - ray->near_z, ray->factor.z, ray->start.z, enter, &leave);
}

static inline bool hit_triangle(const struct ray *ray, const struct trax_triangle *triangle, bool any,
                                struct hit *hit) {
  struct vector corner = load(triangle->v0);
  struct vector edge1 = subtract(load(triangle->v1), corner), edge2 = subtract(load(triangle->v2), corner);
  struct vector p = cross(ray->direction, edge2);
  float determinant = dot(edge1, p);
  int sign = bits(determinant) & SIGN_BIT, size = bits(determinant) ^ sign;
  struct vector t = subtract(ray->origin, corner);
  float u = dot(t, p);
  int u_bits = bits(u) ^ sign;
  struct vector q = cross(t, edge1);
  float v = dot(ray->direction, q);
  int v_bits = bits(v) ^ sign, sum_bits = bits(u + v) ^ sign;
  if (size == 0 || (unsigned)u_bits > (unsigned)SIGN_BIT || u_bits > size || (unsigned)v_bits > (unsigned)SIGN_BIT ||
      sum_bits > size)
    return false;
  float scaled = dot(edge2, q);
  int scaled_bits = bits(scaled) ^ sign;
  if (scaled_bits <= 0 || scaled_bits > bits(hit->distance * value(size)) + UNITS_OF_DOUBT)
    return false;
  if (!any) {
    float distance = scaled / determinant;
    if (bits(distance) >= bits(hit->distance))
      return false;
    hit->distance = distance;
    hit->triangle = triangle;
  }
  return true;
}

static inline int in_units_of_boxes(float distance) {
  return larger(bits(distance) - (64 << 23), bits(0x1p-126f));
}

/* Traces through the subtree at `reference`. Returns whether the ray has a hit there or had one before. */
static inline __attribute__((always_inline)) bool trace(const struct ray *ray, trax_scene_ref reference, bool any,
                                                        struct hit *hit) {
  const char *bytes = scene.data;
  trax_scene_ref stack[TRAX_SCENE_DEFAULT_DEPTH];
  unsigned top = 0;
  for (;;) {
    unsigned count = TRAX_SCENE_REF_COUNT(reference);
    if (__builtin_expect(count == 0, 1)) {
      const struct trax_quantised_node *node = (const void *)(bytes + reference);
      int enter0, enter1, nearest = in_units_of_boxes(hit->distance);
      if (hit_box(ray, node->box[0].min, nearest, &enter0)) {
        if (hit_box(ray, node->box[1].min, nearest, &enter1)) {
          bool second = enter1 < enter0;
          stack[top++] = node->child[!second];
          reference = node->child[second];
        } else {
          reference = node->child[0];
        }
        continue;
      }
      if (hit_box(ray, node->box[1].min, nearest, &enter1)) {
        reference = node->child[1];
        continue;
      }
    } else {
      const struct trax_triangle *triangle = (const void *)(bytes + TRAX_SCENE_REF_OFFSET(reference));
      for (const struct trax_triangle *end = triangle + count; triangle != end; triangle++)
        if (hit_triangle(ray, triangle, any, hit) && any)
          return true;
    }
    if (top == 0)
      return hit->triangle != NULL;
    reference = stack[--top];
  }
}

static inline float away_from_zero(float component) {
  int sign = bits(component) & SIGN_BIT;
  return value(larger(bits(component) ^ sign, bits(0x1p-30f)) | sign);
}

static inline struct ray make_ray(const struct trax_ray_grid *grid, struct vector origin, struct vector direction) {
  float x = direction.x, y = direction.y, z = direction.z, product = x * y * z;
  if ((bits(product) & ~SIGN_BIT) < bits(0x1p-30f)) {
    x = away_from_zero(x), y = away_from_zero(y), z = away_from_zero(z);
    product = x * y * z;
  }
  float reciprocal = 1 / product * 0x1p-64f;
  struct vector inverse = {y * z * reciprocal, x * z * reciprocal, x * y * reciprocal};
  struct vector factor = scale(scale(multiply(inverse, load(grid->cell)), 0x1p75f), 0x1p74f);
  struct vector start = multiply(subtract(origin, load(grid->origin)), inverse);
  return (struct ray){origin, direction, factor, start, x < 0 ? 6 : 0, y < 0 ? 6 : 0, z < 0 ? 6 : 0};
}

/* --- pixels --- */

static inline unsigned even_bits(unsigned number) {
  number &= 0x155;
  number = (number | number >> 1) & 0x133;
  number = (number | number >> 2) & 0x10F;
  return (number | number >> 4) & 0x1F;
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
  float from_light; /* what the light adds; 0: the surface does not face it */
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

static inline unsigned channel(float value) {
  return value < 255 ? (unsigned)(int)(value + 0.5f) : 255;
}

static inline unsigned colour_of(const struct trax_render_params *frame, unsigned material, float light) {
  const float *colour = ((const struct trax_palette_entry *)(frame + 1))[material].colour;
  float root = light > 0 ? light * trax_rsqrt(light) : 0;
  return channel(colour[0] * root) | channel(colour[1] * root) << 8 | channel(colour[2] * root) << 16 | 0xFF000000u;
}

static inline void write_pixel(unsigned pixel, unsigned colour) {
  trax_store_nt((unsigned *)image.data + pixel, colour);
}

static inline void check_input(const struct trax_render_params *frame) {
  const struct trax_scene_header *header = scene.data;
  const unsigned workload = TRAX_FEATURE_BIT(SHADOWS) | TRAX_FEATURE_BIT(MATERIALS);
  if ((frame->features & ~workload) || !(frame->features & TRAX_FEATURE_BIT(SHADOWS)))
    trax_abort("this program renders the paper's workload only: one point light, its shadows, Lambert's law");
  if (frame->node_layout != TRAX_NODES_QUANTISED)
    trax_abort("this program needs a scene of quantised nodes (trax-scene --nodes quantised)");
  if (header->root == 0 || header->max_depth > TRAX_SCENE_DEFAULT_DEPTH)
    trax_abort("this program needs a scene with triangles, no deeper than its stack (trax-scene --depth)");
}

#endif
