/* Step 6: everything in registers. The ray to the light goes through the same copy of the traversal as the one from the
   eye, and that copy stands within the loop over pixels: no call saves registers, no pointer keeps the ray in memory,
   and the program stays small. The second child's box is tested in one place where the first one was entered and in
   another where it was missed, so that what was found needs no variable. */
#include "layouts/records.h"
#include "trax/render_params.h"

#include <math.h>
#include <stdbool.h>
#include <trax.h>

struct trax_buffer scene, params, image;
unsigned next_pixel;                                    /* shared by all threads */
__asm__(".globl workload_rays\n.set workload_rays, 1"); /* as many rays as the device program: sampled runs need not
                                                           guess */

#define SIGN_BIT (-0x7FFFFFFF - 1)
#define UNITS_OF_DOUBT 2 /* by which the product may be rounded otherwise than the quotient, in its last place */
#define EPSILON 1e-4f    /* of the distance: how far a shadow ray's origin is off the surface */

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
static inline int larger(int a, int b) {
  return a > b ? a : b;
}

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

struct ray {
  struct vector origin, direction; /* of unit length */
  struct vector factor, start;     /* a plane is at plane * factor - start along the ray, divided by 2^64 */
  int near_x, near_y, near_z; /* bytes from a box's minima to its nearer planes: 0, or 6 if the direction is negative */
};

struct hit {
  float distance;
  const struct trax_triangle *triangle; /* NULL: nothing was hit */
};

/* The bits of the distance along the ray to a plane. The number of 16 bits is not converted: taken for a float it is a
   subnormal, the number times 2^-149, which the machine multiplies as any other. */
static inline int plane_bits(const char *plane, float factor, float start) {
  return bits(value(*(const uint16_t *)plane) * factor - start);
}

/* Clips the way of a ray through a box to the slab between two planes. False: nothing of it is left. */
static inline bool clip(const char *near, const char *far, float factor, float start, int *enter, int *leave) {
  int near_bits = plane_bits(near, factor, start), far_bits = plane_bits(far, factor, start);
  if (near_bits > *enter)
    *enter = near_bits;
  if (far_bits < *leave)
    *leave = far_bits;
  return *enter <= *leave;
}

/* Whether the ray hits the box before `nearest`, and where it enters it: the slabs of Kay and Kajiya (SIGGRAPH 1986).
   All distances are bits. The way begins at 0, so of two that are compared one is never negative. */
static inline bool hit_box(const struct ray *ray, const uint16_t *box, int nearest, int *enter) {
  const char *min = (const char *)box, *max = (const char *)(box + 3);
  int leave = nearest;
  *enter = 0;
  return clip(min + ray->near_x, max - ray->near_x, ray->factor.x, ray->start.x, enter, &leave) &&
         clip(min + 2 + ray->near_y, max + 2 - ray->near_y, ray->factor.y, ray->start.y, enter, &leave) &&
         clip(min + 4 + ray->near_z, max + 4 - ray->near_z, ray->factor.z, ray->start.z, enter, &leave);
}

/* "Fast, Minimum Storage Ray/Triangle Intersection" (Journal of Graphics Tools 2(1), 1997), for both sides. What
   is compared is the distance times the determinant; only a nearer hit is divided, and none if any hit will do. */
static inline bool hit_triangle(const struct ray *ray, const struct trax_triangle *triangle, bool any,
                                struct hit *hit) {
  struct vector corner = load(triangle->v0);
  struct vector edge1 = subtract(load(triangle->v1), corner), edge2 = subtract(load(triangle->v2), corner);
  struct vector p = cross(ray->direction, edge2);
  float determinant = dot(edge1, p);
  int sign = bits(determinant) & SIGN_BIT, size = bits(determinant) ^ sign; /* what is below is times the sign */
  struct vector t = subtract(ray->origin, corner);
  float u = dot(t, p);
  int u_bits = bits(u) ^ sign;
  struct vector q = cross(t, edge1);
  float v = dot(ray->direction, q);
  int v_bits = bits(v) ^ sign, sum_bits = bits(u + v) ^ sign;
  if (size == 0 || (unsigned)u_bits > (unsigned)SIGN_BIT || u_bits > size || (unsigned)v_bits > (unsigned)SIGN_BIT ||
      sum_bits > size) /* a zero of either sign is inside */
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

/* A distance in the units of boxes, as bits: what is divided by 2^64 has 64 less in its exponent. */
static inline int in_units_of_boxes(float distance) {
  return larger(bits(distance) - (64 << 23), bits(0x1p-126f));
}

/* The nearest hit before hit->distance; or, if any hit will do, whether there is one. */
static inline __attribute__((always_inline)) bool trace(const struct ray *ray, bool any, struct hit *hit) {
  const char *bytes = scene.data; /* references are offsets from its beginning */
  trax_scene_ref stack[TRAX_SCENE_DEFAULT_DEPTH], reference = ((const struct trax_scene_header *)bytes)->root;
  unsigned top = 0;
  for (;;) {
    unsigned count = TRAX_SCENE_REF_COUNT(reference);
    if (__builtin_expect(count == 0, 1)) { /* rays visit more nodes than triangles */
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

/* A direction that is turned by 2^-30 enters the same boxes. */
static inline float away_from_zero(float component) {
  int sign = bits(component) & SIGN_BIT;
  return value(larger(bits(component) ^ sign, bits(0x1p-30f)) | sign);
}

static inline int far_first(float component) {
  return component < 0 ? 6 : 0;
}

/* 2^149 makes numbers of what was taken for subnormals, and distances are divided by 2^64, which keeps all of this
   within the range of floats. */
static inline struct ray make_ray(const struct trax_ray_grid *grid, struct vector origin, struct vector direction) {
  float x = direction.x, y = direction.y, z = direction.z, product = x * y * z;
  if ((bits(product) & ~SIGN_BIT) < bits(0x1p-30f)) { /* along an axis or a plane of two, or nearly so: rarely */
    x = away_from_zero(x), y = away_from_zero(y), z = away_from_zero(z);
    product = x * y * z;
  }
  float reciprocal = 1 / product * 0x1p-64f;
  struct vector inverse = {y * z * reciprocal, x * z * reciprocal, x * y * reciprocal};
  struct vector factor = scale(scale(multiply(inverse, load(grid->cell)), 0x1p75f), 0x1p74f);
  struct vector start = multiply(subtract(origin, load(grid->origin)), inverse);
  return (struct ray){origin, direction, factor, start, far_first(x), far_first(y), far_first(z)};
}

static inline unsigned channel(float value) {
  return value < 255 ? (unsigned)(int)(value + 0.5f) : 255;
}

/* The first ray comes from the eye, the second, where what is hit faces the light, goes to it. */
static inline unsigned render(const struct trax_render_params *frame, unsigned x, unsigned y) {
  float column = (float)(int)x + 0.5f, row = (float)(int)y + 0.5f;
  struct vector origin = load(frame->eye);
  struct vector direction =
      normalise(add(add(load(frame->corner), scale(load(frame->step_x), column)), scale(load(frame->step_y), row)));
  struct hit hit = {INFINITY, NULL};
  const struct trax_triangle *seen = NULL;
  float light = 0, from_light = 0;
  for (;;) {
    struct ray ray = make_ray(&frame->grid, origin, direction);
    bool found = trace(&ray, seen != NULL, &hit);
    trax_count_rays(1);
    if (seen) {
      if (!found)
        light += from_light;
      break;
    }
    if (!found)
      return frame->background;
    seen = hit.triangle;
    struct vector corner = load(seen->v0);
    struct vector normal = normalise(cross(subtract(load(seen->v1), corner), subtract(load(seen->v2), corner)));
    if (dot(normal, direction) > 0)
      normal = scale(normal, -1);
    origin = add(origin, scale(direction, hit.distance));
    origin = add(origin, scale(normal, EPSILON * hit.distance));
    light = frame->ambient + dot(normal, load(frame->fill));
    struct vector to_light = subtract(load(frame->light), origin);
    float square = dot(to_light, to_light), inverse = trax_rsqrt(square);
    direction = scale(to_light, inverse);
    float cosine = dot(normal, direction);
    if (cosine <= 0)
      break;
    from_light = frame->light_strength * cosine;
    hit = (struct hit){square * inverse, NULL};
  }
  const struct trax_palette_entry *palette = (const struct trax_palette_entry *)(frame + 1);
  const float *colour = palette[seen->material].colour; /* its square root, and the light's: gamma 2 */
  float root = light > 0 ? light * trax_rsqrt(light) : 0;
  return channel(colour[0] * root) | channel(colour[1] * root) << 8 | channel(colour[2] * root) << 16 | 0xFF000000u;
}

#define WORKLOAD (TRAX_FEATURE_BIT(SHADOWS) | TRAX_FEATURE_BIT(MATERIALS))

int main(void) {
  const struct trax_render_params *frame = params.data;
  if ((frame->features & ~WORKLOAD) || !(frame->features & TRAX_FEATURE_BIT(SHADOWS)))
    trax_abort("this program renders the paper's workload only: one point light, its shadows, Lambert's law");
  if (frame->node_layout != TRAX_NODES_QUANTISED)
    trax_abort("this program needs a scene of quantised nodes (trax-scene --nodes quantised)");
  const struct trax_scene_header *header = scene.data;
  if (header->root == 0 || header->max_depth > TRAX_SCENE_DEFAULT_DEPTH)
    trax_abort("this program needs a scene with triangles, no deeper than its stack (trax-scene --depth)");
  unsigned pixels = frame->width * frame->height;
  for (unsigned pixel = trax_atomic_inc(&next_pixel); pixel < pixels; pixel = trax_atomic_inc(&next_pixel)) {
    trax_store_nt((unsigned *)image.data + pixel, render(frame, pixel % frame->width, pixel / frame->width));
    trax_count_items(1);
  }
  return 0;
}
