/* A user's ray caster: it reads the scene's plain arrays, orders no children, and is grey by the light alone. */
#include "trax/plain_scene.h"
#include "trax/render_params.h"

#include <math.h>
#include <trax.h>

struct trax_buffer plain_nodes, plain_triangles, params, image, counters;
unsigned next_pixel;
struct vector {
  float x, y, z;
};
static struct vector at(const float *v) {
  return (struct vector){v[0], v[1], v[2]};
}
static struct vector minus(struct vector a, struct vector b) {
  return (struct vector){a.x - b.x, a.y - b.y, a.z - b.z};
}
static struct vector along(struct vector a, struct vector b, float t) {
  return (struct vector){a.x + t * b.x, a.y + t * b.y, a.z + t * b.z};
}
static float dot(struct vector a, struct vector b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
static struct vector cross(struct vector a, struct vector b) {
  return (struct vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static void count(unsigned number) {
  trax_atomic_inc((unsigned *)counters.data + number);
}
static float slab(float low, float high, float from, float way, float *leave) {
  float a = (low - from) / way, b = (high - from) / way;
  *leave = fminf(*leave, fmaxf(a, b));
  return fminf(a, b);
}
static float nearest(struct vector from, struct vector way, float limit) {
  unsigned stack[TRAX_PLAIN_MAX_DEPTH + 1] = {0}, top = 1;
  while (top) {
    const struct trax_plain_node *node = (const struct trax_plain_node *)plain_nodes.data + stack[--top];
    float leave = limit, enter = slab(node->min[0], node->max[0], from.x, way.x, &leave);
    enter = fmaxf(enter, slab(node->min[1], node->max[1], from.y, way.y, &leave));
    enter = fmaxf(enter, slab(node->min[2], node->max[2], from.z, way.z, &leave));
    count(0);
    if (enter > leave || leave < 0)
      continue;
    for (int i = 0; i < node->count; i++) {
      const struct trax_plain_triangle *triangle =
          (const struct trax_plain_triangle *)plain_triangles.data + node->first + i;
      struct vector e = minus(at(triangle->v1), at(triangle->v0)), f = minus(at(triangle->v2), at(triangle->v0)),
                    p = cross(way, f);
      struct vector t = minus(from, at(triangle->v0)), q = cross(t, e);
      float scale = 1 / dot(e, p), u = dot(t, p) * scale, v = dot(way, q) * scale, distance = dot(f, q) * scale;
      count(1);
      if (u >= 0 && v >= 0 && u + v <= 1 && distance > 1e-4f && distance < limit)
        limit = distance;
    }
    if (node->count < 0)
      stack[top++] = node->first, stack[top++] = node->first + 1;
  }
  return limit;
}
int main(void) {
  const struct trax_render_params *frame = params.data;
  for (unsigned pixel; (pixel = trax_atomic_inc(&next_pixel)) < frame->width * frame->height; trax_count_items(1)) {
    float x = (float)(int)(pixel % frame->width) + 0.5f, y = (float)(int)(pixel / frame->width) + 0.5f;
    struct vector way = along(along(at(frame->corner), at(frame->step_x), x), at(frame->step_y), y);
    trax_count_kinds(TRAX_RAYS(TRAX_RAY_PRIMARY, 1));
    float depth = nearest(at(frame->eye), way, 1e9f), light = fmaxf(frame->ambient, 0);
    if (depth < 1e9f && frame->features & TRAX_FEATURE_BIT(SHADOWS)) {
      struct vector point = along(at(frame->eye), way, 0.999f * depth);
      trax_count_kinds(TRAX_RAYS(TRAX_RAY_SHADOW, 1));
      light += nearest(point, minus(at(frame->light), point), 1) < 1 ? 0 : 0.5f;
    }
    unsigned grey = (unsigned)(int)fminf(255 * light, 255);
    trax_store_nt((unsigned *)image.data + pixel, depth < 1e9f ? grey * 0x10101 | 0xFF000000u : frame->background);
  }
}
