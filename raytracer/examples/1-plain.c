/* A ray tracer in the style of the paper's time. It tells which part of our figures is the machine's and which is our
   program's. It is as near to the paper's as its text allows; docs/evaluation.md says what the text leaves open and
   what was chosen. Plain C: a binary BVH of boxes, 32-bit floats compared as floats, Moeller and Trumbore's triangle
   test, an epsilon, pixels row by row from the atomic counter. Nothing here knows what the machine shares. */
#include "picture.h"
#include "trax/plain_scene.h"

struct trax_buffer plain_nodes, plain_triangles, params, image;
unsigned next_pixel; /* shared by all threads */

struct ray {
  struct vector origin, direction, inverse; /* of unit length; 1 / direction */
};

struct hit {
  float distance;
  const struct trax_plain_triangle *triangle; /* NULL: nothing was hit */
};

/* Whether the ray hits the box before `nearest`, and where it enters it: the slabs of Kay and Kajiya (SIGGRAPH 1986).
 */
static inline bool hit_box(const struct ray *ray, const struct trax_plain_node *node, float nearest, float *enter) {
  float x0 = (node->min[0] - ray->origin.x) * ray->inverse.x, x1 = (node->max[0] - ray->origin.x) * ray->inverse.x;
  float y0 = (node->min[1] - ray->origin.y) * ray->inverse.y, y1 = (node->max[1] - ray->origin.y) * ray->inverse.y;
  float z0 = (node->min[2] - ray->origin.z) * ray->inverse.z, z1 = (node->max[2] - ray->origin.z) * ray->inverse.z;
  *enter = fmaxf(fmaxf(fminf(x0, x1), fminf(y0, y1)), fminf(z0, z1));
  float leave = fminf(fminf(fmaxf(x0, x1), fmaxf(y0, y1)), fmaxf(z0, z1));
  return *enter <= leave && leave >= 0 && *enter < nearest;
}

/* "Fast, Minimum Storage Ray/Triangle Intersection" (Journal of Graphics Tools 2(1), 1997), for both sides; the
   division waits for a hit. */
static inline void hit_triangle(const struct ray *ray, const struct trax_plain_triangle *triangle, struct hit *hit) {
  struct vector corner = load(triangle->v0);
  struct vector edge1 = subtract(load(triangle->v1), corner), edge2 = subtract(load(triangle->v2), corner);
  struct vector p = cross(ray->direction, edge2);
  float determinant = dot(edge1, p);
  struct vector t = subtract(ray->origin, corner);
  float u = dot(t, p);
  struct vector q = cross(t, edge1);
  float v = dot(ray->direction, q);
  if (determinant > 0) {
    if (u < 0 || u > determinant || v < 0 || u + v > determinant)
      return;
  } else if (determinant < 0) {
    if (u > 0 || u < determinant || v > 0 || u + v < determinant)
      return;
  } else {
    return;
  }
  float distance = dot(edge2, q) / determinant;
  if (distance > 0 && distance < hit->distance) {
    hit->distance = distance;
    hit->triangle = triangle;
  }
}

/* The nearest hit before hit->distance. */
static __attribute__((noinline)) void trace(const struct ray *ray, struct hit *hit) {
  const struct trax_plain_node *nodes = plain_nodes.data;
  const struct trax_plain_triangle *triangles = plain_triangles.data;
  unsigned stack[TRAX_PLAIN_MAX_DEPTH], top = 0, number = 0;
  for (;;) {
    const struct trax_plain_node *node = &nodes[number];
    if (node->count < 0) {
      float enter0, enter1;
      unsigned first = node->first;
      bool hit0 = hit_box(ray, &nodes[first], hit->distance, &enter0);
      bool hit1 = hit_box(ray, &nodes[first + 1], hit->distance, &enter1);
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
        hit_triangle(ray, &triangles[node->first + i], hit);
    }
    if (top == 0)
      return;
    number = stack[--top];
  }
}

static inline struct ray make_ray(struct vector origin, struct vector direction) {
  struct vector inverse = {1 / direction.x, 1 / direction.y, 1 / direction.z};
  return (struct ray){origin, direction, inverse};
}

static inline unsigned render(const struct trax_render_params *frame, unsigned x, unsigned y) {
  float column = (float)(int)x + 0.5f, row = (float)(int)y + 0.5f;
  struct vector eye = load(frame->eye);
  struct vector way =
      add(add(load(frame->corner), scale(load(frame->step_x), column)), scale(load(frame->step_y), row));
  struct ray ray = make_ray(eye, normalise(way));
  struct hit hit = {INFINITY, NULL};
  trace(&ray, &hit);
  trax_count_rays(1);
  if (!hit.triangle)
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
    trace(&ray, &hit);
    trax_count_rays(1);
    if (!hit.triangle)
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
