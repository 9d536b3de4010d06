/* A pixel as steps 3 to 5 render it. A step defines struct ray, make_ray and trace before it includes this file. */
#ifndef TRAX_EXAMPLES_PIXEL_H
#define TRAX_EXAMPLES_PIXEL_H

static inline unsigned render(const struct trax_render_params *frame, unsigned x, unsigned y) {
  float column = (float)(int)x + 0.5f, row = (float)(int)y + 0.5f;
  struct vector eye = load(frame->eye);
  struct vector way =
      add(add(load(frame->corner), scale(load(frame->step_x), column)), scale(load(frame->step_y), row));
  struct ray ray = make_ray(frame, eye, normalise(way));
  struct hit hit = {INFINITY, NULL};
  trax_count_rays(1);
  if (!trace(&ray, false, &hit))
    return frame->background;

  const triangle_record *triangle = hit.triangle;
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
    ray = make_ray(frame, point, to_light);
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
