/* A pixel as step 6 renders it, with both rays in one loop. A step defines trace before it includes this file. */
#ifndef TRAX_EXAMPLES_REGISTERS_H
#define TRAX_EXAMPLES_REGISTERS_H

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
    struct ray ray = make_ray(frame, origin, direction);
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

#endif
