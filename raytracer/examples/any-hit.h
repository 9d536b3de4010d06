/* The traversal and the picture of steps 3 and 4. A step defines struct ray, hit_box and make_ray before it includes
   this file. */
#ifndef TRAX_EXAMPLES_ANY_HIT_H
#define TRAX_EXAMPLES_ANY_HIT_H

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

#endif
