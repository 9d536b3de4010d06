#include "reach.h"

#include "double3.h"

/* The squared distance between the origin and a triangle: C. Ericson, "Real-Time Collision Detection" (2005), section
   5.1.5. */
static double square_of_nearest(struct double3 a, struct double3 b, struct double3 c) {
  const struct double3 ab = minus(b, a), ac = minus(c, a);
  const double a_b = -dot(ab, a), a_c = -dot(ac, a), b_b = -dot(ab, b), b_c = -dot(ac, b), c_b = -dot(ab, c),
               c_c = -dot(ac, c);
  if (a_b <= 0 && a_c <= 0)
    return dot(a, a);
  if (b_b >= 0 && b_c <= b_b)
    return dot(b, b);
  if (c_c >= 0 && c_b <= c_c)
    return dot(c, c);
  struct double3 nearest;
  const double at_c = a_b * b_c - b_b * a_c, at_b = c_b * a_c - a_b * c_c, at_a = b_b * c_c - c_b * b_c;
  if (at_c <= 0 && a_b >= 0 && b_b <= 0)
    nearest = plus_scaled(a, a_b / (a_b - b_b), ab);
  else if (at_b <= 0 && a_c >= 0 && c_c <= 0)
    nearest = plus_scaled(a, a_c / (a_c - c_c), ac);
  else if (at_a <= 0 && b_c - b_b >= 0 && c_b - c_c >= 0)
    nearest = plus_scaled(b, (b_c - b_b) / ((b_c - b_b) + (c_b - c_c)), minus(c, b));
  else
    nearest = plus_scaled(plus_scaled(a, at_b / (at_a + at_b + at_c), ab), at_c / (at_a + at_b + at_c), ac);
  return dot(nearest, nearest);
}

bool trax_needs_exact(const struct trax_scene *scene, const float eye[3]) {
  const struct double3 origin = from(eye);
  for (uint32_t i = 0; i < scene->triangle_count; i++) {
    const struct trax_triangle *triangle = &scene->triangles[i];
    const struct double3 a = minus(from(triangle->v0), origin), b = minus(from(triangle->v1), origin),
                         c = minus(from(triangle->v2), origin);
    const struct double3 normal = cross(minus(b, a), minus(c, a));
    if (greatest(normal) == 0)
      continue; /* without area, which no ray hits */
    const double size = fmax(greatest(minus(b, a)), greatest(minus(c, a)));
    const double farthest = fmax(greatest(a), fmax(greatest(b), greatest(c)));
    if (size < TRAX_LEAST_SIZE)
      return true;
    /* Most are smaller than they are far away. */
    if (farthest < 4 * size && !(square_of_nearest(a, b, c) * (TRAX_REACH * TRAX_REACH) >= farthest * farthest))
      return true;
  }
  return false;
}

bool trax_light_is_near(const struct trax_scene *scene, const float eye[3], const float light[3]) {
  const bool exact = trax_needs_exact(scene, eye);
  for (uint32_t i = 0; i < scene->triangle_count; i++) {
    const struct trax_triangle *triangle = &scene->triangles[i];
    const struct double3 v0 = from(triangle->v0), a = minus(v0, from(light)),
                         b = minus(from(triangle->v1), from(light)), c = minus(from(triangle->v2), from(light));
    const double size = fmax(greatest(minus(b, a)), greatest(minus(c, a)));
    double bound = trax_start_bound(greatest(v0), size);
    if (greatest(a) > size + TRAX_NEAR_LIGHT * bound)
      continue; /* as most are */
    if (exact)
      bound = trax_exact_start_bound(greatest(v0), size, greatest(from(eye)), greatest(minus(v0, from(eye))) + size);
    if (square_of_nearest(a, b, c) < TRAX_NEAR_LIGHT * TRAX_NEAR_LIGHT * bound * bound)
      return true;
  }
  return false;
}
