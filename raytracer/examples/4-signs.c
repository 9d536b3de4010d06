/* Step 4: planes by sign. The sign of a direction's component says which of a box's two planes the ray meets first
   along that axis, so where the near planes are is found once for a ray, and no pair of distances is compared. An axis
   after which nothing is left of the ray's way through the box ends the test: the other planes are not even loaded. */
#include "trax/plain_scene.h"

typedef struct trax_plain_triangle triangle_record;
#include "one-division.h"

struct trax_buffer plain_nodes, plain_triangles, params, image;
unsigned next_pixel; /* shared by all threads */

struct ray {
  struct vector origin, direction, inverse; /* of unit length; 1 / direction */
  int near_x, near_y,
      near_z; /* bytes from a box's minima to its nearer planes: 0, or 12 if the direction is negative */
};

/* Clips the way of a ray through a box to the slab between two planes. False: nothing of it is left. */
static inline bool clip(const char *near, const char *far, float origin, float inverse, int *enter, int *leave) {
  int near_bits = bits((*(const float *)near - origin) * inverse);
  int far_bits = bits((*(const float *)far - origin) * inverse);
  if (near_bits > *enter)
    *enter = near_bits;
  if (far_bits < *leave)
    *leave = far_bits;
  return *enter <= *leave;
}

/* Whether the ray hits the box before `nearest`, and where it enters it: the slabs of Kay and Kajiya (SIGGRAPH 1986).
   All distances are bits. The way begins at 0, so of two that are compared one is never negative. */
static inline bool hit_box(const struct ray *ray, const struct trax_plain_node *node, int nearest, int *enter) {
  const char *min = (const char *)node->min, *max = (const char *)node->max;
  int leave = nearest;
  *enter = 0;
  return clip(min + ray->near_x, max - ray->near_x, ray->origin.x, ray->inverse.x, enter, &leave) &&
         clip(min + 4 + ray->near_y, max + 4 - ray->near_y, ray->origin.y, ray->inverse.y, enter, &leave) &&
         clip(min + 8 + ray->near_z, max + 8 - ray->near_z, ray->origin.z, ray->inverse.z, enter, &leave);
}

/* The nearest hit before hit->distance; or, if any hit will do, whether there is one. */
static __attribute__((noinline)) bool trace(const struct ray *ray, bool any, struct hit *hit) {
  const struct trax_plain_node *nodes = plain_nodes.data;
  const struct trax_plain_triangle *triangles = plain_triangles.data;
  unsigned stack[TRAX_PLAIN_MAX_DEPTH], top = 0, number = 0;
  for (;;) {
    const struct trax_plain_node *node = &nodes[number];
    if (node->count < 0) {
      int enter0, enter1, nearest = bits(hit->distance);
      unsigned first = node->first;
      bool hit0 = hit_box(ray, &nodes[first], nearest, &enter0);
      bool hit1 = hit_box(ray, &nodes[first + 1], nearest, &enter1);
      if (hit0 && hit1) {
        bool second = enter1 < enter0;
        stack[top++] = second ? first : first + 1;
        number = second ? first + 1 : first;
        continue;
      }
      if (hit0 || hit1) {
        number = hit0 ? first : first + 1;
        continue;
      }
    } else {
      for (int i = 0; i < node->count; i++)
        if (hit_triangle(&ray->origin, &ray->direction, &triangles[node->first + i], any, hit) && any)
          return true;
    }
    if (top == 0)
      return hit->triangle != NULL;
    number = stack[--top];
  }
}

static inline int far_first(float component) {
  return component < 0 ? 12 : 0;
}

static inline struct ray make_ray(struct vector origin, struct vector direction) {
  float x = direction.x, y = direction.y, z = direction.z, product = x * y * z;
  if ((bits(product) & ~SIGN_BIT) < bits(0x1p-30f)) { /* along an axis or a plane of two, or nearly so: rarely */
    x = away_from_zero(x), y = away_from_zero(y), z = away_from_zero(z);
    product = x * y * z;
  }
  float reciprocal = 1 / product;
  struct vector inverse = {y * z * reciprocal, x * z * reciprocal, x * y * reciprocal};
  return (struct ray){origin, direction, inverse, far_first(x), far_first(y), far_first(z)};
}

static inline unsigned render(const struct trax_render_params *frame, unsigned x, unsigned y) {
  float column = (float)(int)x + 0.5f, row = (float)(int)y + 0.5f;
  struct vector eye = load(frame->eye);
  struct vector way =
      add(add(load(frame->corner), scale(load(frame->step_x), column)), scale(load(frame->step_y), row));
  struct ray ray = make_ray(eye, normalise(way));
  struct hit hit = {INFINITY, NULL};
  trax_count_rays(1);
  if (!trace(&ray, false, &hit))
    return frame->background;

  const struct trax_plain_triangle *triangle = hit.triangle;
  struct vector corner = load(triangle->v0);
  struct vector normal = normalise(cross(subtract(load(triangle->v1), corner), subtract(load(triangle->v2), corner)));
  if (dot(normal, ray.direction) > 0)
    normal = scale(normal, -1);
  struct vector point = add(eye, scale(ray.direction, hit.distance));
  point = add(point, scale(normal, EPSILON * hit.distance));
  float light = frame->ambient + dot(normal, load(frame->fill));
  struct vector to_light = subtract(load(frame->light), point);
  float square = dot(to_light, to_light), inverse = trax_rsqrt(square);
  to_light = scale(to_light, inverse);
  float cosine = dot(normal, to_light);
  if (cosine > 0) {
    ray = make_ray(point, to_light);
    hit = (struct hit){square * inverse, NULL};
    trax_count_rays(1);
    if (!trace(&ray, true, &hit))
      light += frame->light_strength * cosine;
  }
  const struct trax_palette_entry *palette = (const struct trax_palette_entry *)(frame + 1);
  const float *colour = palette[triangle->material].colour; /* its square root, and the light's: gamma 2 */
  float root = light > 0 ? light * trax_rsqrt(light) : 0;
  return channel(colour[0] * root) | channel(colour[1] * root) << 8 | channel(colour[2] * root) << 16 | 0xFF000000u;
}

int main(void) {
  const struct trax_render_params *frame = params.data;
  check_workload(frame);
  unsigned pixels = frame->width * frame->height;
  for (unsigned pixel = trax_atomic_inc(&next_pixel); pixel < pixels; pixel = trax_atomic_inc(&next_pixel)) {
    trax_store_nt((unsigned *)image.data + pixel, render(frame, pixel % frame->width, pixel / frame->width));
    trax_count_items(1);
  }
  return 0;
}
